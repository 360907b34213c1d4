// The path inspector's samples: what they say they gave is, as integers, what the film got; weights
// of all strategies sum to one and are those of the direct form; numbers are in the file's units;
// the brightest sample is the brightest. Nothing here is random but the paths: no false alarm.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "math/float_mode.h"
#include "render/film_record.h"
#include "report/brightest.h"
#include "support/agreement_scenes.h"
#include "support/scenes.h"

namespace midway::test {
namespace {

Inspectable subject(const AgreementScene& scene, const RenderSettings& settings) {
    return {scene.scene, scene.camera, settings};
}

RenderSettings small(Technique technique = Technique::bdpt) {
    RenderSettings s;
    s.width = 18;
    s.height = 14;
    s.technique = technique;
    s.max_bounces = 6;
    return s;
}

std::vector<Film> empty_films(const Inspectable& what) {
    const Estimator e = make_estimator(*what.scene, what.camera, what.settings);
    const int unit = film_unit_exponent(what.scene->total_power);
    std::vector<Film> films;
    for (int i = 0; i < e.exponent_count; ++i)
        films.emplace_back(e.crop.width(), e.crop.height(), unit);
    return films;
}

// The film of this one sample, as the renderer's worker makes it.
std::vector<Film> film_of_sample(const Inspectable& what, int x, int y, std::uint64_t pass) {
    const ScopedFlushToZero flush;
    const Estimator e = make_estimator(*what.scene, what.camera, what.settings);
    std::vector<Film> films = empty_films(what);
    FilmTargets targets;
    targets.films = &films;
    targets.crop = e.crop;
    targets.recording = make_recording(what.settings);
    WorkerSums sums;
    LightSubpaths light;
    {
        FilmRecord<false> record(targets, sums);
        record.begin(x, y, pass);
        estimate_alone(e, x, y, pass, light, record, sums.rays);
        record.end();
    }
    return films;
}

void add_to(std::vector<Film>& films, const InspectedSample& s, const PixelRect& crop) {
    for (const InspectedPath& p : s.paths)
        for (size_t i = 0; i < films.size(); ++i)
            EXPECT_TRUE(films[i].add(static_cast<int>(s.pass & 1), p.x - crop.x0, p.y - crop.y0,
                                     p.fixed[i]));
}

bool same_words(const std::vector<Film>& a, const std::vector<Film>& b) {
    for (size_t i = 0; i < a.size(); ++i)
        if (a[i].words() != b[i].words()) return false;
    return a.size() == b.size();
}

struct Tally {
    int contributions = 0, splats_elsewhere = 0, clamped = 0;
};

// Sample by sample, then all of two passes against the whole renderer.
Tally expect_exact(const Inspectable& what) {
    const Estimator e = make_estimator(*what.scene, what.camera, what.settings);
    Tally tally;
    RendererOptions options;
    options.threads = 2;
    options.first_pass = 4;
    ProgressiveRenderer renderer(what.scene, what.camera, what.settings, options);
    renderer.render_passes(2);
    std::vector<Film> whole = empty_films(what);
    int wrong = 0;
    for (std::uint64_t pass = 4; pass < 6; ++pass)
        for (int y = e.crop.y0; y < e.crop.y1; ++y)
            for (int x = e.crop.x0; x < e.crop.x1; ++x) {
                const InspectedSample s = inspect_sample(what, x, y, pass);
                std::vector<Film> one = empty_films(what);
                add_to(one, s, e.crop);
                wrong += !same_words(one, film_of_sample(what, x, y, pass));
                add_to(whole, s, e.crop);
                tally.contributions += static_cast<int>(s.paths.size());
                for (const InspectedPath& p : s.paths) {
                    tally.splats_elsewhere += p.x != x || p.y != y;
                    tally.clamped += p.clamped;
                }
            }
    EXPECT_EQ(wrong, 0) << "samples whose contributions are not the film's";
    for (size_t i = 0; i < whole.size(); ++i)
        EXPECT_EQ(whole[i].words(), renderer.film(static_cast<int>(i)).words());
    return tally;
}

TEST(InspectedSample, ContributionsAreTheFilmsInEveryScene) {
    for (const char* name : {"point", "spot", "directional", "area", "sky_map", "five_lights",
                             "leaf", "textured_lamp", "thin_lens", "smooth_glass", "rough_glass",
                             "lamp_in_glass", "camera_in_glass", "caustic", "shading_normals"}) {
        SCOPED_TRACE(name);
        const Tally t = expect_exact(subject(make_agreement_scene(name), small()));
        EXPECT_GT(t.contributions, 50);
        EXPECT_GT(t.splats_elsewhere, 0);
    }
}

TEST(InspectedSample, ContributionsAreTheFilmsWithEverySetting) {
    const AgreementScene scene = make_agreement_scene("five_lights");
    for (const Technique technique : {Technique::path, Technique::light, Technique::bdpt}) {
        SCOPED_TRACE(to_string(technique));
        RenderSettings s = small(technique);
        s.exponents = {0, 1, 2, 0.7};
        EXPECT_GT(expect_exact(subject(scene, s)).contributions, 30);
    }
    RenderSettings s = small();
    s.crop = PixelRect{3, 1, 16, 11};
    EXPECT_GT(expect_exact(subject(scene, s)).splats_elsewhere, 0);
    s.clamp = 0.01f;
    EXPECT_GT(expect_exact(subject(scene, s)).clamped, 0);
    s = small();
    s.unweighted = true;
    expect_exact(subject(scene, s));
    s = small();
    s.only = {{2, 2}, {1, 3}, {3, 0}};
    EXPECT_GT(expect_exact(subject(scene, s)).contributions, 0);
    // Plans that leave direct light to next event, one for every fourth sample and one twice.
    for (const Plan& plan :
         {Plan{{}, 4, false}, Plan{{}, 1, false}, Plan{{}, 4, false, 2}, Plan{{}, 4, true, 2}}) {
        s = small(Technique::automatic);
        s.exponents = {0, 2};
        s.plan = plan;
        EXPECT_GT(expect_exact(subject(scene, s)).contributions, 30);
        EXPECT_GT(expect_exact(subject(make_agreement_scene("area"), s)).contributions, 30);
    }
    for (const char* families : {"light", "connect", "next-event", "emitter", "emitter,light",
                                 "next-event,connect", "emitter,next-event,light"}) {
        SCOPED_TRACE(families);
        s = small();
        s.families = parse_families(families);
        s.sampler = SamplerKind::independent;
        EXPECT_GT(expect_exact(subject(scene, s)).contributions, 0);
    }
}

TEST(InspectedSample, ListsNoStrategyThatAPlanSpared) {
    RenderSettings s = small(Technique::automatic);
    s.plan = Plan{{}, 4, false};
    const Inspectable what = subject(make_agreement_scene("area"), s);
    int direct = 0;
    for (int x = 0; x < s.width; ++x)
        for (const InspectedPath& p : inspect_sample(what, x, s.height / 2, 0).paths) {
            if (p.strategies.size() != 3) continue;
            EXPECT_EQ((Strategy{1, 2}), p.strategies[0].strategy);
            EXPECT_FALSE(p.strategies[0].feasible);
            ++direct;
        }
    EXPECT_GT(direct, 0);
}

// The strategy that made the path, among all that could have.
const InspectedStrategy& found_by(const InspectedPath& p) {
    return p.strategies.size() == 1
               ? p.strategies.front()
               : p.strategies[static_cast<size_t>(p.contribution.strategy.s) - 1];
}

TEST(InspectedSample, WeightsOfAllStrategiesSumToOne) {
    int paths = 0;
    for (const char* name : {"five_lights", "caustic", "thin_lens", "sky_map", "smooth_glass"}) {
        SCOPED_TRACE(name);
        RenderSettings s = small();
        s.exponents = {0, 1, 2};
        const Inspectable what = subject(make_agreement_scene(name), s);
        for (int y = 0; y < s.height; ++y)
            for (int x = 0; x < s.width; ++x)
                for (const InspectedPath& p : inspect_sample(what, x, y, 3).paths) {
                    EXPECT_EQ(found_by(p).strategy, p.contribution.strategy);
                    EXPECT_TRUE(found_by(p).feasible);
                    ++paths;
                    for (size_t b = 0; b < s.exponents.size(); ++b) {
                        double weights = 0, direct = 0;
                        for (const InspectedStrategy& k : p.strategies) {
                            weights += k.weights[b];
                            direct += k.direct[b];
                            EXPECT_EQ(k.feasible || k.direct[b] == 0, true);
                        }
                        EXPECT_NEAR(direct, 1, 1e-12);
                        // The render's own weight stands among those given its pdfs.
                        EXPECT_NEAR(weights, 1, 1e-5) << describe(p.contribution.strategy);
                        EXPECT_EQ(found_by(p).weights[b], p.contribution.weights[b]);
                        EXPECT_NEAR(found_by(p).weights[b], found_by(p).direct[b], 1e-5);
                    }
                    // f / (n p): what the balance heuristic makes of it does not depend on p.
                    for (const InspectedStrategy& k : p.strategies) {
                        if (!k.feasible || !(k.direct[1] > 1e-6)) continue;
                        EXPECT_NEAR(luminance(k.value) * k.direct[1] /
                                        (luminance(found_by(p).value) * found_by(p).direct[1]),
                                    1, 1e-3);
                    }
                }
    }
    EXPECT_GT(paths, 500);
}

// The same scene eight times as large, and moved.
SceneDescription enlarged(SceneDescription d, double factor, const dvec3& by) {
    dmat4 grow(factor);
    grow[3] = dvec4(by, 1);
    for (Instance& i : d.instances) i.to_world = grow * i.to_world;
    for (PunctualLight& l : d.lights) {
        l.to_world = grow * l.to_world;
        l.intensity *= l.kind == PunctualKind::directional ? 1.0f : float(factor * factor);
    }
    return d;
}

TEST(InspectedSample, SpeaksTheFilesUnits) {
    SceneDescription d;
    add(d, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 4), lambert(vec3(0.6f)));
    add(d, make_quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    d.lights = {point_light({1, 1.5f, 1}, 1)};
    const double factor = 8;
    const dvec3 by(16, -32, 8);
    RenderSettings s = small();
    const CameraDescription near = camera_at({0, 1, 4}, {0, 0.5f, 0}, 0.8);
    CameraDescription far = near;
    far.to_world[3] = dvec4(dvec3(near.to_world[3]) * factor + by, 1);
    const Inspectable a{build(d), near, s}, b{build(enlarged(d, factor, by)), far, s};
    int compared = 0;
    for (int i = 0; i < s.width * s.height; ++i) {
        const InspectedSample p = inspect_sample(a, i % s.width, i / s.width, 1);
        const InspectedSample q = inspect_sample(b, i % s.width, i / s.width, 1);
        ASSERT_EQ(p.camera.size(), q.camera.size());
        for (size_t k = 0; k < p.camera.size(); ++k) {
            const InspectedVertex &v = p.camera[k], &w = q.camera[k];
            if (v.infinite) continue;
            EXPECT_LT(glm::length(v.position * factor + by - w.position), 1e-4 * factor);
            if (v.fwd.measure != Measure::per_area) continue;
            EXPECT_NEAR(v.fwd.value / w.fwd.value, factor * factor, 1e-2);
        }
        ASSERT_EQ(p.light.size(), q.light.size());
        for (size_t k = 0; k < p.light.size(); ++k)
            EXPECT_NEAR(luminance(q.light[k].throughput),
                        luminance(p.light[k].throughput) * factor * factor,
                        1e-3 * luminance(q.light[k].throughput));
        ASSERT_EQ(p.paths.size(), q.paths.size());
        for (size_t k = 0; k < p.paths.size(); ++k) {
            if (p.paths[k].strategies.size() < 2) continue;
            // Each surface, and a lamp's point, is a density per area.
            const int areas = p.paths[k].contribution.strategy.edges() -
                              (p.paths[k].light_end.kind == VertexKind::area_light ? 0 : 1);
            for (size_t j = 0; j < p.paths[k].strategies.size(); ++j) {
                const InspectedStrategy &v = p.paths[k].strategies[j],
                                        &w = q.paths[k].strategies[j];
                if (!v.feasible) continue;
                EXPECT_NEAR(v.log10_pdf - w.log10_pdf, areas * std::log10(factor * factor), 1e-2);
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 200);
}

// The walks themselves: densities made from one side are those the other side's scattering says.
TEST(InspectedSample, WalksOfTheLightTechniqueEndWhereTheRendersDo) {
    const AgreementScene scene = make_agreement_scene("area");
    const InspectedSample light = inspect_sample(subject(scene, small(Technique::light)), 4, 3, 0);
    EXPECT_LE(light.camera.size(), 2u) << "the camera's walk only looks for lamps";
    const InspectedSample path = inspect_sample(subject(scene, small(Technique::path)), 4, 3, 0);
    EXPECT_TRUE(path.light.empty());
    EXPECT_GE(path.camera.size(), 2u);
    EXPECT_EQ(path.camera.front().kind, VertexKind::camera);
}

TEST(BrightestSample, IsTheBrightestOfAllWhoeverMadeIt) {
    int from_others = 0;
    for (const char* name : {"caustic", "five_lights", "area"}) {
        SCOPED_TRACE(name);
        Inspectable what = subject(make_agreement_scene(name), small());
        what.settings.width = 9;
        what.settings.height = 7;
        constexpr std::uint64_t first = 3, passes = 5;
        // What every sample gave to every pixel.
        struct Best {
            float luminance = 0;
            int x = 0, y = 0;
            std::uint64_t pass = 0;
        };
        std::map<std::pair<int, int>, Best> all, own;
        for (std::uint64_t pass = first; pass < first + passes; ++pass)
            for (int y = 0; y < 7; ++y)
                for (int x = 0; x < 9; ++x) {
                    const InspectedSample s = inspect_sample(what, x, y, pass);
                    for (int py = 0; py < 7; ++py)
                        for (int px = 0; px < 9; ++px) {
                            const float l = luminance(recorded_in(s, px, py)[0]);
                            Best& best = all[{px, py}];
                            if (l > best.luminance) best = {l, x, y, pass};
                            Best& mine = own[{px, py}];
                            if (px == x && py == y && l > mine.luminance) mine = {l, x, y, pass};
                        }
                }
        const RenderControl control;
        for (const auto& [pixel, best] : all) {
            for (const int threads : {1, 3}) {
                const BrightestSearch search{what,   pixel.first, pixel.second, first,
                                             passes, 0,           threads};
                const auto found = brightest_sample(search, control, {});
                ASSERT_EQ(found.has_value(), best.luminance > 0);
                if (!found) continue;
                EXPECT_EQ(found->luminance, best.luminance);
                EXPECT_EQ(std::tie(found->x, found->y, found->pass),
                          std::tie(best.x, best.y, best.pass));
                from_others += found->x != pixel.first || found->y != pixel.second;
            }
            const BrightestSearch search{what, pixel.first, pixel.second, first, passes};
            const auto mine = brightest_own_sample(search, control);
            const Best& expected = own[pixel];
            ASSERT_EQ(mine.has_value(), expected.luminance > 0);
            if (!mine) continue;
            EXPECT_EQ(std::tie(mine->luminance, mine->pass),
                      std::tie(expected.luminance, expected.pass));
        }
    }
    EXPECT_GT(from_others, 10);
}

TEST(BrightestSample, StopsWhenItIsToldTo) {
    const Inspectable what = subject(make_agreement_scene("caustic"), small());
    RenderControl control;
    control.cancel();
    const BrightestSearch search{what, 4, 3, 0, std::uint64_t{1} << 40};
    EXPECT_FALSE(brightest_own_sample(search, control));
    EXPECT_FALSE(brightest_sample(search, control, {}));
}

TEST(BrightestPixel, StandsOutFromItsNeighboursByItsVariance) {
    Image image(8, 6), variance(8, 6);
    EXPECT_FALSE(brightest_outlier(image, variance));
    // A bright edge with noise, as a lamp has.
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 4; ++x) image.at(x, y) = variance.at(x, y) = vec3(4);
    image.at(6, 2) = vec3(1.5f);
    variance.at(6, 2) = vec3(2.25f);
    // Bright beyond its neighbours, but surely so.
    image.at(5, 5) = vec3(3);
    variance.at(5, 5) = vec3(1e-4f);
    EXPECT_EQ(brightest_outlier(image, variance), ivec2(6, 2));
}

}  // namespace
}  // namespace midway::test
