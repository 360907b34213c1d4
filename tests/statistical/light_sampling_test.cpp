// Emission, next event and hits of the five kinds of light against their densities. False-alarm
// rate of each case: 1e-4, shared by its comparisons. Held with 20 other seeds
// (MIDWAY_TEST_SEED=1..20).
#include <gtest/gtest.h>

#include <numbers>

#include "math/warp.h"
#include "support/density.h"
#include "support/scenes.h"
#include "support/worker_mode.h"

namespace midway::test {
namespace {

constexpr double alarm = 1e-4;
constexpr double pi_d = std::numbers::pi;
constexpr int samples = 100'000;
using LightSampling = WorkerMode;

// A floor, so that a scene with lights alone has bounds; scale and centre differ from the file's.
SceneDescription floor_scene() {
    SceneDescription d;
    add(d, make_quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), lambert(vec3(0.5f)));
    return d;
}

EmissionNumbers numbers(Random& random) { return {random.next(), random.next2(), random.next2()}; }

void expect_density(const DensityResult& r, double level = alarm) {
    EXPECT_GT(r.test.p_value, level)
        << "chi-square " << r.test.statistic << " of " << r.test.degrees_of_freedom;
    EXPECT_EQ(r.test.impossible, 0);
    EXPECT_NEAR(r.integral, 1, 2e-3);
}

// Black parts reach into half of their neighbours' cells, where a draw carries nothing: `least`
// keeps all draws.
std::shared_ptr<Image> test_map(float least) {
    auto map = std::make_shared<Image>(16, 8);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x)
            map->at(x, y) = vec3(least + (x == 5 && y == 2 ? 40.0f : 0.0f) + (x > 8 ? 1.0f : 0.0f) +
                                 (y == 7 ? 0.5f : 0.0f)) *
                            vec3(1, 0.5f, 0.25f);
    return map;
}

SkyDescription map_sky(float least = 0.02f) {
    SkyDescription d;
    d.source = "map";
    d.map = test_map(least);
    d.rotation_degrees = 40;
    d.strength = 2;
    return d;
}

// Own form of KHR_lights_punctual's falloff with the smooth square, normalised in double.
double spot_density(double c, double inner, double outer) {
    const double ci = std::cos(inner), co = std::cos(outer);
    const double ramp = std::clamp((c - co) / (ci - co), 0.0, 1.0);
    return ramp * ramp / (2 * pi_d * ((1 - ci) + (ci - co) / 3));
}

TEST_F(LightSampling, PointAndSpotDirectionsFollowTheirIntensity) {
    const vec3 at(1, 2, 0.5f), to(0, 0, -1);
    for (const bool spot : {false, true}) {
        SceneDescription d = floor_scene();
        const float inner = 0.3f, outer = 0.7f;
        d.lights.push_back(spot ? spot_light(at, to, 5, inner, outer) : point_light(at, 5));
        const auto scene = build(d);
        const vec3 axis = glm::normalize(to - at);
        Random random(10 + spot);
        const double power = spot ? 5 / spot_density(1, inner, outer) : 5 * 4 * pi_d;
        const double unit = sqr(scene->geometry->normalisation.scale);
        EXPECT_NEAR(scene->total_power / unit, power, 1e-5 * power);
        const auto draw = [&]() -> std::optional<vec3> {
            const auto e = sample_emission(*scene, numbers(random));
            if (!e) return {};
            // One light: every sample carries the whole power.
            EXPECT_NEAR(e->weight.x / unit, power, 1e-4 * power);
            const double c = glm::dot(e->direction, axis);
            const double pdf = spot ? spot_density(c, inner, outer) : 1 / (4 * pi_d);
            // At the rim of the cone the density is a small difference.
            EXPECT_NEAR(e->pdfs.leave, pdf, 1e-3 * pdf + 1e-4);
            return e->direction;
        };
        expect_density(test_sphere_density(
            frame_from_normal(axis), {16, 256}, samples, draw, [&](const vec3& w) {
                return spot ? spot_density(glm::dot(w, axis), inner, outer) : 1 / (4 * pi_d);
            }));
    }
}

