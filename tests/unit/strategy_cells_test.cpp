// The cells of the strategy pyramid against the film: as integers, not a bit is lost between the
// image and its strategies, and looking at them changes nothing.
#include "render/strategy_cells.h"

#include <gtest/gtest.h>

#include "render/coverage.h"
#include "render/renderer.h"
#include "support/agreement_scenes.h"
#include "support/scenes.h"

namespace midway::test {
namespace {

struct Case {
    std::string name;
    RenderSettings settings;
};

// Tall enough for boxes of 3 x 3 pixels, with paths long enough for the shared cell. No number here
// is a multiple of another.
RenderSettings tall(Technique technique) {
    RenderSettings s;
    s.technique = technique;
    s.exponents = {2, 0, 1};
    s.width = 7;
    s.height = 323;
    s.max_bounces = 11;
    return s;
}

std::vector<Case> cases() {
    std::vector<Case> list;
    for (const Technique t : {Technique::path, Technique::light, Technique::bdpt})
        list.push_back({std::string(to_string(t)), tall(t)});
    RenderSettings s = tall(Technique::bdpt);
    s.crop = PixelRect{2, 3, 7, 318};
    list.push_back({"crop", s});
    s = tall(Technique::bdpt);
    s.families = parse_families("next-event,light");
    list.push_back({"families", s});
    s = tall(Technique::bdpt);
    s.clamp = 0.02f;
    list.push_back({"clamp", s});
    s = tall(Technique::bdpt);
    s.unweighted = true;
    list.push_back({"unweighted", s});
    s = tall(Technique::bdpt);
    s.max_bounces = 2;
    list.push_back({"short", s});
    return list;
}

StrategyRequest everything(const StrategyCells& cells, double exponent) {
    StrategyRequest request{.open = true, .exponent = exponent};
    for (const StrategyCell& cell : cells.cells) request.selected.push_back(cell.strategy);
    return request;
}

FixedRgb plus(FixedRgb a, const FixedRgb& b, int sign = 1) {
    for (int c = 0; c < 3; ++c) a[c] += sign * b[c];
    return a;
}

// Both halves of the film, less what it held before.
FixedRgb gained(const Film& now, const Film& before, int x, int y) {
    const FixedRgb sum = plus(now.sum(0, x, y), now.sum(1, x, y));
    return plus(sum, plus(before.sum(0, x, y), before.sum(1, x, y)), -1);
}

struct Sums {
    FixedRgb thumbnails{}, full{}, film{};
};

// Of one box of the image.
Sums box_sums(const StrategyCells& cells, const Film& now, const Film& before, int bx, int by) {
    Sums s;
    for (const StrategyCell& cell : cells.cells)
        s.thumbnails = plus(s.thumbnails, cell.thumbnail.sum(0, bx, by));
    const PixelRect box = thumbnail_box(cells, bx, by);
    for (int y = box.y0 - cells.crop.y0; y < box.y1 - cells.crop.y0; ++y)
        for (int x = box.x0 - cells.crop.x0; x < box.x1 - cells.crop.x0; ++x) {
            s.film = plus(s.film, gained(now, before, x, y));
            for (const StrategyCell& cell : cells.cells)
                if (cell.full) s.full = plus(s.full, cell.full->sum(0, x, y));
        }
    return s;
}

void expect_exact(const StrategyCells& cells, const Film& now, const Film& before) {
    const Film& first = cells.cells.front().thumbnail;
    int lit = 0;
    for (int y = 0; y < first.height(); ++y)
        for (int x = 0; x < first.width(); ++x) {
            const Sums s = box_sums(cells, now, before, x, y);
            EXPECT_TRUE(s.thumbnails == s.film) << x << ", " << y;
            EXPECT_TRUE(s.full == s.film) << x << ", " << y;
            lit += s.film[0] > 0;
        }
    EXPECT_GT(lit, 30);
}

TEST(StrategyCells, WeightedCellsSumToTheImageExactly) {
    const AgreementScene scene = make_agreement_scene("five_lights");
    for (const Case& c : cases())
        for (const double exponent : c.settings.exponents) {
            SCOPED_TRACE(c.name + ", exponent " + std::to_string(exponent));
            RendererOptions options;
            options.threads = 2;
            ProgressiveRenderer r(scene.scene, scene.camera, c.settings, options);
            ProgressiveRenderer plain(scene.scene, scene.camera, c.settings, options);
            r.render_passes(1);
            r.observe({.open = true, .exponent = exponent});
            r.observe(everything(*r.cells(), exponent));
            const int index = static_cast<int>(r.cells()->exponent);
            EXPECT_EQ(r.estimator().exponents[r.cells()->exponent], exponent);
            EXPECT_EQ(r.cells()->longer >= 0, c.settings.max_bounces > 7);
            const Film before = r.film(index);
            r.render_passes(2);
            expect_exact(*r.cells(), r.film(index), before);

            // Nobody who looks at the films sees that somebody looks at the strategies.
            r.observe({});
            EXPECT_EQ(r.cells(), nullptr);
            r.render_passes(1);
            plain.render_passes(4);
            for (int i = 0; i < 3; ++i) EXPECT_EQ(r.film(i).words(), plain.film(i).words());
            EXPECT_EQ(r.statistics().clamped, plain.statistics().clamped);
            EXPECT_EQ(r.statistics().clamped > 0, c.settings.clamp.has_value());
            EXPECT_EQ(r.statistics().fixed.inexact, plain.statistics().fixed.inexact);
            EXPECT_EQ(r.cells_lost(), 0u);
        }
}

// Bare cells are the estimates before any weight and any clamp, whatever the exponent.
TEST(StrategyCells, BareCellsDependOnNoWeight) {
    const AgreementScene scene = make_agreement_scene("five_lights");
    const auto render = [&](double exponent, std::optional<float> clamp, int threads) {
        RenderSettings s = tall(Technique::bdpt);
        s.clamp = clamp;
        RendererOptions options;
        options.threads = threads;
        auto r = std::make_unique<ProgressiveRenderer>(scene.scene, scene.camera, s, options);
        r->observe({.open = true, .exponent = exponent});
        r->observe(everything(*r->cells(), exponent));
        r->render_passes(2);
        return r;
    };
    const auto a = render(2, {}, 1), b = render(0, 0.02f, 3);
    ASSERT_EQ(a->cells()->cells.size(), b->cells()->cells.size());
    int weights_seen = 0, lit = 0;
    for (size_t i = 0; i < a->cells()->cells.size(); ++i) {
        const StrategyCell &ca = a->cells()->cells[i], &cb = b->cells()->cells[i];
        for (int y = 0; y < 323; ++y)
            for (int x = 0; x < 7; ++x) {
                EXPECT_TRUE(ca.full->sum(1, x, y) == cb.full->sum(1, x, y));
                weights_seen += ca.full->sum(0, x, y) != cb.full->sum(0, x, y);
            }
        for (int y = 0; y < ca.thumbnail.height(); ++y) {
            EXPECT_TRUE(ca.thumbnail.sum(1, 0, y) == cb.thumbnail.sum(1, 0, y));
            lit += ca.thumbnail.sum(1, 0, y)[0] > 0;
        }
    }
    EXPECT_GT(weights_seen, 1000);
    EXPECT_GT(lit, 100);
}

TEST(StrategyCells, BeginWithThePassesThatFollow) {
    const AgreementScene scene = make_agreement_scene("five_lights");
    ProgressiveRenderer r(scene.scene, scene.camera, tall(Technique::bdpt), {});
    r.render_passes(3);
    r.observe({.open = true});
    EXPECT_EQ(r.cells()->since, 3u);
    EXPECT_EQ(r.cells()->cells.front().full, nullptr);
    r.render_passes(1);
    // Choosing a cell leaves the others and their thumbnails as they are.
    const Strategy chosen{3, 1};
    const Film thumbnail = r.cells()->cells[0].thumbnail;
    r.observe({.open = true, .selected = {chosen, {1, 1}, {40, 2}}});
    EXPECT_EQ(r.cells()->since, 3u);
    EXPECT_EQ(thumbnail.words(), r.cells()->cells[0].thumbnail.words());
    for (const StrategyCell& cell : r.cells()->cells) {
        const bool is_chosen = cell.strategy == chosen || cell.strategy == longer_paths;
        EXPECT_EQ(cell.full != nullptr, is_chosen) << describe(cell.strategy);
        if (cell.full) {
            EXPECT_EQ(cell.full_since, 4u);
        }
    }
    r.render_passes(1);
    const auto words =
        r.cells()->cells[static_cast<size_t>(r.cells()->index_of(chosen))].full->words();
    r.observe({.open = true, .kept = {chosen}});
    EXPECT_EQ(words,
              r.cells()->cells[static_cast<size_t>(r.cells()->index_of(chosen))].full->words());
    // Other weights begin anew.
    r.observe({.open = true, .exponent = 0, .kept = {chosen}});
    EXPECT_EQ(r.cells()->since, 5u);
}

// The shares: energies add up to the image's mean, and every cell that has light has samples.
TEST(StrategyCells, StatisticsAreThoseOfTheCells) {
    const AgreementScene scene = make_agreement_scene("five_lights");
    ProgressiveRenderer r(scene.scene, scene.camera, tall(Technique::bdpt), {});
    r.observe({.open = true});
    r.render_passes(2);
    double energy = 0, mean = 0;
    std::uint64_t rays = 0;
    const auto statistics = r.cell_statistics();
    ASSERT_EQ(statistics.size(), r.cells()->cells.size());
    for (size_t i = 0; i < statistics.size(); ++i) {
        const StrategyCell& cell = r.cells()->cells[i];
        EXPECT_EQ(statistics[i].strategy, cell.strategy);
        energy += statistics[i].energy;
        rays += statistics[i].rays;
        bool lit = false;
        for (const std::uint64_t word : cell.thumbnail.words()) lit |= word != 0;
        EXPECT_EQ(lit, statistics[i].energy > 0) << describe(cell.strategy);
        EXPECT_EQ(statistics[i].samples > 0, lit) << describe(cell.strategy);
    }
    const Image image = r.image();
    for (const vec3& p : image.pixels) mean += luminance(dvec3(p)) / double(image.pixels.size());
    EXPECT_NEAR(energy / mean, 1, 1e-5);
    EXPECT_EQ(rays, r.statistics().rays.shadow);
}

TEST(StrategyCells, MemoryIsBounded) {
    Estimator e;
    e.max_bounces = 10000;
    e.families = families_of(Technique::bdpt);
    e.crop = {0, 0, 20000, 15000};
    StrategyCells cells = make_cells(e, -90, 0, 0);
    EXPECT_EQ(cells.cells.size(), 44u);
    for (const StrategyCell& cell : cells.cells) {
        EXPECT_LE(cell.thumbnail.width(), thumbnail_pixels);
        EXPECT_LE(cell.thumbnail.height(), thumbnail_pixels);
    }
    const auto full_films = [&](const PixelRect& crop) {
        e.crop = crop;
        cells = make_cells(e, -90, 0, 0);
        keep_full_size(cells, everything(cells, 2), 0);
        return std::ranges::count_if(cells.cells, [](const auto& c) { return c.full != nullptr; });
    };
    EXPECT_EQ(full_films({0, 0, 1280, 720}), 12);
    EXPECT_EQ(full_films({0, 0, 4096, 4096}), 1) << "the first one always has room";
    EXPECT_EQ(full_films({0, 0, 64, 64}), 44);
}

TEST(StrategyCells, WordsSayWhyAStrategyIsLeftOut) {
    SceneDescription d;
    add(d, make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), lambert(vec3(0.5f)));
    d.lights = {point_light({0, 1, 0}, 1)};
    const auto scene = build(d);
    RenderSettings s = tall(Technique::bdpt);
    const auto why = [&](const Strategy& k) {
        const Estimator e = make_estimator(*scene, camera_at({0, 1, 4}, {0, 0, 0}, 0.8), s);
        return why_left_out(k, scene_features(*scene), e, s);
    };
    EXPECT_NE(why({1, 1}), "");
    EXPECT_NE(why({3, 0}).find("point"), std::string::npos);
    EXPECT_EQ(why({2, 1}), "");
    EXPECT_EQ(why({1, 2}), "");
    EXPECT_EQ(why({2, 2}), "");
    EXPECT_NE(why({12, 2}), "") << "beyond the last bounce";
    s.families = parse_families("emitter,next-event");
    EXPECT_NE(why({2, 2}).find("by you"), std::string::npos);
    s.families.reset();
    s.technique = Technique::automatic;
    s.plan = Plan{{true, true, true, false}, 2};
    EXPECT_NE(why({2, 2}).find("auto"), std::string::npos);
    EXPECT_EQ(why({1, 2}), "");
    s.technique = Technique::path;
    EXPECT_NE(why({1, 2}).find("path tracing"), std::string::npos);
    s.technique = Technique::light;
    EXPECT_NE(why({2, 1}).find("light tracing"), std::string::npos);
}

}  // namespace
}  // namespace midway::test
