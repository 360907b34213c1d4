// Scenes whose radiance is known, rendered by every technique that covers them. The mean of the
// image is compared by a z-test at 1e-4 a case (shared), plus the stated error of the model
// (facets, the pixel's extent). Held with 20 other seeds (MIDWAY_TEST_SEED=1..20). Finds 1 % of a
// wrong factor.
#include <gtest/gtest.h>

#include <numbers>

#include "support/scenes.h"
#include "support/worker_mode.h"

namespace midway::test {
namespace {

constexpr double pi_d = std::numbers::pi;
constexpr double alarm = 1e-4;
using ClosedForm = WorkerMode;

constexpr Technique every_technique[] = {Technique::path, Technique::light, Technique::bdpt};

// `model_error` is relative.
void expect_radiance(const SceneDescription& d, const CameraDescription& camera, RenderSettings s,
                     double expected, std::uint64_t passes, double model_error, double level) {
    constexpr int batches = 24;
    const Estimate e = batch_mean(build(d), camera, s, passes, batches);
    // The spread of 24 batches is itself uncertain by 15 %: 1.3 makes a normal of the
    // t-distribution.
    const double reach = -normal_quantile(level / 2) * 1.3 * e.standard_error;
    EXPECT_NEAR(e.mean, expected, model_error * expected + reach) << to_string(s.technique);
    EXPECT_LT(e.standard_error, 0.015 * expected) << "too noisy to tell";
}

SceneDescription white_floor(float albedo) {
    SceneDescription d;
    add(d, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}), lambert(vec3(albedo)));
    return d;
}

CameraDescription floor_camera() { return camera_at({0.3f, 2, 2}, vec3(0), 0.3); }

// The mean over the view of what the floor (y = 0, the camera above) sends, by its place.
template <class Radiance>
double mean_over_view(const SceneDescription& d, const CameraDescription& camera,
                      const Radiance& radiance) {
    constexpr int n = 400;
    const Normalisation normalisation = build(d)->geometry->normalisation;
    const Camera c = make_camera(camera, normalisation, n, n);
    const dvec3 eye(camera.to_world[3]);
    double sum = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const dvec3 w(camera_direction(c, c.position, {x + 0.5f, y + 0.5f}));
            sum += radiance(eye - w * (eye.y / w.y));
        }
    return sum / (n * n);
}

TEST_F(ClosedForm, PointAndSpotFollowTheInverseSquare) {
    for (const Technique technique : every_technique)
        for (const double height : {1.0, 2.0})
            for (const bool spot : {false, true}) {
                SCOPED_TRACE(testing::Message() << height << (spot ? " spot" : " point"));
                SceneDescription d = white_floor(0.8f);
                const vec3 at(0, float(height), 0);
                // The view lies inside the inner cone.
                d.lights.push_back(spot ? spot_light(at, vec3(0), 3, 0.9f, 1.0f)
                                        : point_light(at, 3));
                const double expected = mean_over_view(d, floor_camera(), [&](const dvec3& p) {
                    const double r2 = glm::dot(p, p) + height * height;
                    return 0.8 / pi_d * 3 * height / (r2 * std::sqrt(r2));
                });
                expect_radiance(d, floor_camera(), settings(technique, 8, 1), expected,
                                technique == Technique::light ? 512 : 64, 1e-4, alarm / 12);
            }
}

// Facets keep their own normals: smooth ones give light subpaths weights without bound at grazing
// angles. Finds 5 % of a wrong power.
// The spot's whole power, measured by an integrating sphere: from the second bounce on, its
// radiance is the same everywhere.
TEST_F(ClosedForm, SpotHasThePowerOfItsCone) {
    const double albedo = 0.6, radius = 2, inner = 0.4, outer = 0.9;
    SceneDescription d;
    add(d, make_icosphere(vec3(0), radius, 4, true), lambert(vec3(float(albedo))));
    d.lights.push_back(spot_light({0, 0, 0}, {0, -1, 0}, 2, float(inner), float(outer)));
    const double ci = std::cos(inner), co = std::cos(outer);
    const double power = 2 * 2 * pi_d * ((1 - ci) + (ci - co) / 3);
    const double expected =
        power * albedo * albedo / (4 * pi_d * pi_d * radius * radius * (1 - albedo));
    for (const Technique technique : every_technique)
        expect_radiance(d, camera_at(vec3(0), {0.2f, 1, 0}, 1), settings(technique, 8, 24),
                        expected, 64, 4e-3, alarm / 3);
}

// L = Le + L / 2.
TEST_F(ClosedForm, EmissiveSphereOfAlbedoOneHalfDoublesItsRadiance) {
    SceneDescription d;
    add(d, make_icosphere(vec3(0), 1.5f, 2, true), lamp(vec3(0.7f), vec3(0.5f)));
    for (const Technique technique : every_technique)
        expect_radiance(d, camera_at(vec3(0.1f), {0.3f, 1, 0}, 1), settings(technique, 8, 40), 1.4,
                        64, 1e-4, alarm / 3);
}