TEST_F(LightSampling, AreaLightsEmitUniformlyAndByTheCosine) {
    for (const bool two_sided : {false, true}) {
        SCOPED_TRACE(two_sided ? "two-sided" : "one-sided");
        SceneDescription d = floor_scene();
        Material m = lamp(vec3(3));
        m.double_sided = two_sided;
        add(d, make_quad({-1, 2, 0}, {2, 0, 0}, {0, 1, 1}), m);
        const auto scene = build(d);
        const Frame f{vec3(1, 0, 0), glm::normalize(vec3(0, 1, 1)),
                      glm::normalize(glm::cross(vec3(1, 0, 0), vec3(0, 1, 1)))};
        const double sides = two_sided ? 2 : 1;
        const double area = 2 * std::sqrt(2.0), unit = sqr(scene->geometry->normalisation.scale);
        EXPECT_NEAR(scene->total_power / unit, 3 * pi_d * area * sides, 1e-4);
        Random random(20 + two_sided);
        const auto emit = [&] { return sample_emission(*scene, numbers(random)); };
        const auto place = [&]() -> std::optional<dvec2> {
            const auto e = emit();
            EXPECT_NEAR(e->weight.x / unit, 3 * pi_d * area * sides, 1e-3);
            EXPECT_NEAR(e->pdfs.origin * unit, 1 / area, 1e-5);
            EXPECT_NEAR(e->pdfs.leave, e->cos_theta / pi_d / sides, 1e-5);
            EXPECT_NEAR(e->cos_theta, std::abs(glm::dot(e->direction, f.n)), 1e-5);
            const Normalisation& n = scene->geometry->normalisation;
            const dvec3 p = dvec3(e->position) / n.scale + n.center - dvec3(-1, 2, 0);
            return dvec2(p.x / 2, p.y);
        };
        expect_density(
            test_square_density({16, 16}, samples, place, [](double, double) { return 1.0; }),
            sidak_level(alarm, 4));
        const auto direction = [&] { return std::optional(emit()->direction); };
        expect_density(
            test_sphere_density(f, {16, 32}, samples, direction,
                                [&](const vec3& w) {
                                    const double c = glm::dot(w, f.n);
                                    return two_sided || c > 0 ? std::abs(c) / pi_d / sides : 0;
                                }),
            sidak_level(alarm, 4));
    }
}

TEST_F(LightSampling, InfiniteLightsCoverTheirDiscUniformly) {
    for (const bool sky : {false, true}) {
        SceneDescription d = floor_scene();
        if (sky)
            d.sky = map_sky();
        else
            d.lights.push_back(sun({0.2f, -1, 0.1f}, 2));
        const auto scene = build(d);
        Random random(30 + sky);
        const auto draw = [&]() -> std::optional<dvec2> {
            const auto e = sample_emission(*scene, numbers(random));
            if (!e) return {};
            const Frame f = frame_from_normal(e->direction);
            EXPECT_NEAR(glm::dot(e->position, e->direction), -scene->radius, 1e-5);
            EXPECT_NEAR(e->pdfs.leave, 1 / (pi_d * sqr(double(scene->radius))), 1e-4);
            return dvec2(glm::dot(e->position, f.s), glm::dot(e->position, f.t)) /
                       (2.0 * scene->radius) +
                   0.5;
        };
        expect_density(test_square_density({32, 32}, samples, draw,
                                           [](double x, double y) {
                                               const double r2 = sqr(2 * x - 1) + sqr(2 * y - 1);
                                               return r2 < 1 ? 4 / pi_d : 0.0;
                                           }),
                       sidak_level(alarm, 2));
    }
}

TEST_F(LightSampling, SkyDirectionsFollowTheirDensity) {
    Random random(40);
    const Sky sky = make_sky(map_sky());
    for (const bool through_emission : {false, true}) {
        SceneDescription d = floor_scene();
        d.sky = map_sky();
        const auto scene = build(d);
        const auto draw = [&]() -> std::optional<vec3> {
            if (through_emission) {
                const auto e = sample_emission(*scene, numbers(random));
                if (!e) return {};
                EXPECT_NEAR(e->pdfs.origin / sky_pdf_w(sky, -e->direction), 1, 1e-3);
                return -e->direction;
            }
            const SkySample s = sample_sky(sky, random.next2());
            return s.direction;
        };
        // Its own rows and columns, so that the steps of the density lie on the edges of cells.
        const auto place = [&]() -> std::optional<dvec2> {
            const auto w = draw();
            if (!w) return {};
            return dvec2(std::atan2(double(w->z), double(w->x)) / (2 * pi_d) + 0.5,
                         std::acos(std::clamp(double(w->y), -1.0, 1.0)) / pi_d);
        };
        expect_density(
            test_square_density({64, 40}, samples, place,
                                [&](double x, double y) {
                                    const double phi = 2 * pi_d * (x - 0.5), t = pi_d * y;
                                    const vec3 w(dvec3(std::sin(t) * std::cos(phi), std::cos(t),
                                                       std::sin(t) * std::sin(phi)));
                                    return sky_pdf_w(sky, w) * std::sin(t) * 2 * pi_d * pi_d;
                                }),
            sidak_level(alarm, 2));
    }
    EXPECT_GT(sky_pdf_w(sky, {0, 1, 0}) + sky_pdf_w(sky, {0, -1, 0}), 0);
}

