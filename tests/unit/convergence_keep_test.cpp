// What midway compare keeps while it runs: the curves and what the tests of bias need of them.
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "report/convergence.h"
#include "report/reference.h"
#include "support/assets.h"
#include "support/temp_dir.h"

namespace midway::test {
namespace {

RenderSettings small(Technique technique) {
    RenderSettings s;
    s.technique = technique;
    s.width = s.height = 8;
    return s;
}

void expect_luminances(const ConvergenceRun& run, int seeds) {
    for (const TechniqueRun& t : run.techniques) {
        ASSERT_EQ(static_cast<size_t>(seeds), t.seeds.size());
        for (const CurveRun& r : t.seeds) {
            EXPECT_GT(r.luminance_a, 0);
            EXPECT_GT(r.luminance_b, 0);
        }
    }
}

// A curve that was complete when all were kept had no mean, and every technique looked black.
TEST(ConvergenceRun, KeepsTheMeansOfCurvesThatEndBeforeOthers) {
    const PreparedScene scene = prepare_scene(of_asset("cornell.glb"));
    ProgressiveRenderer r(scene.scene, scene.camera, small(Technique::bdpt), {.threads = 1});
    r.render_passes(64);
    const FilmPart part{&r.film(), r.counts()};
    const Reference reference = reference_of_films({&part, 1});
    const TempDir folder;
    ConvergencePlan plan;
    plan.scene = &scene;
    plan.reference = &reference;
    plan.techniques = {{"path", small(Technique::path)}, {"bdpt:2", small(Technique::bdpt)}};
    plan.seconds = 0.05;
    plan.seeds = 2;
    plan.threads = 1;
    plan.folder = folder.path().string();
    plan.keep_every_seconds = 0;
    const CompareHooks hooks{[] { return false; }, [](const std::string&, double) {},
                             [](double) {}};
    expect_luminances(run_convergence(plan, hooks), plan.seeds);
    // What was kept is enough.
    expect_luminances(run_convergence(plan, hooks), plan.seeds);
}

}  // namespace
}  // namespace midway::test
