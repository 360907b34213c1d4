// What the camera sees first: albedo, shading normal, depth and object, with the same filter and
// lens as the image. Sums of a pixel run in the order of its samples, so threads do not show.
#pragma once

#include <optional>

#include "render/render_control.h"
#include "render/settings.h"

namespace midway {

struct AovImages {
    Image albedo;  // approximate hemispherical reflectance
    Image normal;  // shading normal in the file's axes, towards the camera
    Image depth;   // along the view axis, in the file's units; 0 where nothing is seen
    Image object;  // 1 + object's number of the pixel's central ray, 0 for the sky
};

AovImages render_aovs(const Estimator& estimator, int samples, int threads);

// The same for a window: with workers of low priority, and empty where `control` ended it early.
std::optional<AovImages> render_aovs(const Estimator& estimator, int samples, int threads,
                                     const RenderControl& control);

}  // namespace midway
