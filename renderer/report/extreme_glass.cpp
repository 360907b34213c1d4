// Roughness from smooth to rough across the switch to Dirac lobes, indices of refraction about 1,
// and glass bodies in unusual places. A lossless body in uniform light cannot be seen: its
// radiance is known.
#include <fmt/format.h>

#include <cmath>

#include "report/extreme_groups.h"
#include "report/extreme_measure.h"
#include "report/extreme_scenes.h"
#include "scene/sky.h"

namespace midway::extreme {
namespace {

// roughness = sqrt(alpha): the switch lies at sqrt(1e-3) = 0.0316.
constexpr float below_switch = 0.0315f, above_switch = 0.0318f;

Material solid_glass(float roughness, float ior) {
    Material m = glass(roughness, ior);
    m.has_thickness = true;
    return m;
}

// A ball before a floor and a wall under a broad lamp and a sky with a gradient.
Setup ball(const Material& material, std::uint64_t seed) {
    Setup s{fmt::format("ball of roughness {:g}", material.roughness),
            {},
            camera_at({0, 0.7f, 3}, {0, 0.5f, 0}, 0.45),
            settings(Technique::bdpt, 12, 6)};
    add(s.scene, make_quad({-1.5f, 0, 1.5f}, {3, 0, 0}, {0, 0, -3}), lambert(vec3(0.6f)));
    add(s.scene, make_quad({-1.5f, 0.1f, -1.2f}, {3, 0, 0}, {0, 1, 0}),
        lambert({0.3f, 0.5f, 0.7f}));
    add(s.scene, make_quad({-1, 2.5f, -0.5f}, {2, 0, 0}, {0, 0, 2}), lamp(vec3(1.5f)));
    if (material.metallic > 0 || material.transmission > 0)
        add(s.scene, make_icosphere({0, 0.6f, 0}, 0.5f, 3, false, true), material);
    s.scene.sky = default_sky();
    s.settings.seed = seed;
    return s;
}

CaseResult roughness_is_continuous(const CaseContext& context) {
    const float rough[] = {0.042f, 0.056f, 0.075f, 0.1f,  0.13f, 0.18f,
                           0.24f,  0.32f,  0.42f,  0.56f, 0.75f, 1.0f};
    Judge judge(context, 2 * (1 + static_cast<int>(std::size(rough))));
    for (const bool metallic : {true, false}) {
        const auto with = [&](float r, std::uint64_t seed) {
            return ball(metallic ? metal(r) : solid_glass(r, 1.5f), seed);
        };
        const std::string what = metallic ? "metal" : "glass";
        const Setup smooth = with(below_switch, 1);
        const auto film = render(smooth, build(smooth), context, 4).film;
        for (const float r : {0.0f, 1e-6f, 1e-5f, 1e-4f, 1e-3f, 1e-2f}) {
            const Setup s = with(r, 1);
            judge.holds(fmt::format("{} of roughness {:g} is smooth", what, r),
                        render(s, build(s), context, 4).film == film);
        }
        const Effort effort{32, 24};
        RunningMean before = mean_over_seeds(smooth, context, effort);
        RunningMean now = mean_over_seeds(with(above_switch, 2), context, effort);
        // A lobe this narrow blurs by 0.06 degrees.
        judge.equal(what + " at the switch", now, before, 2e-3);
        std::uint64_t seed = 3;
        for (const float r : rough) {
            before = now;
            now = mean_over_seeds(with(r, seed++), context, {64, 24});
            // A third more roughness changes the mean by less than this.
            judge.equal(fmt::format("{} of roughness {:g} after the one before", what, r), now,
                        before, 0.2);
        }
    }
    return judge.result();
}

CaseResult indices_about_one(const CaseContext& context) {
    struct Row {
        float roughness, ior;
        double model_error;
    };
    const Row rows[] = {{0, 1, 1e-5},        {0, 1 + 1e-6f, 1e-5},    {0, 1 - 1e-6f, 1e-5},
                        {0.4f, 1, 1e-5},     {0.4f, 1 + 1e-6f, 1e-5}, {0.4f, 1 - 1e-6f, 1e-5},
                        {0.1f, 1.002f, 3e-3}};  // moves what is seen at its rim
    Judge judge(context, static_cast<int>(std::size(rows)));
    const auto mean = [&](const Material& material, std::uint64_t seed) {
        Setup s = ball(material, seed);
        // Each way through the ball takes two bounces more.
        s.settings.max_bounces = 24;
        return mean_over_seeds(s, context, {128, 24});
    };
    const RunningMean nothing = mean(lambert(vec3(0)), 1);
    for (const Row& row : rows)
        judge.equal(fmt::format("index {:.6f}, roughness {:g}", row.ior, row.roughness),
                    mean(solid_glass(row.roughness, row.ior), 2), nothing, row.model_error);
    return judge.result();
}

// White floor under a white sky: radiance 1 wherever one looks, glass or not.
Setup furnace(const std::string& name, Technique technique, const CameraDescription& camera) {
    // Light is caught between facets for long.
    Setup s{name, {}, camera, settings(technique, 8, 2000)};
    add(s.scene, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}), lambert(vec3(1)));
    s.scene.sky = constant_sky(vec3(1));
    return s;
}

CameraDescription outside() { return camera_at({0, 1, 4}, {0, 0.7f, 0}, 0.3); }

