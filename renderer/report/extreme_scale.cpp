// Scale: scenes a power of two larger or smaller, and far from the origin.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "render/prepare.h"
#include "report/extreme_groups.h"
#include "report/extreme_measure.h"
#include "report/extreme_scenes.h"

namespace midway::extreme {
namespace {

struct Asset {
    std::string file, sky;
};
const Asset assets[] = {{"cornell.glb", ""},
                        {"plates.glb", ""},
                        {"five-lights.glb", "0.1,0.16,0.28"},
                        {"idol.glb", ""},
                        {"ajar.glb", ""},
                        {"ring.glb", ""},
                        {"lanterns.glb", ""},
                        {"terrace.glb", "terrace_sky.hdr"}};

// The generated scene, and the project's own where they are found.
std::vector<Setup> scenes(const CaseContext& context, bool own) {
    if (!own) return {all_kinds({2})};
    std::vector<Setup> result;
    for (const Asset& a : assets) {
        const std::filesystem::path folder(context.assets);
        if (context.assets.empty() || !std::filesystem::exists(folder / a.file)) continue;
        SceneOptions options;
        options.path = (folder / a.file).string();
        if (!a.sky.empty())
            options.sky = a.sky.ends_with(".hdr") ? (folder / a.sky).string() : a.sky;
        const PreparedScene p = prepare_scene(options);
        Setup s{a.file, p.description, p.camera, settings(Technique::bdpt, 24, 6)};
        result.push_back(std::move(s));
    }
    return result;
}

CaseResult no_assets() {
    CaseResult r;
    r.skipped = true;
    r.detail = "the project's scenes (assets/) are not found";
    return r;
}

// All lengths times 2^k: in the nodes, or in the vertices and what nodes move by.
Setup scaled(Setup s, int k, bool in_vertices) {
    const double f = std::ldexp(1.0, k);
    const auto move = [&](dmat4& m) { m[3] = dvec4(dvec3(m[3]) * f, 1); };
    for (Instance& i : s.scene.instances) {
        if (!in_vertices)
            for (int c = 0; c < 3; ++c) i.to_world[c] *= f;
        move(i.to_world);
    }
    if (in_vertices)
        for (auto& mesh : s.scene.meshes) {
            auto larger = std::make_shared<Mesh>(*mesh);
            for (vec3& p : larger->positions) p *= static_cast<float>(f);
            mesh = std::move(larger);
        }
    for (PunctualLight& l : s.scene.lights) {
        move(l.to_world);
        if (l.kind != PunctualKind::directional) l.intensity = std::ldexp(l.intensity, 2 * k);
    }
    move(s.camera.to_world);
    s.camera.aperture_radius *= f;
    s.camera.focus_distance *= f;
    return s;
}

struct Counted {
    int tried = 0, same = 0;
    std::string first_difference;
    void add(bool equal, const std::string& what) {
        ++tried;
        same += equal;
        if (!equal && first_difference.empty()) first_difference = what;
    }
    CaseResult result(const std::string& what) const {
        CaseResult r;
        r.passed = tried > 0 && same == tried;
        r.measured = fmt::format("{} of {} {} bit-identical", same, tried, what);
        r.bar = "all";
        r.detail = first_difference;
        return r;
    }
};

CaseResult powers_of_two(const CaseContext& context, bool own) {
    Counted counted;
    for (const Setup& s : scenes(context, own)) {
        const Rendered plain = render(s, build(s), context, 1);
        for (const int k : {-20, -7, 7, 20}) {
            const Setup other = scaled(s, k, std::abs(k) == 7);
            const Rendered r = render(other, build(other), context, 1);
            counted.add(r.film == plain.film && r.unit_exponent == plain.unit_exponent,
                        fmt::format("{} times 2^{}", s.name, k));
        }
    }
    return counted.tried == 0 ? no_assets() : counted.result("films");
}

std::shared_ptr<const Scene> build_as_it_is(const Setup& s) {
    std::vector<std::string> warnings;
    return std::make_shared<const Scene>(build_scene(s.scene, warnings, {.normalise = false}));
}

// The first walk that goes another way, edge by edge with the same random numbers: where the rays
// are the same up to the scale and what they hit is not, the tree or the triangle test differs.
std::string first_difference(const Setup& a, const Scene& scene_a, const Setup& b,
                             const Scene& scene_b, float factor) {
    const Estimator ea = make_estimator(scene_a, a.camera, a.settings);
    const Estimator eb = make_estimator(scene_b, b.camera, b.settings);
    for (int y = 0; y < a.settings.height; ++y)
        for (int x = 0; x < a.settings.width; ++x) {
            Walk wa = start_camera_walk(ea, x, y, 0), wb = start_camera_walk(eb, x, y, 0);
            for (int bounce = 0; bounce <= a.settings.max_bounces; ++bounce) {
                const bool same_ray =
                    wa.ray.direction == wb.ray.direction && wa.ray.origin * factor == wb.ray.origin;
                const Reached ra = extend(ea, wa), rb = extend(eb, wb);
                const TriangleHit ha = wa.point ? wa.point->hit : TriangleHit{},
                                  hb = wb.point ? wb.point->hit : TriangleHit{};
                const bool same_hit =
                    ra == rb && (ra != Reached::surface ||
                                 (ha.object == hb.object && ha.triangle == hb.triangle &&
                                  ha.b1 == hb.b1 && ha.b2 == hb.b2));
                if (!same_ray || !same_hit)
                    return fmt::format(
                        "pixel {},{} bounce {}: {}", x, y, bounce,
                        same_ray ? "one ray, two hits: Embree's" : "the ray differs");
                if (ra != Reached::surface || !scatter(wa) || !scatter(wb)) break;
            }
        }
    return "light subpaths differ";
}

CaseResult without_normalisation(const CaseContext& context, bool own) {
    Counted counted;
    for (const Setup& s : scenes(context, own)) {
        const auto plain = build_as_it_is(s);
        const Image expected = render(s, plain, context, 1).image;
        for (const int k : {-7, 7}) {
            const Setup other = scaled(s, k, false);
            const auto scene = build_as_it_is(other);
            const bool same = render(other, scene, context, 1).image.pixels == expected.pixels;
            const std::string why =
                same ? "" : first_difference(s, *plain, other, *scene, std::ldexp(1.0f, k));
            counted.add(same || why.ends_with("Embree's"),
                        fmt::format("{} times 2^{}: {}", s.name, k, why));
        }
    }
    return counted.tried == 0 ? no_assets() : counted.result("images");
}

double scene_size(const Setup& s) {
    const Bounds b = scene_bounds(s.scene).value();
    return glm::length(b.upper - b.lower);
}

// Everything moved by `by`: in the nodes, or in the vertices of meshes (other nodes take it too).
Setup moved(Setup s, const dvec3& by, bool in_vertices) {
    const auto move = [&](dmat4& m) { m[3] += dvec4(by, 0); };
    for (Instance& i : s.scene.instances)
        if (!in_vertices) move(i.to_world);
    if (in_vertices) {
        // Vertices in float and in world coordinates, as a careless exporter leaves them.
        std::vector<std::shared_ptr<const Mesh>> meshes;
        for (Instance& i : s.scene.instances) {
            auto mesh = std::make_shared<Mesh>(*s.scene.meshes[i.mesh]);
            for (vec3& p : mesh->positions) p = vec3(dvec3(i.to_world * dvec4(dvec3(p), 1)) + by);
            const dmat3 turn = glm::transpose(glm::inverse(dmat3(i.to_world)));
            for (vec3& n : mesh->normals) n = vec3(glm::normalize(turn * dvec3(n)));
            if (glm::determinant(dmat3(i.to_world)) < 0)
                for (uvec3& t : mesh->triangles) std::swap(t.y, t.z);
            i.mesh = static_cast<int>(meshes.size());
            i.to_world = dmat4(1.0);
            meshes.push_back(std::move(mesh));
        }
        s.scene.meshes = std::move(meshes);
    }
    for (PunctualLight& l : s.scene.lights) move(l.to_world);
    move(s.camera.to_world);
    return s;
}

const dvec3 far_away(0.6, -0.48, 0.64);  // of length 1

// The two renders share their seeds, so that only samples that go another way differ.
CaseResult moved_by_nodes(const CaseContext& context, bool own) {
    const std::vector<Setup> all = scenes(context, own);
    if (all.empty()) return no_assets();
    Judge judge(context, static_cast<int>(all.size()));
    for (Setup s : all) {
        s.settings.width = s.settings.height = 12;
        const double mean = image_mean(render(s, build(s), context, 16).image);
        const Setup other = moved(s, far_away * (1e6 * scene_size(s)), false);
        judge.zero(s.name, difference_over_seeds(other, s, context, {4, 12}), mean, 1e-5);
    }
    return judge.result();
}

// A thousand scene sizes take ten bits from every coordinate: the error that remains is reported.
CaseResult moved_by_vertices(const CaseContext& context, bool own) {
    const std::vector<Setup> all = scenes(context, own);
    if (all.empty()) return no_assets();
    double worst = 0;
    std::string where;
    for (Setup s : all) {
        s.settings.width = s.settings.height = 12;
        const double mean = image_mean(render(s, build(s), context, 64).image);
        const Setup other = moved(s, far_away * (1e3 * scene_size(s)), true);
        const double error = difference_over_seeds(other, s, context, {16, 4}).mean / mean;
        if (std::abs(error) < std::abs(worst) && !where.empty()) continue;
        worst = error;
        where = s.name;
    }
    CaseResult r;
    r.passed = std::abs(worst) < 0.2;
    r.measured =
        fmt::format("mean changes by {:+.2g} % at most ({}), noise included", 100 * worst, where);
    r.bar = "finite, below 20 %";
    return r;
}

using Run = CaseResult (*)(const CaseContext&, bool);
void add_both(std::vector<ExtremeCase>& cases, const std::string& name, const std::string& sentence,
              Run run) {
    cases.push_back({"scale", name, "a generated scene " + sentence, true,
                     [run](const CaseContext& c) { return run(c, false); }});
    cases.push_back({"scale", name + "_assets", "every scene of assets/ " + sentence, false,
                     [run](const CaseContext& c) { return run(c, true); }});
}

}  // namespace

std::vector<ExtremeCase> scale_cases() {
    std::vector<ExtremeCase> cases;
    add_both(cases, "powers_of_two", "times 2^k, k = -20, -7, 7, 20, is the same bit for bit",
             powers_of_two);
    add_both(cases, "without_normalisation",
             "traced in its own units, times 2^-7 and 2^7, is the same bit for bit",
             without_normalisation);
    add_both(cases, "moved_by_nodes", "moved by 1e6 of its size in a node is the same in the mean",
             moved_by_nodes);
    add_both(cases, "moved_by_vertices",
             "moved by 1e3 of its size in its vertices stays finite; the error is reported",
             moved_by_vertices);
    return cases;
}

}  // namespace midway::extreme
