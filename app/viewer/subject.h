// What a rendered image is of: enough to tell whether the pixels of two images show the same
// points, and whether both converge to the same numbers. Plain values: nothing of the scene is
// held.
#pragma once

#include <cstdint>
#include <string>

#include "render/prepare.h"
#include "render/settings.h"

namespace midway {

struct Subject {
    std::string file;
    std::uint64_t hash = 0;  // of scene and camera, as PreparedScene has it
    CameraDescription camera;
    int width = 0, height = 0;  // of the whole image
    PixelRect crop;
    std::string settings;  // what else decides what the image converges to
};

Subject subject_of(const PreparedScene& scene, const RenderSettings& settings);

// Why the pixels of two images do not show the same points, in words that follow "because"; empty
// where they do.
std::string other_view(const Subject& then, const Subject& now);

// The same for what they converge to: light, materials, lens, region and settings count too;
// technique, exponent, sampler and seed do not.
std::string other_image(const Subject& then, const Subject& now);

}  // namespace midway