Mesh box(const vec3& low, const vec3& high, bool inward = false) {
    const vec3 d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
    Mesh all;
    for (const Mesh& m :
         {make_quad(low, y, x), make_quad(low, x, z), make_quad(low, z, y), make_quad(high, -x, -y),
          make_quad(high, -z, -x), make_quad(high, -y, -z)}) {
        const auto first = static_cast<unsigned>(all.positions.size());
        all.positions.insert(all.positions.end(), m.positions.begin(), m.positions.end());
        for (uvec3 t : m.triangles) {
            if (inward) std::swap(t.y, t.z);
            all.triangles.push_back(t + first);
        }
    }
    return all;
}

struct Body {
    std::string name;
    std::vector<std::pair<Mesh, Material>> parts;
};

std::vector<Body> lossless_bodies() {
    const vec3 c(0, 0.8f, 0);
    const auto sphere = [&](float r, bool inward = false) {
        return make_icosphere(c, r, 2, inward);
    };
    const Material g = solid_glass(0, 1.5f);
    const vec3 half(0.5f, 0, 0);
    const Mesh left = box(c - vec3(0.6f, 0.4f, 0.4f), c + vec3(0, 0.4f, 0.4f));
    const auto right = [&](float gap) {
        return box(c - vec3(-gap, 0.4f, 0.4f), c + vec3(0.6f, 0.4f, 0.4f));
    };
    return {{"index 3", {{sphere(0.6f), solid_glass(0, 3)}}},
            {"index 1/1.5", {{sphere(0.6f), solid_glass(0, 1 / 1.5f)}}},
            {"inside out", {{sphere(0.6f, true), g}}},
            {"nested", {{sphere(0.6f), g}, {sphere(0.4f), solid_glass(0, 1.3f)}}},
            {"bubble", {{sphere(0.6f), g}, {sphere(0.4f, true), g}}},
            {"gap of 1e-5", {{left, g}, {right(1e-5f), g}}},
            {"overlap of 1e-5", {{left, g}, {right(-1e-5f), g}}}};
}

CaseResult lossless_glass(const CaseContext& context) {
    const std::vector<Body> bodies = lossless_bodies();
    Judge judge(context, 2 * static_cast<int>(bodies.size()));
    for (const Body& body : bodies)
        for (const Technique technique : {Technique::path, Technique::bdpt}) {
            Setup s = furnace(body.name, technique, outside());
            for (const auto& [mesh, material] : body.parts) add(s.scene, mesh, material);
            judge.known(body.name + ", " + label(s.settings), mean_over_seeds(s, context, {32, 16}),
                        1, 1e-3);
        }
    return judge.result();
}

// Faces in one place have no order: what is seen through them is a matter of definition, but every
// technique must see the same.
CaseResult touching_glass(const CaseContext& context) {
    const vec3 c(0, 0.8f, 0);
    const auto setup = [&](Technique technique) {
        Setup s = furnace("touching glass", technique, outside());
        s.scene.sky = default_sky();
        s.settings.max_bounces = 24;
        const Material g = solid_glass(0, 1.5f);
        add(s.scene, box(c - vec3(0.6f, 0.4f, 0.4f), c + vec3(0, 0.4f, 0.4f)), g);
        add(s.scene, box(c - vec3(0, 0.4f, 0.4f), c + vec3(0.6f, 0.4f, 0.4f)), g);
        return s;
    };
    Judge judge(context, 1);
    Setup other = setup(Technique::path);
    other.settings.seed = 9;
    judge.equal("bdpt:2 against path", mean_over_seeds(setup(Technique::bdpt), context, {32, 24}),
                mean_over_seeds(other, context, {32, 24}));
    return judge.result();
}

CaseResult camera_inside(const CaseContext& context) {
    Judge judge(context, 4);
    const vec3 c(0, 0.8f, 0);
    for (const Technique technique : {Technique::path, Technique::bdpt}) {
        // Radiance in glass is n^2 times that in air.
        Setup s = furnace("camera in glass", technique, camera_at(c, {0.3f, 0, 1}, 1.0));
        add(s.scene, make_icosphere(c, 0.5f, 3), solid_glass(0, 1.5f));
        judge.known("in glass, " + label(s.settings), mean_over_seeds(s, context, {32, 16}), 2.25,
                    1e-3);
        // Le + a L all around.
        Setup l{"camera in a lamp",
                {},
                camera_at({0.3f, 0.1f, 0}, {1, 1, 0.3f}, 1.0),
                settings(technique, 8, 40)};
        Material glow = lamp(vec3(1), vec3(0.5f));
        glow.double_sided = true;
        add(l.scene, make_icosphere(vec3(0), 0.9f, 2), glow);
        judge.known("in a lamp, " + label(l.settings), mean_over_seeds(l, context, {32, 16}), 2,
                    1e-4);
    }
    return judge.result();
}

}  // namespace

std::vector<ExtremeCase> glass_cases() {
    return {
        {"roughness", "continuous",
         "metal and glass of roughness 0 to 0.0315 are one image bit for bit, and the mean goes "
         "on without a step from there to 1",
         false, roughness_is_continuous},
        {"roughness", "indices_about_one",
         "glass of index 1, 1 +- 1e-6 and (of roughness 0.1) 1.002 cannot be seen", false,
         indices_about_one},
        {"roughness", "lossless_glass",
         "glass of index 3 or below 1, inside out, nested, hollow or nearly touching does not "
         "change uniform light",
         true, lossless_glass},
        {"roughness", "touching_glass",
         "two bodies that share a face look the same to every technique", true, touching_glass},
        {"roughness", "camera_inside",
         "a camera inside glass sees n^2 times the sky, one inside a lamp the lamp", true,
         camera_inside}};
}

}  // namespace midway::extreme
