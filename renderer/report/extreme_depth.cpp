// Geometry term and depth: connections over a hundred-thousandth of the scene, grazing angles,
// lamps that touch walls; hundreds of bounces.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "math/float_mode.h"
#include "report/extreme_groups.h"
#include "report/extreme_measure.h"
#include "report/extreme_scenes.h"

namespace midway::extreme {
namespace {

constexpr double pi_d = std::numbers::pi;

RenderSettings bdpt(double exponent, int size, int max_bounces) {
    RenderSettings s = settings(Technique::bdpt, size, max_bounces);
    s.exponents = {exponent};
    return s;
}

// A closed box whose walls all have one material; fronts look inwards.
void add_room(SceneDescription& d, const Material& m, const vec3& size) {
    const vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), low = -0.5f * size,
                                                                  high = 0.5f * size;
    for (const Mesh& wall :
         {make_quad(low, x, y), make_quad(low, z, x), make_quad(low, y, z), make_quad(high, -y, -x),
          make_quad(high, -x, -z), make_quad(high, -z, -y)})
        add(d, wall, m);
}

// Where all walls send the same radiance, a corner does too: Le (1 + a + a^2 + ... + a^n).
CaseResult corner(const CaseContext& context) {
    constexpr float albedo = 0.5f;
    constexpr int bounces = 8;
    const double expected = (1 - std::pow(albedo, bounces + 1)) / (1 - albedo);
    Judge judge(context, 8);
    for (const double away : {1e-2, 1e-3, 1e-4, 1e-5})
        for (const double exponent : {1.0, 2.0}) {
            Setup s{fmt::format("corner at {:g}", away),
                    {},
                    camera_at(vec3(0), {0.5f, 0.5f, 0.5f}, 4 * away),
                    bdpt(exponent, 8, bounces)};
            add_room(s.scene, lamp(vec3(1), vec3(albedo)), vec3(1));
            judge.known(fmt::format("{}, {}", s.name, label(s.settings)),
                        mean_over_seeds(s, context, {32, 24}), expected, 1e-5);
        }
    return judge.result();
}

// A Lambertian floor under a uniform sky has one radiance, from wherever it is seen; a lamp low
// above it gives I h / d^3.
CaseResult grazing(const CaseContext& context) {
    Judge judge(context, 9);
    for (const double degrees : {89.0, 89.9, 89.99, 89.999, 89.9999}) {
        const double up = std::cos(degrees * pi_d / 180);
        Setup s{fmt::format("seen at {} degrees", degrees),
                {},
                camera_at({0, float(up), 1}, {0, 0, 0}, 0.5 * up),
                settings(Technique::bdpt, 8, 1)};
        add(s.scene, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}), lambert(vec3(0.5f)));
        s.scene.sky = constant_sky(vec3(1));
        judge.known(s.name, mean_over_seeds(s, context, {64, 24}), 0.5, 1e-4);
    }
    for (const double degrees : {89.0, 89.9, 89.99, 89.999}) {
        const double h = std::cos(degrees * pi_d / 180);
        Setup s{fmt::format("lit at {} degrees", degrees),
                {},
                camera_at({0, 1, 0.5f}, {0, 0, 0}, 0.2),
                settings(Technique::path, 8, 1)};
        add(s.scene, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}), lambert(vec3(0.5f)));
        s.scene.lights.push_back(point_light({1, float(h), 0}, float(1 / h)));
        const double expected = mean_over_floor(s, [&](const dvec3& p) {
            const double d2 = sqr(p.x - 1) + p.z * p.z + h * h;
            return 0.5 / pi_d / (d2 * std::sqrt(d2));
        });
        judge.known(s.name, mean_over_seeds(s, context, {64, 24}), expected, 1e-4);
    }
    return judge.result();
}

// A lamp that stands on the floor along the whole of one edge: an element of the floor at distance
// c from the lamp's foot sees, of the part of width b to one side of it and of height a,
// (atan(1/Y) - Y / sqrt(X^2 + Y^2) atan(1 / sqrt(X^2 + Y^2))) / 2 pi, X = a / b, Y = c / b
// (Hamilton & Morgan 1952, a point and a perpendicular rectangle).
double half_factor(double a, double b, double c) {
    const double x = a / b, y = c / b, root = std::sqrt(x * x + y * y);
    return (std::atan(1 / y) - y / root * std::atan(1 / root)) / (2 * pi_d);
}

CaseResult lamp_on_a_wall(const CaseContext& context) {
    constexpr double a = 0.3, half_width = 0.4;
    Judge judge(context, 4);
    for (const double away : {0.1, 1e-3})
        for (const double exponent : {1.0, 2.0}) {
            // Sees the floor from the foot of the lamp on.
            Setup s{fmt::format("{:g} from a lamp that touches", away),
                    {},
                    camera_at({0, 0.5f, 0.5f}, {0, 0, float(away)}, away),
                    bdpt(exponent, 8, 1)};
            add(s.scene, make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}), lambert(vec3(0.5f)));
            add(s.scene,
                make_quad({float(-half_width), 0, 0}, {float(2 * half_width), 0, 0},
                          {0, float(a), 0}),
                lamp(vec3(1)));
            const double expected = mean_over_floor(s, [&](const dvec3& p) {
                return 0.5 * (half_factor(a, half_width - p.x, p.z) +
                              half_factor(a, half_width + p.x, p.z));
            });
            judge.known(fmt::format("{}, {}", s.name, label(s.settings)),
                        mean_over_seeds(s, context, {64, 24}), expected, 1e-3);
        }
    return judge.result();
}

constexpr int deep = 500;
constexpr float half_length = 10;  // of the rod

