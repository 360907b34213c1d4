// What is said of the paths that a technique cannot make (render/coverage.h), against what is known
// of small scenes, and the reference that is rendered with the technique that misses least.
#include "render/coverage.h"

#include <gtest/gtest.h>

#include "report/reference_pilot.h"
#include "support/agreement_scenes.h"
#include "support/assets.h"

namespace midway::test {
namespace {

using Lines = std::vector<std::string>;

Lines missing(const std::string& scene, Technique t) {
    const AgreementScene s = make_agreement_scene(scene);
    return not_covered(scene_features(*s.scene), families_of(t), t == Technique::light);
}

TEST(Coverage, TellsWhatATechniqueCannotMake) {
    const std::string seen_in_smooth = "lamp or sky > smooth surface > camera";
    for (const char* scene : {"area", "sky_map", "rough_metal"})
        for (const Technique t : {Technique::path, Technique::light, Technique::bdpt})
            EXPECT_EQ(Lines{}, missing(scene, t)) << scene << to_string(t);
    // An area lamp and smooth glass: emitter hits make all of it, light tracing nothing that is
    // seen in the glass.
    EXPECT_EQ(Lines{}, missing("smooth_glass", Technique::path));
    EXPECT_EQ(Lines{}, missing("smooth_glass", Technique::bdpt));
    EXPECT_EQ(Lines{seen_in_smooth}, missing("smooth_glass", Technique::light));
    // A point lamp's caustic: none that a camera's walk could find; light tracing finds it but for
    // what is seen of it in the glass, which nothing does.
    EXPECT_EQ((Lines{"point light > smooth surface > rough surface > camera"}),
              missing("caustic", Technique::path));
    EXPECT_EQ((Lines{"point light > smooth surface > rough surface > smooth surface > camera"}),
              missing("caustic", Technique::bdpt));
    EXPECT_EQ((Lines{"point light > rough surface > smooth surface > camera"}),
              missing("caustic", Technique::light));
}

// Without emitter hits the lamp is not seen, and neither is what only they find behind glass.
TEST(Coverage, TellsWhatFamiliesCannotMake) {
    const AgreementScene s = make_agreement_scene("smooth_glass");
    const SceneFeatures f = scene_features(*s.scene);
    const std::string lamp = "lamp or sky > camera";
    const std::string seen_in_smooth = "lamp or sky > smooth surface > camera";
    EXPECT_EQ(Lines{}, not_covered(f, {true, false, false, false}, false));
    for (const Families& families :
         {Families{false, true, false, false}, {false, true, true, true}})
        EXPECT_EQ((Lines{lamp, seen_in_smooth}), not_covered(f, families, false));
}

// One line each, but not alike: all that bdpt misses path misses too, and more.
TEST(Coverage, CountsEveryKindOfPath) {
    const SceneFeatures f = scene_features(*make_agreement_scene("caustic").scene);
    const auto path = kinds_not_covered(f, families_of(Technique::path), false);
    const auto bdpt = kinds_not_covered(f, families_of(Technique::bdpt), false);
    EXPECT_GT(path.size(), bdpt.size());
    EXPECT_FALSE(bdpt.empty());
    for (const PathKind& k : bdpt)
        EXPECT_NE(path.end(), std::find(path.begin(), path.end(), k)) << k.surfaces;
}

// A path tracer that lacks a caustic has no noise of it, and would win the pilot.
TEST(Coverage, ReferencesComeFromWhatMissesLeast) {
    SceneOptions o = of_asset("five-lights.glb");
    o.sky = "0.1,0.16,0.28";
    const PreparedScene scene = prepare_scene(o);
    ReferencePlan plan;
    plan.scene = &scene;
    for (const Technique t : {Technique::path, Technique::bdpt, Technique::light}) {
        RenderSettings s;
        s.width = s.height = 8;
        s.technique = t;
        plan.candidates.push_back({std::string(to_string(t)), s});
    }
    const auto best = best_covering(plan);
    ASSERT_EQ(1u, best.size());
    EXPECT_EQ("bdpt", best[0]->label);
}

}  // namespace
}  // namespace midway::test
