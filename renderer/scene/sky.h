// Light from infinitely far away: an equirectangular map, bilinear between texel centres, or one
// colour. Directions are drawn cell by cell in proportion to the radiance that reaches a cell
// (exactly: every direction with radiance can be drawn).
#pragma once

#include <memory>

#include "math/distribution.h"
#include "scene/scene_description.h"

namespace midway {

struct Sky {
    std::shared_ptr<const Image> map;  // empty: constant
    vec3 scale{1};                     // colour times strength
    float cos_rotation = 1, sin_rotation = 0;
    // Of the map's texels, by mean radiance times solid angle, before rotation and scaling.
    std::shared_ptr<const Distribution2D> cells;
    float mean_radiance = 0;  // over the sphere, mean of RGB, after scaling
};

// Throws where the map holds negative or non-finite values. The table of a `previous` sky with the
// same map is shared.
Sky make_sky(const SkyDescription& description, const Sky* previous = nullptr);

// A gentle gradient for files without any light.
SkyDescription default_sky();

vec3 sky_radiance(const Sky& sky, const vec3& direction);
float sky_pdf_w(const Sky& sky, const vec3& direction);

struct SkySample {
    vec3 direction{0};  // towards the sky
    float pdf_w = 0;
};
SkySample sample_sky(const Sky& sky, const vec2& u);

}  // namespace midway
