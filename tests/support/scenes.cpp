#include "support/scenes.h"

#include <stdexcept>

#include "support/worker_mode.h"

namespace midway::test {

std::shared_ptr<const Scene> build(const SceneDescription& scene) {
    std::vector<std::string> warnings;
    auto built = std::make_shared<const Scene>(build_scene(scene, warnings));
    if (!warnings.empty()) throw std::runtime_error("test scene was mended: " + warnings.front());
    return built;
}

RenderSettings settings(Technique technique, int size, int max_bounces) {
    RenderSettings s;
    s.technique = technique;
    s.width = s.height = size;
    s.max_bounces = max_bounces;
    s.filter = FilterKind::box;
    s.seed = test_seed(1);
    return s;
}

Image render(const std::shared_ptr<const Scene>& scene, const CameraDescription& camera,
             const RenderSettings& settings, std::uint64_t passes) {
    ProgressiveRenderer renderer(scene, camera, settings, {.threads = 1});
    renderer.render_passes(passes);
    const RenderStatistics s = renderer.statistics();
    if (s.nonfinite.count > 0 || s.fixed.overflow > 0)
        throw std::runtime_error("a sample was not finite or did not fit into the film");
    return renderer.image();
}

double image_mean(const Image& image) {
    double sum = 0;
    for (const vec3& p : image.pixels) sum += (double(p.x) + p.y + p.z) / 3;
    return sum / double(image.pixels.size());
}

Estimate batch_mean(const std::shared_ptr<const Scene>& scene, const CameraDescription& camera,
                    RenderSettings settings, std::uint64_t passes, int batches) {
    RunningMean means;
    const std::uint64_t first = settings.seed;
    for (int i = 0; i < batches; ++i) {
        settings.seed = hash_combine(first, std::uint64_t(i));
        means.add(image_mean(render(scene, camera, settings, passes)));
    }
    return means.estimate();
}

}  // namespace midway::test
