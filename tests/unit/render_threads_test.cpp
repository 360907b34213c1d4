// Threads never show in what is rendered, and nothing is raced for: tests/run runs these cases
// under the thread sanitizer too.
#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

#include "support/scenes.h"

namespace midway::test {
namespace {

// Every kind of light and of scattering, so that all strategies have work.
SceneDescription busy_scene() {
    SceneDescription s;
    add(s, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 4), lambert(vec3(0.6f)));
    add(s, make_quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    add(s, make_icosphere({0.5f, 0.5f, 0}, 0.5f, 2, false, true), glass(0));
    add(s, make_icosphere({-0.6f, 0.4f, 0}, 0.4f, 2, false, true), metal(0.3f));
    s.lights = {point_light({1, 1.5f, 1}, 1), sun({0.3f, -1, -0.2f}, 0.5f)};
    s.sky = constant_sky(vec3(0.2f));
    return s;
}

CameraDescription eye() { return camera_at({0, 1, 4}, {0, 0.5f, 0}, 0.8); }

struct Outcome {
    std::vector<std::uint64_t> words;  // of the film, then of the strategy layers
    std::uint64_t closest = 0, shadow = 0;
    std::vector<double> energies;

    bool operator==(const Outcome&) const = default;
};

Outcome render_observed(const std::shared_ptr<const Scene>& scene, Technique technique,
                        int threads) {
    RendererOptions options;
    options.threads = threads;
    options.layer_edges = 4;
    options.statistics = true;
    ProgressiveRenderer renderer(scene, eye(), settings(technique, 16, 6), options);
    // Several calls: the threads are started and joined again.
    for (std::uint64_t passes : {1, 1, 3}) renderer.render_passes(passes);
    Outcome outcome;
    const FilmWords& words = renderer.film().words();
    outcome.words.assign(words.begin(), words.end());
    for (const ProgressiveRenderer::Layer& layer : renderer.layers()) {
        for (const Film* film : {&layer.films->weighted, &layer.films->bare}) {
            outcome.words.insert(outcome.words.end(), film->words().begin(), film->words().end());
        }
    }
    const RenderStatistics statistics = renderer.statistics();
    outcome.closest = statistics.rays.closest;
    outcome.shadow = statistics.rays.shadow;
    for (const StrategyStatistics& s : statistics.strategies) {
        outcome.energies.push_back(s.energy);
        outcome.energies.push_back(s.second_moment);
    }
    return outcome;
}

TEST(RenderThreads, DoNotChangeABit) {
    const auto scene = build(busy_scene());
    for (Technique technique : {Technique::path, Technique::light, Technique::bdpt}) {
        SCOPED_TRACE(std::string(to_string(technique)));
        const Outcome alone = render_observed(scene, technique, 1);
        EXPECT_GT(alone.closest, 0u);
        for (int threads : {2, 3, 7})
            EXPECT_TRUE(alone == render_observed(scene, technique, threads));
    }
}

TEST(RenderThreads, MayShareASceneWithAnotherRenderer) {
    const auto scene = build(busy_scene());
    const Outcome alone = render_observed(scene, Technique::bdpt, 2);
    Outcome first, second;
    {
        std::jthread a([&] { first = render_observed(scene, Technique::bdpt, 2); });
        std::jthread b([&] { second = render_observed(scene, Technique::bdpt, 2); });
    }
    EXPECT_TRUE(alone == first);
    EXPECT_TRUE(alone == second);
}

TEST(RenderThreads, DoNotMindASceneBuiltMeanwhile) {
    const auto scene = build(busy_scene());
    const Outcome alone = render_observed(scene, Technique::bdpt, 2);
    Outcome meanwhile;
    {
        std::jthread worker([&] { meanwhile = render_observed(scene, Technique::bdpt, 2); });
        for (int i = 0; i < 5; ++i) EXPECT_TRUE(build(busy_scene()));
    }
    EXPECT_TRUE(alone == meanwhile);
}

// Four tiles of one view of a sky with texels smaller than a pixel: threads that shared a seed
// would draw the same noise into several.
TEST(RenderThreads, DoNotShareASeed) {
    auto map = std::make_shared<Image>(512, 256);
    for (size_t i = 0; i < map->pixels.size(); ++i)
        map->pixels[i] = vec3(mix64(i) & 1 ? 1.0f : 0.0f);
    SceneDescription d;
    d.sky = constant_sky(vec3(1));
    d.sky->map = map;
    const auto scene = build(d);
    const RenderSettings s = settings(Technique::path, 64, 1);
    const auto image = [&](int threads) {
        ProgressiveRenderer renderer(scene, camera_at(vec3(0), {0, 0, -1}, 1.5), s,
                                     {.threads = threads});
        renderer.render_passes(1);
        return renderer.image();
    };
    const Image together = image(4);
    EXPECT_EQ(together.pixels, image(1).pixels);
    const Estimator e = make_estimator(*scene, {}, s);
    int same = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            same +=
                sample_4d(camera_key(e, x, y, 0), 0) == sample_4d(camera_key(e, x + 32, y, 0), 0);
    EXPECT_EQ(same, 0);
}

}  // namespace
}  // namespace midway::test
