// Tiny scenes built in code, and renders of them through the whole renderer (build_scene,
// ProgressiveRenderer). Units are the file's; every mesh is in world coordinates.
#pragma once

#include "render/renderer.h"
#include "report/extreme_scenes.h"
#include "support/statistics.h"

namespace midway::test {

using namespace extreme;  // the building blocks

// Throws where the scene cannot be built, or was mended.
std::shared_ptr<const Scene> build(const SceneDescription& scene);

// A square image of `size` pixels through the box filter.
RenderSettings settings(Technique technique, int size = 8, int max_bounces = 16);

// Throws where a sample was not finite or the film overflowed.
Image render(const std::shared_ptr<const Scene>& scene, const CameraDescription& camera,
             const RenderSettings& settings, std::uint64_t passes);

double image_mean(const Image& image);  // of all pixels and channels

// The image's mean from `batches` renders of `passes` passes with seeds of their own.
Estimate batch_mean(const std::shared_ptr<const Scene>& scene, const CameraDescription& camera,
                    RenderSettings settings, std::uint64_t passes, int batches);

}  // namespace midway::test