// Le (1 + a + ... + a^500) with a = 0.999: 394.2 Le.
CaseResult white_room(const CaseContext& context) {
    const double albedo = 0.999f, expected = (1 - std::pow(albedo, deep + 1)) / (1 - albedo);
    // Roulette's survivors of 500 bounces are few: bdpt is held to 15 %, the others reach 1 %.
    Judge judge(context, 3, 0.15);
    for (const Technique technique : {Technique::path, Technique::light, Technique::bdpt}) {
        Setup s{"white room",
                {},
                camera_at({0.2f, 0.1f, 0}, {1, 0.3f, 0.5f}, 1.0),
                settings(technique, technique == Technique::bdpt ? 2 : 8, deep)};
        add_room(s.scene, lamp(vec3(1), vec3(float(albedo))), vec3(1, 0.8f, 1.2f));
        judge.known(label(s.settings),
                    mean_over_seeds(s, context, {technique == Technique::bdpt ? 4u : 16u, 24}),
                    expected, 1e-4);
    }
    return judge.result();
}

// How far a hit lies from the nearest edge of its triangle, in barycentric coordinates.
float edge_distance(const TriangleHit& h) { return std::min({h.b1, h.b2, 1 - h.b1 - h.b2}); }

// Mirrors that also glow: every bounce adds Le, unless a walk slips out at an edge, where the point
// that was hit may lie on the far side of the neighbouring wall by a rounding.
CaseResult mirror_box(const CaseContext& context) {
    Setup s{"mirror box",
            {},
            camera_at({0.2f, 0.1f, 0}, {1, 0.3f, 0.5f}, 1.2),
            settings(Technique::bdpt, 16, deep)};
    Material m = metal(0);
    m.emission = vec3(1);
    add_room(s.scene, m, vec3(1, 0.8f, 1.2f));
    const auto scene = build(s);
    constexpr int passes = 16;
    const Image image = render(s, scene, context, passes).image;
    const Estimator e = make_estimator(*scene, s.camera, s.settings);
    int lost = 0, far_from_edges = 0;
    float worst = 0;
    const ScopedFlushToZero flush;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const int before = lost;
            for (int pass = 0; pass < passes; ++pass) {
                Walk w = start_camera_walk(e, x, y, pass);
                float nearest_edge = 1;
                while (extend(e, w) == Reached::surface && w.index <= deep && scatter(w))
                    nearest_edge = std::min(nearest_edge, edge_distance(w.point->hit));
                if (w.index > deep) continue;
                ++lost;
                far_from_edges += nearest_edge > 1e-5f;
            }
            if (lost == before)
                worst = std::max(worst, std::abs(image.at(x, y).x / (deep + 1) - 1));
        }
    const double rays = double(deep) * passes * double(image.pixels.size());
    CaseResult r;
    r.measured = fmt::format("worst pixel off by {:.1e}; {} of {:.1g} rays slipped out at edges",
                             worst, lost, rays);
    r.bar = "<= 1e-5; <= 5 in 1e6, each at an edge";
    r.passed = worst <= 1e-5f && lost <= 5e-6 * rays && far_from_edges == 0;
    return r;
}

// A glass rod of twenty times its width: what enters at its end leaves at the other, by total
// internal reflection, or where it came in. In uniform light it cannot be seen. Where a walk meets
// two faces within the offset of a ray (1e-6 of the rod's length at its edges) the direction it
// came from is not that of the ray, and it may leave too early: hence the model's error.
CaseResult light_pipe(const CaseContext& context) {
    Judge judge(context, 2);
    for (const float angle : {0.5f, 1.2f}) {
        Setup s{fmt::format("rod entered at {:g} rad", angle),
                {},
                camera_at({std::sin(angle), 0, half_length + std::cos(angle)}, {0, 0, half_length},
                          0.2),
                settings(Technique::bdpt, 8, deep)};
        Material g = glass(0, 1.5f);
        g.has_thickness = true;
        Mesh rod;
        const vec3 size(1, 1, 2 * half_length), low = -0.5f * size, high = 0.5f * size, x(1, 0, 0),
                                                y(0, 1, 0), z(0, 0, 2 * half_length);
        for (const Mesh& m :
             {make_quad(low, y, x), make_quad(low, x, z), make_quad(low, z, y),
              make_quad(high, -x, -y), make_quad(high, -z, -x), make_quad(high, -y, -z)}) {
            const auto first = static_cast<unsigned>(rod.positions.size());
            rod.positions.insert(rod.positions.end(), m.positions.begin(), m.positions.end());
            for (const uvec3& t : m.triangles) rod.triangles.push_back(t + first);
        }
        add(s.scene, rod, g);
        s.scene.sky = constant_sky(vec3(1));
        judge.known(s.name, mean_over_seeds(s, context, {64, 24}), 1, 5e-4);
    }
    return judge.result();
}

}  // namespace

std::vector<ExtremeCase> depth_cases() {
    return {
        {"geometry", "corner",
         "a corner of a glowing box, seen from 1e-2 to 1e-5 of it, has the radiance of its walls",
         true, corner},
        {"geometry", "grazing",
         "a floor seen at up to 89.9999 degrees, or lit at up to 89.999, has its known radiance",
         true, grazing},
        {"geometry", "lamp_on_a_wall",
         "a floor lit by a lamp that stands on it follows the view factor down to its foot", true,
         lamp_on_a_wall},
        {"depth", "white_room",
         "500 bounces between walls of albedo 0.999 add up to the geometric series", false,
         white_room},
        {"depth", "mirror_box",
         "500 mirrors that glow add up to 501 in every pixel, and walks do not leave the box", true,
         mirror_box},
        {"depth", "light_pipe",
         "a glass rod twenty times as long as wide does not change uniform light", true,
         light_pipe}};
}

}  // namespace midway::extreme
