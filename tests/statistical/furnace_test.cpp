// White furnaces: what scatters all light is invisible in uniform light; what loses some shows its
// single-scattering albedo, which is integrated here independently. Renders are of the whole
// renderer. Emitter hits alone have no variance where nothing is lost, so every pixel is compared;
// where next event and connections take part, the image's mean is. Held with 20 other seeds.
#include <gtest/gtest.h>

#include <numbers>

#include "support/scenes.h"
#include "support/worker_mode.h"

namespace midway::test {
namespace {

constexpr double pi_d = std::numbers::pi;
constexpr double tolerance = 1e-3;
using Furnace = WorkerMode;

// In uniform radiance 1: a sky, or a black emitting sphere around the scene and the camera.
SceneDescription furnace(bool enclosed) {
    SceneDescription d;
    if (enclosed)
        add(d, make_icosphere(vec3(0), 9, 2, true), lamp(vec3(1)));
    else
        d.sky = constant_sky(vec3(1));
    return d;
}

struct Lossless {
    std::string name;
    Mesh mesh;
    Material material;
};

std::vector<Lossless> lossless() {
    Material solid = glass(0);
    solid.has_thickness = true;
    const Mesh smooth_ball = make_icosphere(vec3(0), 1, 3, false, true);
    const Mesh faceted = make_icosphere(vec3(0), 1, 3);
    return {{"diffuse", smooth_ball, lambert(vec3(1))},
            {"smooth metal", smooth_ball, metal(0)},
            {"smooth glass", faceted, solid},
            {"smooth thin glass", make_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), glass(0)}};
}

const CameraDescription front_camera() { return camera_at({0.3f, 0.2f, 5}, vec3(0), 0.5); }

// Bounces enough for light that is caught in glass for long; roulette ends it without bias.
TEST_F(Furnace, LosslessMaterialsVanishByEmitterHitsAlone) {
    for (const bool enclosed : {false, true})
        for (const Lossless& l : lossless()) {
            SCOPED_TRACE(l.name + (enclosed ? " in an emitter" : " under a sky"));
            SceneDescription d = furnace(enclosed);
            add(d, l.mesh, l.material);
            RenderSettings s = settings(Technique::path, 24, 5000);
            s.families = Families{true, false, false, false};
            const Image image = render(build(d), front_camera(), s, 4);
            for (const vec3& p : image.pixels) EXPECT_NEAR(p.x, 1, tolerance);
        }
}

TEST_F(Furnace, LosslessMaterialsVanishForEveryTechnique) {
    for (const bool enclosed : {false, true})
        for (const Lossless& l : lossless())
            for (const Technique technique : {Technique::path, Technique::bdpt}) {
                SCOPED_TRACE(l.name + (enclosed ? " in an emitter, " : " under a sky, ") +
                             std::string(to_string(technique)));
                SceneDescription d = furnace(enclosed);
                add(d, l.mesh, l.material);
                RenderSettings s = settings(technique, 16, 200);
                const Estimate e = batch_mean(build(d), front_camera(), s, 32, 8);
                EXPECT_NEAR(e.mean, 1, tolerance + 4 * e.standard_error);
                EXPECT_LT(e.standard_error, 2 * tolerance);
            }
}

struct Single {
    double reflected = 0, transmitted = 0;
};

double dielectric(double c, double eta) {
    const double g2 = eta * eta - 1 + c * c;
    if (g2 <= 0) return 1;
    // Cook & Torrance 1982.
    const double g = std::sqrt(g2), a = (g - c) / (g + c);
    const double b = (c * (g + c) - 1) / (c * (g - c) + 1);
    return 0.5 * a * a * (1 + b * b);
}

double smith_lambda(double z, double alpha) {
    return 0.5 * (std::sqrt(1 + alpha * alpha * (1 / (z * z) - 1)) - 1);
}

// The integral over microfacet normals of F D G2 (o.h) / o.z and of its complement, GGX with
// height-correlated masking. tan^2 = alpha^2 (1 / (1 - v)^2 - 1) takes D cos into 2 (1 - v) dv.
template <class Reflectance>
Single single_scattering(double z, double alpha, double eta, bool thin, const Reflectance& f) {
    constexpr int n = 1000, m = 400;
    const dvec3 o(std::sqrt(1 - z * z), 0, z);
    Single sum;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            const double v = (i + 0.5) / n, phi = pi_d * (j + 0.5) / m;
            const double c = 1 / std::sqrt(1 + alpha * alpha * (1 / ((1 - v) * (1 - v)) - 1));
            const double s = std::sqrt(1 - c * c);
            const dvec3 h(s * std::cos(phi), s * std::sin(phi), c);
            const double oh = glm::dot(o, h);
            if (oh <= 0) continue;
            const double weight = 2 * (1 - v) * oh / (z * c), r = f(oh);
            const auto masked = [&](double other) {
                return weight / (1 + smith_lambda(z, alpha) + smith_lambda(other, alpha));
            };
            const double mirrored = (2 * oh * h - o).z;
            if (mirrored > 0) sum.reflected += r * masked(mirrored);
            if (thin && mirrored > 0) sum.transmitted += (1 - r) * masked(mirrored);
            const double cos2 = 1 - (1 - oh * oh) / (eta * eta);
            if (thin || r >= 1 || cos2 <= 0) continue;
            const double below = (h * (oh / eta - std::sqrt(cos2)) - o / eta).z;
            if (below < 0) sum.transmitted += (1 - r) * masked(-below);
        }
    return {sum.reflected / (n * m), sum.transmitted / (n * m)};
}

