#include "render/coverage.h"

#include <algorithm>
#include <set>

#include "shading/microfacet.h"
#include "shading/texture.h"

namespace midway {
namespace {

// Surfaces of a path from the camera on: 'R' can be connected, 'S' scattered by a delta lobe.
using Pattern = std::string;

bool is_rough(const Pattern& p, int vertex) { return p[vertex - 1] == 'R'; }

// Vertices: camera 0, surfaces 1..n, light n + 1.
bool feasible(const Pattern& p, bool hittable, const Strategy& k, const Families& families,
              bool direct_lamps) {
    const int n = static_cast<int>(p.size());
    if (n == 0) return k.t == 0 && hittable && (families.emitter_hit || direct_lamps);
    if (!families.has(family_of(k))) return false;
    if (k.t == 0) return hittable;
    if (k.t == 1) return is_rough(p, n);
    if (k.s == 1) return is_rough(p, 1);
    return is_rough(p, k.s - 1) && is_rough(p, k.s);
}

bool covered(const Pattern& p, bool hittable, const Families& f, bool direct_lamps) {
    const int vertices = static_cast<int>(p.size()) + 2;
    for (int s = 1; s <= vertices; ++s) {
        const Strategy k{s, vertices - s};
        if (k == Strategy{1, 1}) continue;
        if (feasible(p, hittable, k, f, direct_lamps)) return true;
    }
    return false;
}

// Can light travel this way at all? A delta light seen in mirrors alone has no measurable path.
bool measurable(const Pattern& p, bool hittable) {
    return hittable || p.find('R') != Pattern::npos;
}

std::string in_words(const Pattern& p, bool hittable, const SceneFeatures& f) {
    std::string text = hittable ? "lamp or sky" : f.delta_light_names + " light";
    for (auto it = p.rbegin(); it != p.rend(); ++it)
        text += *it == 'R' ? " > rough surface" : " > smooth surface";
    return text + " > camera";
}

std::string_view kind_word(LightKind k) {
    return k == LightKind::point ? "point" : k == LightKind::spot ? "spot" : "directional";
}

}  // namespace

SceneFeatures scene_features(const Scene& s) {
    SceneFeatures f;
    f.transparent = s.has_transparency;
    f.lit = s.emission_pick.total > 0;
    for (const Object& o : s.geometry->objects) {
        const Material& m = s.materials[o.material];
        // Textures can only lower metalness and transmission below their factors.
        const bool mirrors = m.specular > 0 || m.metallic > 0 || m.transmission > 0;
        const bool black = max_component(m.base_color) == 0;
        const bool diffuse = !black && (m.metallic < 1 || m.metallic_roughness_texture.used()) &&
                             (m.transmission < 1 || m.transmission_texture.used());
        f.smooth |= mirrors && may_be_smooth(m);
        f.rough |= diffuse || (mirrors && (sqr(m.roughness) >= smooth_alpha));
    }
    std::set<std::string_view> kinds;
    for (size_t i = 0; i < s.lights.size(); ++i) {
        const Light& l = s.lights[i];
        if (!(l.power > 0) || (is_delta(l.kind) && !l.reaches)) continue;
        // One triangle of a lamp that shines speaks for all that follow; there may be a million.
        if (l.kind == LightKind::area)
            i = static_cast<size_t>(s.first_light[l.object]) +
                s.geometry->objects[l.object].triangles.size() - 1;
        if (is_delta(l.kind)) kinds.insert(kind_word(l.kind));
        (is_delta(l.kind) ? f.delta_lights : f.hittable_lights) = true;
    }
    for (const std::string_view k : kinds)
        f.delta_light_names += (f.delta_light_names.empty() ? "" : ", ") + std::string(k);
    return f;
}

std::vector<FamilyNeed> family_needs(const SceneFeatures& f) {
    std::vector<FamilyNeed> needs;
    needs.push_back({"emitter", f.hittable_lights,
                     f.hittable_lights ? "there are lamps or a sky that a ray can hit"
                                       : "no light here can be hit by a ray"});
    const bool connects = f.rough && f.lit;
    const std::string why_not = f.lit
                                    ? "no surface here can be connected to: all are smooth or black"
                                    : "no light reaches a surface";
    needs.push_back(
        {"next-event", connects, connects ? "rough surfaces can be connected to lights" : why_not});
    needs.push_back(
        {"light", connects, connects ? "rough surfaces can be connected to the camera" : why_not});
    needs.push_back({"connect", connects,
                     connects ? "rough surfaces can be connected to each other" : why_not});
    return needs;
}

std::vector<PathKind> kinds_not_covered(const SceneFeatures& f, const Families& families,
                                        bool direct_lamps) {
    std::vector<PathKind> kinds;
    constexpr int longest = 4;
    for (const bool hittable : {true, false}) {
        if (!(hittable ? f.hittable_lights : f.delta_lights)) continue;
        for (int n = 0; n <= (f.lit ? longest : 0); ++n)
            for (int bits = 0; bits < (1 << n); ++bits) {
                Pattern p;
                for (int i = 0; i < n; ++i) p += (bits >> i) & 1 ? 'S' : 'R';
                const bool exists = (f.rough || p.find('R') == Pattern::npos) &&
                                    (f.smooth || p.find('S') == Pattern::npos);
                if (exists && measurable(p, hittable) &&
                    !covered(p, hittable, families, direct_lamps))
                    kinds.push_back({p, hittable});
            }
    }
    return kinds;
}

std::vector<std::string> not_covered(const SceneFeatures& f, const Families& families,
                                     bool direct_lamps) {
    std::vector<PathKind> shortest;
    std::vector<std::string> result;
    for (const PathKind& k : kinds_not_covered(f, families, direct_lamps)) {
        // A shorter kind tells of the longer ones that contain it. A lamp seen directly is its own
        // story: nothing longer is missed for its reason.
        const auto tells = [&](const PathKind& q) {
            return q.hittable == k.hittable && !q.surfaces.empty() &&
                   k.surfaces.find(q.surfaces) != Pattern::npos;
        };
        if (std::ranges::any_of(shortest, tells)) continue;
        shortest.push_back(k);
        result.push_back(in_words(k.surfaces, k.hittable, f));
    }
    return result;
}

std::string why_left_out(const Strategy& k, const SceneFeatures& f, const Estimator& e,
                         const RenderSettings& settings) {
    const Family family = family_of(k);
    if (k == Strategy{1, 1})
        return "what the camera sees directly is found by hitting the lamp (camera 2, light 0)";
    if (k.edges() > e.max_bounces + 1)
        return "paths end after " + std::to_string(e.max_bounces) +
               (e.max_bounces == 1 ? " bounce" : " bounces");
    const bool lamp_seen = k == Strategy{2, 0} && e.direct_lamps;
    if (!families_of(settings.technique).has(family) && !lamp_seen)
        return settings.technique == Technique::path ? "path tracing has no walks from the lights"
                                                     : "light tracing has no walks from the camera";
    if (settings.families && !settings.families->has(family) && !lamp_seen)
        return "this family was taken out by you";
    if (!settings.only.empty() && std::ranges::find(settings.only, k) == settings.only.end())
        return "only other strategies were asked for";
    if (!f.hittable_lights && !f.delta_lights) return "there is no light";
    if (family == Family::emitter_hit)
        return f.hittable_lights ? ""
                                 : "only lamps without size (" + f.delta_light_names +
                                       "): nothing that a ray could hit";
    if (!f.lit) return "no light reaches a surface";
    if (!f.rough) return "all surfaces are mirrors, clear glass or black: nothing to connect";
    const bool planned = settings.technique == Technique::automatic && settings.plan;
    if (family == Family::light_tracing && e.has(k) && !e.splats(k.edges()))
        return "there is one lamp, and next event finds its direct light with less noise";
    return planned && !settings.plan->families.has(family)
               ? "auto found that this image needs less time without it"
               : "";
}

}  // namespace midway