// Every direction with radiance can be drawn.
TEST_F(LightSampling, SkyIsDrawnWhereverItShines) {
    const Sky sky = make_sky(map_sky(0));
    Random random(50);
    for (int i = 0; i < 100'000; ++i) {
        const vec3 w = square_to_sphere(random.next2());
        EXPECT_TRUE(is_black(sky_radiance(sky, w)) || sky_pdf_w(sky, w) > 0);
    }
    // Mean radiance: flux through the densities and by uniform directions.
    RunningMean drawn, uniform;
    for (int i = 0; i < 200'000; ++i) {
        const SkySample s = sample_sky(sky, random.next2());
        drawn.add(luminance(sky_radiance(sky, s.direction)) / s.pdf_w);
        uniform.add(4 * pi_d * luminance(sky_radiance(sky, square_to_sphere(random.next2()))));
    }
    EXPECT_GT(z_test(drawn.estimate(), uniform.estimate()), alarm);
    // All channels keep one ratio in this map: the mean over the sphere, which the power is made
    // of.
    const vec3 tint(1, 0.5f, 0.25f);
    const double mean = sky.mean_radiance / ((1.75 / 3) / luminance(tint)) * 4 * pi_d;
    EXPECT_NEAR(drawn.estimate().mean / mean, 1, 0.02);
}

// All five kinds together: the irradiance that next event finds at a point is the one by emission
// hits or by the formulas, and the densities of all interfaces are the same numbers.
TEST_F(LightSampling, NextEventFindsTheIrradianceOfEveryLight) {
    SceneDescription d = floor_scene();
    d.lights = {point_light({1, 2, 0.5f}, 5), spot_light({-1, 2, 0}, {0, 0, 0}, 9, 0.2f, 0.6f),
                sun({0.2f, -1, 0.1f}, 0.7f)};
    const vec3 corner(-0.5f, 1.5f, -0.5f);
    add(d, make_quad(corner, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    d.sky = map_sky();
    const auto scene = build(d);
    const Normalisation& n = scene->geometry->normalisation;
    const auto place = [&](const vec3& p) { return vec3((dvec3(p) - n.center) * n.scale); };
    const vec3 reference = place({0.3f, 0, 0.2f});
    std::vector<RunningMean> found(scene->lights.size());
    Random random(60);
    for (int i = 0; i < 400'000; ++i) {
        const auto e = sample_next_event(*scene, reference, {random.next(), random.next2()});
        for (size_t k = 0; k < found.size(); ++k)
            found[k].add(e && e->light == int(k)
                             ? luminance(e->value) * std::max(0.0f, e->direction.y)
                             : 0.0);
        if (!e || scene->lights[e->light].kind != LightKind::sky) continue;
        const auto hit = sky_hit(*scene, e->direction);
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->pdfs.next_event, e->pdfs.next_event);
    }
    const auto from_point = [&](const vec3& at, double intensity) {
        const dvec3 v = dvec3(at) - dvec3(0.3, 0, 0.2);
        return intensity * v.y / std::pow(glm::length(v), 3);
    };
    const double spot_cosine =
        glm::dot(glm::normalize(vec3(1.3f, -2, 0.2f)), glm::normalize(vec3(1, -2, 0)));
    const double falloff = spot_density(spot_cosine, 0.2, 0.6) / spot_density(1, 0.2, 0.6);
    const double level = sidak_level(alarm, 5);
    double lamp_irradiance = 0, expected_lamp = 0;
    for (int i = 0; i < 400; ++i)
        for (int j = 0; j < 400; ++j) {
            const dvec3 v = dvec3((i + 0.5) / 400 - 0.8, 1.5, (j + 0.5) / 400 - 0.7);
            expected_lamp += 4 * v.y * v.y / sqr(glm::dot(v, v)) / 160000;
        }
    double variance = 0;
    for (size_t k = 0; k < found.size(); ++k) {
        const Light& l = scene->lights[k];
        const Estimate e = found[k].estimate();
        if (l.kind == LightKind::point)
            EXPECT_GT(z_test(e, {from_point({1, 2, 0.5f}, 5), 1e-6}), level);
        else if (l.kind == LightKind::spot)
            EXPECT_GT(z_test(e, {from_point({-1, 2, 0}, 9 * falloff), 1e-6}), level);
        else if (l.kind == LightKind::directional)
            EXPECT_GT(z_test(e, {0.7 / std::sqrt(1.05), 1e-6}), level);
        else if (l.kind == LightKind::area) {
            lamp_irradiance += e.mean;
            variance += sqr(e.standard_error);
        }
    }
    EXPECT_GT(z_test({lamp_irradiance, std::sqrt(variance)}, {expected_lamp, 1e-6}), level);
}

}  // namespace
}  // namespace midway::test