// A flat sheet seen at cosine z from its front (or back) under a white sky.
double seen_in_furnace(const Material& material, double z, bool from_back) {
    // Light out of glass is 2.25 times as strong, and as noisy.
    const std::uint64_t passes = material.transmission > 0 ? 3072 : 512;
    SceneDescription d = furnace(false);
    add(d, make_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), material);
    const float side = from_back ? -1.0f : 1.0f, r = float(std::sqrt(1 - z * z));
    const auto camera = camera_at({5 * r, 0, 5 * side * float(z)}, vec3(0), 1e-3);
    RenderSettings s = settings(Technique::path, 16, 1);
    s.families = Families{true, false, false, false};
    return image_mean(render(build(d), camera, s, passes));
}

TEST_F(Furnace, RoughMetalShowsItsSingleScatteringAlbedo) {
    for (const float roughness : {0.3f, 0.6f, 1.0f})
        for (const double z : {1.0, 0.5, 0.15}) {
            const auto schlick = [](double c) { return 0.6 + 0.4 * std::pow(1 - c, 5); };
            const Single e = single_scattering(z, sqr(double(roughness)), 1, false, schlick);
            EXPECT_NEAR(seen_in_furnace(metal(roughness, vec3(0.6f)), z, false), e.reflected,
                        tolerance)
                << roughness << " at " << z;
        }
}

// Radiance that crosses is divided by the square of the index it comes from, relative to its own.
TEST_F(Furnace, RoughGlassShowsItsSingleScatteringAlbedo) {
    for (const float roughness : {0.3f, 0.7f})
        for (const double z : {0.95, 0.4})
            for (const bool from_back : {false, true}) {
                Material solid = glass(roughness);
                solid.has_thickness = true;
                const double eta = from_back ? 1 / 1.5 : 1.5;
                const auto fresnel = [&](double c) { return dielectric(c, eta); };
                const Single e = single_scattering(z, sqr(double(roughness)), eta, false, fresnel);
                EXPECT_NEAR(seen_in_furnace(solid, z, from_back),
                            e.reflected + e.transmitted / (eta * eta), tolerance)
                    << roughness << " at " << z << (from_back ? " from the back" : "");
            }
}

TEST_F(Furnace, RoughThinGlassShowsItsSingleScatteringAlbedo) {
    for (const bool from_back : {false, true})
        for (const double z : {0.95, 0.4}) {
            const auto sheet = [](double c) {
                const double r = dielectric(c, 1.5);
                return 2 * r / (1 + r);
            };
            const Single e = single_scattering(z, 0.25, 1.5, true, sheet);
            EXPECT_NEAR(seen_in_furnace(glass(0.5f), z, from_back), e.reflected + e.transmitted,
                        tolerance);
        }
}

// A normal map of random tilts up to 60 degrees.
SceneDescription normal_mapped(const Material& material) {
    SceneDescription d = furnace(false);
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 8;
    Random random(7);
    for (int i = 0; i < 64; ++i) {
        const float tilt = random.next() * pi / 3, phi = 2 * pi * random.next();
        const vec3 n(std::sin(tilt) * std::cos(phi), std::sin(tilt) * std::sin(phi),
                     std::cos(tilt));
        for (int c = 0; c < 3; ++c)
            image->rgba.push_back(static_cast<std::uint8_t>(std::lround((n[c] + 1) * 127.5f)));
        image->rgba.push_back(255);
    }
    d.images.push_back(image);
    Material m = material;
    m.normal_texture.image = 0;
    m.normal_texture.nearest = true;
    add(d, make_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), m);
    return d;
}

TEST_F(Furnace, NormalMapsNeverAddLight) {
    Material solid = glass(0.4f), mixed = plastic(0.4f);
    solid.has_thickness = true;
    mixed.metallic = 0.5f;
    // Rough reflection is bounded by the albedo below 1; solid glass by its radiance outside: 1.
    const std::pair<const char*, Material> materials[] = {
        {"diffuse", lambert(vec3(1))}, {"mirror", metal(0)},   {"metal", metal(0.5f)},
        {"plastic", plastic(0.3f)},    {"mixed", mixed},       {"smooth glass", glass(0)},
        {"glass", glass(0.4f)},        {"solid glass", solid}, {"smooth plastic", plastic(0)}};
    for (const auto& [name, material] : materials) {
        SCOPED_TRACE(name);
        RenderSettings s = settings(Technique::path, 16, 1);
        s.families = Families{true, false, false, false};
        const Image image =
            render(build(normal_mapped(material)), camera_at({1.5f, 0, 2}, vec3(0), 0.5), s, 2048);
        // A pixel's noise was measured to be 2e-3 at most.
        for (const vec3& p : image.pixels) EXPECT_LE(p.x, 1 + 10 * tolerance);
        EXPECT_LE(image_mean(image), 1 + tolerance);
    }
}

}  // namespace
}  // namespace midway::test
