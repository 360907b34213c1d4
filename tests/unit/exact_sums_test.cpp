// What holds bit for bit, since every sum is an integer: strategy layers against the image, a list
// of exponents against single runs, a crop against the whole.
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "report/reference.h"
#include "support/agreement_scenes.h"

namespace midway::test {
namespace {

RenderSettings small(const AgreementScene& scene, Technique technique) {
    RenderSettings s;
    s.technique = technique;
    s.exponents = {2};
    s.width = 6;
    s.height = 6;
    s.max_bounces = scene.max_bounces;
    return s;
}

// A crop of `path` holds the very numbers of the whole image.
TEST(ExactSums, ACropOfPathTracingIsAPieceOfTheImage) {
    const AgreementScene scene = make_agreement_scene("five_lights");
    RenderSettings whole = small(scene, Technique::path), piece = whole;
    whole.width = piece.width = 12;
    piece.crop = PixelRect{3, 1, 9, 5};
    ProgressiveRenderer a(scene.scene, scene.camera, whole, {}),
        b(scene.scene, scene.camera, piece, {});
    a.render_passes(4);
    b.render_passes(4);
    for (int y = 1; y < 5; ++y)
        for (int x = 3; x < 9; ++x)
            for (int half = 0; half < 2; ++half)
                EXPECT_EQ(a.film().sum(half, x, y), b.film().sum(half, x - 3, y - 1));
}

// As integers: not a bit is lost between the image and its strategy layers.
TEST(ExactSums, WeightedLayersSumToTheImageExactly) {
    const AgreementScene scene = make_agreement_scene("smooth_glass");
    RenderSettings s = small(scene, Technique::bdpt);
    s.width = 13;
    s.height = 9;
    RendererOptions options;
    options.layer_edges = s.max_bounces + 1;
    ProgressiveRenderer r(scene.scene, scene.camera, s, options);
    r.render_passes(64);
    const auto layers = r.layers();
    ASSERT_GT(layers.size(), 10u);
    size_t lit = 0;
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x)
            for (int half = 0; half < 2; ++half) {
                FixedRgb sum{};
                for (const auto& layer : layers) {
                    const FixedRgb v = layer.films->weighted.sum(half, x, y);
                    for (int k = 0; k < 3; ++k) sum[k] += v[k];
                }
                EXPECT_TRUE(sum == r.film().sum(half, x, y)) << x << ", " << y;
                lit += sum[0] > 0;
            }
    EXPECT_GT(lit, 100u);
}

// A bare layer is the image of its strategy alone without weights, as integers.
TEST(ExactSums, BareLayersAreTheImagesOfStrategiesAlone) {
    size_t lit = 0;
    for (const char* name : {"five_lights", "smooth_glass", "sky_map", "narrow_metal"}) {
        const AgreementScene scene = make_agreement_scene(name);
        RenderSettings s = small(scene, Technique::bdpt);
        s.exponents = {32};
        RendererOptions options;
        options.layer_edges = 4;
        ProgressiveRenderer all(scene.scene, scene.camera, s, options);
        all.render_passes(16);
        for (const auto& layer : all.layers()) {
            RenderSettings only = s;
            only.exponents = {2};
            only.only = {layer.strategy};
            only.unweighted = true;
            ProgressiveRenderer one(scene.scene, scene.camera, only, {});
            one.render_passes(16);
            EXPECT_TRUE(one.film().words() == layer.films->bare.words())
                << scene.name << ": " << layer.strategy.s << ", " << layer.strategy.t;
            lit += mean_luminance(one.image()) > 0;
        }
    }
    EXPECT_GT(lit, 20u);
}

// One set of paths weighed with many exponents gives the bits of as many runs.
TEST(ExactSums, AListOfExponentsGivesTheBitsOfSingleRuns) {
    const AgreementScene scene = make_agreement_scene("five_lights");
    const std::vector<double> exponents{0, 0.5, 1, 2, 3, 8, 32};
    RenderSettings s = small(scene, Technique::bdpt);
    s.exponents = exponents;
    ProgressiveRenderer all(scene.scene, scene.camera, s, {});
    all.render_passes(16);
    for (size_t i = 0; i < exponents.size(); ++i) {
        s.exponents = {exponents[i]};
        ProgressiveRenderer one(scene.scene, scene.camera, s, {});
        one.render_passes(16);
        EXPECT_EQ(all.film(int(i)).words(), one.film().words()) << "exponent " << exponents[i];
        if (i > 0) {
            EXPECT_NE(all.film(0).words(), one.film().words());
        }
    }
}

}  // namespace
}  // namespace midway::test