// A sphere of albedo 1/2 in an emissive sphere of the same radiance everywhere shows half of it,
// plus what it sees of itself: nothing, for it is convex.
TEST_F(ClosedForm, ConvexBodyInUniformLightShowsItsAlbedo) {
    SceneDescription d;
    add(d, make_icosphere(vec3(0), 4, 2, true), lamp(vec3(1)));
    add(d, make_icosphere(vec3(0), 1, 2), lambert(vec3(0.5f)));
    for (const Technique technique : {Technique::path, Technique::bdpt})
        expect_radiance(d, camera_at({0, 0, 3}, vec3(0), 0.3), settings(technique, 8, 4), 0.5, 64,
                        1e-4, alarm / 2);
}

// A disc lamp of radius r at height h lights a parallel element at distance a from its axis by the
// view factor (1 - (1 + H^2 - R^2) / sqrt(Z^2 - 4 R^2)) / 2, H = h / a, R = r / a, Z = 1 + H^2 +
// R^2; on the axis r^2 / (r^2 + h^2) (Siegel & Howell, Thermal Radiation Heat Transfer).
TEST_F(ClosedForm, DiscLampLightsAParallelFloor) {
    const double r = 0.7, h = 1.1;
    SceneDescription d = white_floor(0.5f);
    add(d, make_disc({0, float(h), 0}, {0, -1, 0}, float(r)), lamp(vec3(2)));
    const CameraDescription camera = camera_at({0.3f, 0.9f, 2}, vec3(0), 0.25);
    const double expected = mean_over_view(d, camera, [&](const dvec3& p) {
        const double a2 = glm::dot(p, p), z = a2 + h * h + r * r;
        return 0.5 * 2 * 0.5 * (1 - (a2 + h * h - r * r) / std::sqrt(z * z - 4 * r * r * a2));
    });
    for (const Technique technique : every_technique)
        expect_radiance(d, camera, settings(technique, 8, 1), expected,
                        technique == Technique::light ? 512 : 64, 2e-4, alarm / 3);
}

// The share of a disc's light that arrives at a parallel coaxial disc (Walton 2002, and every text
// on view factors): light subpaths counted as they hit.
TEST_F(ClosedForm, DiscLampReachesACoaxialDiscByTheViewFactor) {
    const double r1 = 0.5, r2 = 0.9, h = 0.8;
    SceneDescription d;
    add(d, make_disc({0, 0, 0}, {0, 0, 1}, float(r1)), lamp(vec3(1)));
    add(d, make_disc({0, 0, float(h)}, {0, 0, -1}, float(r2)), lambert(vec3(1)));
    const double x1 = r1 / h, x2 = r2 / h, sum = 1 + (1 + x2 * x2) / (x1 * x1);
    const double factor = 0.5 * (sum - std::sqrt(sum * sum - 4 * sqr(r2 / r1)));
    const auto scene = build(d);
    Random random(9);
    RunningMean hits;
    for (int i = 0; i < 400'000; ++i) {
        const auto e = sample_emission(*scene, {random.next(), random.next2(), random.next2()});
        const vec3 origin = offset_origin(e->position, e->normal, e->error, e->direction);
        const auto hit = intersect(*scene, {origin, e->direction}, 0);
        hits.add(hit && hit->hit.object == 1 ? 1 : 0);
    }
    EXPECT_GT(z_test(hits.estimate(), {factor, 1e-4}), alarm);
}

// A sky alone: the image is the map.
TEST_F(ClosedForm, SkyWithoutGeometryShowsItsMap) {
    auto map = std::make_shared<Image>(32, 16);
    Random random(11);
    for (vec3& p : map->pixels) p = vec3(random.next3()) * 3.0f;
    for (const bool textured : {false, true})
        for (const Technique technique : every_technique) {
            SceneDescription d;
            d.sky = constant_sky({0.3f, 0.6f, 0.9f});
            if (textured) {
                d.sky->map = map;
                d.sky->color = vec3(1);
                d.sky->rotation_degrees = 25;
            }
            const auto scene = build(d);
            const auto camera = camera_at(vec3(0), {0.3f, 0.4f, -1}, 1.2);
            const Image image = render(scene, camera, settings(technique, 24), 64);
            const Camera c = make_camera(camera, scene->geometry->normalisation, 24, 24);
            for (int y = 0; y < 24; ++y)
                for (int x = 0; x < 24; ++x) {
                    vec3 expected(0);
                    for (int k = 0; k < 256; ++k) {
                        const vec2 at(x + (k % 16 + 0.5f) / 16, y + (k / 16 + 0.5f) / 16);
                        expected +=
                            sky_radiance(*scene->sky, camera_direction(c, c.position, at)) / 256.0f;
                    }
                    EXPECT_LT(glm::length(image.at(x, y) - expected), textured ? 0.05f : 1e-5f);
                }
        }
}

}  // namespace
}  // namespace midway::test
