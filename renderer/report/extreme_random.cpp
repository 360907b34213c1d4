// Random numbers forced to the ends of their range, 0 and 1 - 2^-24, and to their neighbours and
// the middle, in every dimension of every sampling function: results are finite, densities above
// zero.
#include <fmt/format.h>

#include <cmath>

#include "image/pixel_filter.h"
#include "math/float_mode.h"
#include "math/warp.h"
#include "report/extreme_groups.h"
#include "report/extreme_measure.h"
#include "report/extreme_scenes.h"
#include "shading/microfacet.h"
#include "shading/texture.h"

namespace midway::extreme {
namespace {

constexpr float ends[] = {0,    0x1p-24f,         2 * 0x1p-24f, 0.5f - 0x1p-25f,
                          0.5f, 1 - 2 * 0x1p-24f, 1 - 0x1p-24f};

// Draws counted; the first that is not as it must be is kept.
struct Draws {
    std::int64_t count = 0, bad = 0;
    std::string first;

    void expect(bool good, const std::string& sampler, std::initializer_list<float> u) {
        ++count;
        if (good) return;
        if (bad++ > 0) return;
        first = sampler + " of";
        for (const float x : u) first += fmt::format(" {:.9g}", x);
    }
    CaseResult result() const {
        CaseResult r;
        r.passed = bad == 0 && count > 0;
        r.measured = fmt::format("{} of {} draws not finite or of density 0", bad, count);
        r.bar = "0";
        r.detail = first;
        return r;
    }
};

template <class Use>
void for_pairs(const Use& use) {
    for (const float x : ends)
        for (const float y : ends) use(vec2(x, y));
}

bool good(float pdf) { return std::isfinite(pdf) && pdf > 0; }
bool unit(const vec3& v) { return is_finite(v) && std::abs(glm::length(v) - 1) < 1e-4f; }
bool good(const LightPdfs& p) { return good(p.origin) && good(p.leave) && good(p.next_event); }
bool not_negative(const vec3& v) { return is_finite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0; }

CaseResult warps(const CaseContext&) {
    const ScopedFlushToZero flush;
    Draws d;
    for_pairs([&](const vec2& u) {
        const auto expect = [&](bool yes, const char* what) { d.expect(yes, what, {u.x, u.y}); };
        expect(glm::length(square_to_disc(u)) <= 1 + 1e-6f, "disc");
        const vec3 c = square_to_cosine_hemisphere(u);
        expect(unit(c) && good(cosine_hemisphere_pdf_w(c.z)), "cosine hemisphere");
        expect(unit(square_to_sphere(u)), "sphere");
        const vec2 b = square_to_triangle(u);
        expect(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1, "triangle");
        for (const FilterKind kind :
             {FilterKind::box, FilterKind::gaussian, FilterKind::blackman_harris}) {
            const PixelFilter f = make_filter(kind);
            const vec2 at = sample_filter(f, u);
            expect(std::abs(at.x) <= f.radius && std::abs(at.y) <= f.radius, "pixel filter");
            for (const float place : {0.0f, 0.5f, 1 - 0x1p-24f, 7.0f}) {
                const SplatPixel s = choose_splat_pixel(f, {place, place}, u);
                expect(std::isfinite(s.factor) && s.factor >= 0, "splat's pixel");
            }
        }
        for (const float alpha : {smooth_alpha, 0.01f, 0.3f, 1.0f})
            for (const float z : {1e-6f, 1e-3f, 0.5f, 1.0f}) {
                const vec3 w(std::sqrt(1 - z * z), 0, z), h = sample_ggx_visible(w, alpha, u);
                expect(unit(h) && h.z > 0, "visible normals");
            }
    });
    return d.result();
}

CaseResult tables(const CaseContext&) {
    Draws d;
    const std::vector<std::vector<double>> weights = {
        {1},         {1, 0},           {0, 1},        {0, 0, 1, 0, 0},      {1e-300, 1},
        {1, 1e-300}, {1e300, 1, 1e-9}, {0, 1e-30, 0}, {1, 1, 1, 1, 1, 1, 1}};
    for (const auto& w : weights) {
        const Distribution1D table = make_distribution(w);
        const Distribution2D grid = make_distribution_2d(w, static_cast<int>(w.size()), 1);
        for (const float x : ends) {
            const DiscreteSample s = sample_discrete(table, x);
            d.expect(s.probability > 0 && w[s.index] > 0 && s.remapped >= 0 && s.remapped < 1,
                     "table", {x});
            for (const float y : ends) {
                const CellSample c = sample_cell(grid, {x, y});
                d.expect(c.probability > 0 && w[c.x] > 0 && c.inside.x < 1 && c.inside.y < 1,
                         "grid", {x, y});
            }
        }
    }
    // Bits to numbers, at both ends of the words.
    for (const std::uint32_t bits : {0u, 1u, 255u, 256u, 0x7fffffffu, 0xffffff00u, 0xffffffffu})
        d.expect(to_unit_float(bits) >= 0 && to_unit_float(bits) <= 1 - 0x1p-24f, "bits",
                 {float(bits)});
    return d.result();
}

Setup lit_by_all() {
    Setup s = all_kinds({2});
    s.scene.sky->rotation_degrees = 33;
    // A spot without a ramp, one as narrow as can be, and a lamp that shines from both sides.
    s.scene.lights.push_back(spot_light({0, 2, 0}, {0, 0, 0}, 1, 0.5f, 0.500001f));
    s.scene.lights.push_back(spot_light({0, 2, 0}, {0, 0, 0}, 1, 0, 1e-3f));
    Material both = lamp(vec3(1));
    both.double_sided = true;
    add(s.scene, make_quad({1, 1, 0}, {0.2f, 0, 0}, {0, 0.2f, 0}), both);
    return s;
}

CaseResult emission(const CaseContext&) {
    const ScopedFlushToZero flush;
    Draws d;
    for (const bool constant : {false, true}) {
        Setup setup = lit_by_all();
        if (constant) setup.scene.sky = constant_sky(vec3(0.3f));
        const auto scene = build(setup);
        // Every light in turn: the ends of its interval.
        std::vector<float> picks(std::begin(ends), std::end(ends));
        for (const double c : scene->emission_pick.cdf) {
            const float u = std::min(float(c), 1 - 0x1p-24f);
            for (const float x : {u, std::nextafter(u, 0.0f), std::nextafter(u, 1.0f)})
                if (x >= 0 && x < 1) picks.push_back(x);
        }
        for (const float pick : picks)
            for_pairs([&](const vec2& point) {
                for_pairs([&](const vec2& direction) {
                    const auto e = sample_emission(*scene, {pick, point, direction});
                    d.expect(
                        !e || (good(e->pdfs.origin) && good(e->pdfs.leave) &&
                               not_negative(e->weight) && unit(e->direction) && e->cos_theta > 0),
                        "emission", {pick, point.x, point.y, direction.x, direction.y});
                });
            });
    }
    return d.result();
}

CaseResult next_event(const CaseContext&) {
    const ScopedFlushToZero flush;
    Draws d;
    const auto scene = build(lit_by_all());
    std::vector<float> picks(std::begin(ends), std::end(ends));
    for (int i = 0; i < 64; ++i) picks.push_back(float(i) / 64);
    for (const double c : scene->next_event_group.cdf) {
        const float u = std::min(float(c), 1 - 0x1p-24f);
        for (const float x : {u, std::nextafter(u, 0.0f), std::nextafter(u, 1.0f)})
            if (x >= 0 && x < 1) picks.push_back(x);
    }
    std::vector<vec3> references{vec3(0), vec3(0.1f, -0.2f, 0.05f)};
    // Also on the lights themselves.
    for (const Light& l : scene->lights)
        if (!is_infinite(l.kind)) references.push_back(l.position);
    for (const vec3& reference : references)
        for (const float pick : picks)
            for_pairs([&](const vec2& u) {
                const auto n = sample_next_event(*scene, reference, {pick, u});
                // A spot's own density is zero outside of its cone, where it sends nothing.
                d.expect(!n || (good(n->pdfs) && not_negative(n->value) && unit(n->direction)),
                         "next event", {pick, u.x, u.y});
            });
    for (const Light& l : scene->lights)
        if (l.kind == LightKind::sky)
            for_pairs([&](const vec2& u) {
                const SkySample s = sample_sky(*scene->sky, u);
                d.expect(
                    unit(s.direction) && good(s.pdf_w) && good(sky_pdf_w(*scene->sky, s.direction)),
                    "sky", {u.x, u.y});
            });
    for_pairs([&](const vec2& u) {
        Camera c;
        c.lens_radius = 0.1f;
        const vec3 lens = lens_point(c, u), w = camera_direction(c, lens, u);
        d.expect(is_finite(lens) && unit(w) && good(camera_pdf_w(c, glm::dot(w, c.forward))),
                 "lens", {u.x, u.y});
    });
    return d.result();
}

std::vector<Material> materials() {
    std::vector<Material> all{lambert(vec3(0.5f)), lambert(vec3(1))};
    for (const float r : {0.0f, 0.0318f, 0.1f, 0.5f, 1.0f}) {
        all.insert(all.end(), {metal(r), plastic(r, {0.9f, 0.2f, 0})});
        for (const float ior : {1.0f, 1.002f, 1.5f, 3.0f, 1 / 1.5f})
            for (const bool thin : {false, true}) {
                Material m = glass(r, ior);
                m.has_thickness = !thin;
                all.push_back(m);
            }
        Material mixed = glass(r);
        mixed.transmission = 0.5f;
        mixed.metallic = 0.3f;
        all.push_back(mixed);
    }
    return all;
}

CaseResult scattering(const CaseContext&) {
    const ScopedFlushToZero flush;
    Draws d;
    for (const Material& m : materials())
        for (const vec3& normal : {vec3(0, 0, 1), glm::normalize(vec3(0.4f, -0.2f, 1))}) {
            ShadingPoint p;
            p.ng = {0, 0, 1};
            p.normal = normal;
            p.thin = m.transmission > 0 && !m.has_thickness;
            const Bsdf b = make_bsdf(m, {}, p);
            for (const float z : {1.0f, 0.3f, 1e-2f, 1e-4f, 1e-7f, -1e-7f, -1e-3f, -0.5f, -1.0f}) {
                const vec3 from(std::sqrt(1 - z * z), 0, z);
                for (const Transport t : {Transport::radiance, Transport::importance})
                    for (const float w : ends)
                        for_pairs([&](const vec2& u) {
                            const auto s = sample_bsdf(b, from, {u.x, u.y, w}, t);
                            d.expect(
                                !s || (good(s->pdf_fwd_w) && std::isfinite(s->pdf_rev_w) &&
                                       s->pdf_rev_w >= 0 && not_negative(s->weight) && unit(s->to)),
                                fmt::format("scattering (metallic {:g}, roughness {:g}, "
                                            "transmission {:g}, index {:g}, z {:g})",
                                            m.metallic, m.roughness, m.transmission, m.ior, z),
                                {u.x, u.y, w});
                        });
            }
        }
    return d.result();
}

}  // namespace

std::vector<ExtremeCase> random_cases() {
    const std::string all = "random numbers 0, 1 - 2^-24 and their neighbours in every dimension: ";
    return {{"random numbers", "warps", all + "discs, spheres, triangles, filters, facets", true,
             warps},
            {"random numbers", "tables", all + "discrete choices with zero and tiny weights", true,
             tables},
            {"random numbers", "emission", all + "light subpaths of every kind of light", true,
             emission},
            {"random numbers", "next_event", all + "points on lights, sky directions, the lens",
             true, next_event},
            {"random numbers", "scattering",
             all + "every lobe, smooth and rough, from normal to grazing, from both ends", true,
             scattering}};
}

}  // namespace midway::extreme
