// Techniques agree at the border of the image, in a crop, with every pixel filter, for every bounce
// limit, where lamps are seen directly, and strategy by strategy. False alarm of a case: under 1e-5
// per comparison (see agreement_test.cpp).
#include <gtest/gtest.h>

#include <cmath>

#include "support/agreement.h"
#include "support/tier.h"

namespace midway::test {
namespace {

RenderSettings small(const AgreementScene& scene, Technique technique) {
    RenderSettings s;
    s.technique = technique;
    s.exponents = {2};
    s.width = 6;
    s.height = 6;
    s.sampler = SamplerKind::independent;
    s.max_bounces = scene.max_bounces;
    return s;
}

Effort single_pixels() {
    Effort e;
    e.passes = by_tier<std::uint64_t>(60, 600);
    e.block = 1;
    return e;
}

// Six pixels by six: twenty of them are border. Finds a pixel that is 5 % off.
TEST(AgreementOfPixels, HoldsForEveryFilterUpToTheBorder) {
    const AgreementScene scene = make_agreement_scene("area");
    for (const FilterKind filter :
         {FilterKind::box, FilterKind::gaussian, FilterKind::blackman_harris})
        for (const Technique technique : {Technique::light, Technique::bdpt}) {
            RenderSettings a = small(scene, technique), b = small(scene, Technique::path);
            a.filter = b.filter = filter;
            EXPECT_EQ(disagreement(scene, a, b, single_pixels(), 6), "")
                << to_string(technique) << " with filter " << to_string(filter);
        }
}

TEST(AgreementOfPixels, HoldsInACrop) {
    const AgreementScene scene = make_agreement_scene("point");
    for (const FilterKind filter :
         {FilterKind::box, FilterKind::gaussian, FilterKind::blackman_harris})
        for (const Technique technique : {Technique::light, Technique::bdpt}) {
            RenderSettings a = small(scene, technique), b = small(scene, Technique::path);
            a.filter = b.filter = filter;
            a.width = b.width = 16;
            a.height = b.height = 12;
            a.crop = b.crop = PixelRect{5, 6, 11, 10};
            EXPECT_EQ(disagreement(scene, a, b, single_pixels(), 6), "")
                << to_string(technique) << " with filter " << to_string(filter);
        }
}

TEST(AgreementOfPixels, HoldsForEveryBounceLimit) {
    const AgreementScene scene = make_agreement_scene("sky_map");
    for (const int bounces : {1, 2, 3})
        for (const Technique technique : {Technique::light, Technique::bdpt}) {
            RenderSettings a = small(scene, technique), b = small(scene, Technique::path);
            a.max_bounces = b.max_bounces = bounces;
            a.only = b.only = all_but_direct_lamps(bounces);
            Effort effort = single_pixels();
            effort.block = 3;
            EXPECT_EQ(disagreement(scene, a, b, effort, 6), "")
                << to_string(technique) << ", " << bounces << " bounces";
        }
}

// A lamp in the middle of the view, and the sky behind it.
TEST(AgreementOfPixels, HoldsWhereLampsAreSeenDirectly) {
    AgreementScene scene = make_agreement_scene("five_lights");
    scene.camera = look_at(scene.camera, {0.3, 0.4, 2.2}, {0.4, 2.2, 0.6});
    for (const Technique technique : {Technique::light, Technique::bdpt})
        EXPECT_EQ(disagreement(scene, small(scene, technique), small(scene, Technique::path),
                               single_pixels(), 2),
                  "")
            << to_string(technique);
}

// With all else equal, the bare estimate of a strategy that alone makes every path of a length has
// the mean of that length: of two and three edges over rough surfaces under a lamp and a sky all of
// them, under a point lamp those that need not hit it, through smooth glass emitter hits alone.
TEST(AgreementOfStrategies, EachBareLayerHasTheMeanOfItsPathLength) {
    struct Case {
        const char* scene;
        int least_t, most_t;
    };
    for (const Case& c :
         {Case{"area", 0, 3}, {"sky_map", 0, 3}, {"point", 1, 3}, {"smooth_glass", 0, 0}}) {
        const AgreementScene scene = make_agreement_scene(c.scene);
        for (const int edges : {2, 3})
            for (int t = c.least_t; t <= std::min(edges, c.most_t); ++t) {
                const Strategy k{edges + 1 - t, t};
                RenderSettings a = small(scene, Technique::bdpt), b = a;
                a.only = {k};
                a.unweighted = true;
                for (int i = 1; i <= edges + 1; ++i) b.only.push_back({i, edges + 1 - i});
                Effort effort = single_pixels();
                effort.block = 2;
                EXPECT_EQ(disagreement(scene, a, b, effort, 21), "") << c.scene << describe(k);
            }
    }
}

}  // namespace
}  // namespace midway::test
