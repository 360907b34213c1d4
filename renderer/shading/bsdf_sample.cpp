#include "shading/bsdf_lobes.h"

namespace midway {
namespace {

using namespace lobes;

// One random number serves several choices in turn: each takes its interval and stretches the rest.
bool choose(float probability, float& u) {
    const bool yes = u < probability;
    u = yes ? u / probability : (u - probability) / (1 - probability);
    u = std::clamp(u, 0.0f, 1 - 0x1p-24f);
    return yes;
}

// `from` in its own frame, with the direction that the lobe is entered by.
struct Entry {
    SideFrame side;
    vec3 from;
    vec3 lobe;      // ao for radiance, one of the light side's w for importance
    int folds = 1;  // equally likely `lobe`s
};

std::optional<Entry> enter_lobe(const Bsdf& b, const vec3& from, bool front, Transport transport,
                                float& u) {
    Entry e;
    e.side = side_frame(b, front);
    e.from = to_local(b, from, front);
    if (transport == Transport::radiance) {
        e.lobe = above(e.from);
        if (e.lobe.z == 0) return {};
        return e;
    }
    const LightSide light = light_side(e.side, e.from);
    if (light.count == 0) return {};
    e.folds = light.count;
    e.lobe = light.count == 2 && choose(0.5f, u) ? light.w[1] : light.w[0];
    return e;
}

// The direction that the lobe's outcome `w` (same frame as the entry) becomes after folding, with
// the number of equally likely ones; empty where there is none.
struct Exit {
    vec3 to{0};
    int folds = 1;
};
std::optional<Exit> leave_lobe(const Entry& e, const vec3& w, bool reflects, Transport transport,
                               float& u) {
    const float side = glm::dot(e.side.n, w);
    const bool right = reflects ? side > 0 : side < 0;
    if (transport == Transport::radiance) {
        if (side == 0) return {};
        return Exit{right ? w : mirror(e.side, w), 1};
    }
    const vec3 flipped(w.x, w.y, -w.z);
    const float flipped_side = glm::dot(e.side.n, flipped);
    const bool flipped_right = reflects ? flipped_side > 0 : flipped_side < 0;
    if (right && flipped_right) return Exit{choose(0.5f, u) ? flipped : w, 2};
    if (right) return Exit{w, 1};
    if (flipped_right) return Exit{flipped, 1};
    return {};
}

vec3 refract(const vec3& l, const vec3& h, float cos_h, float eta) {
    const float cos_t = safe_sqrt(1 - (1 - cos_h) * (1 + cos_h) / sqr(eta));
    return h * (cos_h / eta - cos_t) - l / eta;
}

// Probability of picking this lobe at the other end, folds included, for the reverse density.
float reverse_choice(const Bsdf& b, const Entry& e, const vec3& to, const vec3& w, bool glass,
                     bool reflects, Transport transport) {
    const auto part = [&](const LobeChoice& c) { return glass ? c.glass : c.specular; };
    if (transport == Transport::importance) return part(choose_lobes(b, std::abs(w.z)));
    // The light side sees `to` in its own frame, which is mirrored for transmission.
    SideFrame side = e.side;
    vec3 own = to;
    if (!reflects) {
        side.n = -vec3(side.n.x, side.n.y, -side.n.z);
        own.z = -own.z;
    }
    const LightSide light = light_side(side, own);
    if (light.count == 0) return 0;
    return part(choose_lobes(b, light_cosine(light))) /
           static_cast<float>(light.count * camera_folds(e.side, e.from));
}

// A delta lobe's outcome. The Dirac factors of the two densities are related by d(omega) |cos| n^2,
// which refraction preserves; that ratio is put into the two numbers, so that weights can treat
// them as ordinary densities.
// False where there is none.
bool sample_delta(const Bsdf& b, const vec3& from, const Entry& e, bool glass, float u,
                  Transport transport, BsdfSample& s) {
    const float eta = eta_beyond(b, e.side.front);
    const float r = glass ? glass_reflectance(b, e.lobe.z, eta) : 1.0f;
    const bool reflects = !glass || choose(r, u);
    vec3 w(-e.lobe.x, -e.lobe.y, e.lobe.z);
    if (!reflects) w = b.thin ? -e.lobe : refract(e.lobe, {0, 0, 1}, e.lobe.z, eta);
    const std::optional<Exit> exit = leave_lobe(e, w, reflects, transport, u);
    if (!exit || w.z == 0) return false;

    const float part = glass ? (reflects ? r : 1 - r) : 1.0f;
    const vec3 reflectance = glass ? b.glass * (reflects ? vec3(1) : b.glass_tint) * part
                                   : specular_fresnel(b, e.lobe.z);
    const LobeChoice c = choose_lobes(b, std::min(1.0f, e.lobe.z));
    // At i lobes are chosen by the first of the light side's directions.
    const LobeChoice chosen = transport == Transport::radiance
                                  ? c
                                  : choose_lobes(b, light_cosine(light_side(e.side, e.from)));
    const float probability =
        (glass ? chosen.glass : chosen.specular) * part / static_cast<float>(e.folds * exit->folds);
    const float reverse = reverse_choice(b, e, exit->to, w, glass, reflects, transport) * part;
    if (!(probability > 0)) return false;
    const float n = reflects || b.thin ? 1.0f : eta;
    const float mu_from = e.lobe.z, mu_to = std::abs(w.z);
    s.delta = true;
    s.to = to_world(b, exit->to, e.side.front);
    s.weight = reflectance / probability;
    if (transport == Transport::radiance) {
        s.eta_scale = 1 / sqr(n);
        s.weight *= s.eta_scale;
    } else {
        s.weight *= mu_from * abs_dot(s.to, b.ng) / (mu_to * abs_dot(from, b.ng));
    }
    s.pdf_fwd_w = probability * mu_to * n;
    s.pdf_rev_w = reverse * mu_from / n;
    return true;
}

// The lobe's outcome for a rough lobe; empty where the facet turns it to the wrong side of ns.
struct FacetOutcome {
    vec3 w{0};
    bool reflects = true;
};
std::optional<FacetOutcome> sample_facet(const Bsdf& b, const Entry& e, bool glass, const vec2& u,
                                         float& v) {
    const vec3 h = sample_ggx_visible(e.lobe, b.alpha, u);
    const float cos_h = glm::dot(e.lobe, h);
    if (cos_h <= 0) return {};
    const vec3 mirrored = 2 * cos_h * h - e.lobe;
    const float eta = eta_beyond(b, e.side.front);
    if (!glass || choose(glass_reflectance(b, cos_h, eta), v)) {
        if (mirrored.z <= 0) return {};
        return FacetOutcome{mirrored, true};
    }
    if (b.thin) {
        if (mirrored.z <= 0) return {};
        return FacetOutcome{{mirrored.x, mirrored.y, -mirrored.z}, false};
    }
    const vec3 t = refract(e.lobe, h, cos_h, eta);
    if (t.z >= 0) return {};
    return FacetOutcome{glm::normalize(t), false};
}

// About ns on the side of ng that `gf` = from . ng tells.
vec3 draw_diffuse(const Bsdf& b, const vec3& u, float gf) {
    const vec3 to = to_world(b, square_to_cosine_hemisphere(vec2(u)), gf > 0);
    // The part of the hemisphere about ns that lies below ng is folded back through the point.
    return glm::dot(to, b.ng) * gf < 0 ? -to : to;
}

// Weight and densities of a direction drawn from a lobe that is not a delta.
bool weigh(const Bsdf& b, const vec3& from, Transport transport, BsdfSample& s) {
    const BsdfEval e = eval_bsdf(b, from, s.to, transport);
    if (!(e.pdf_fwd_w > 0) || is_black(e.f)) return false;
    s.weight = e.f * (abs_dot(s.to, b.ng) / e.pdf_fwd_w);
    s.pdf_fwd_w = e.pdf_fwd_w;
    s.pdf_rev_w = e.pdf_rev_w;
    return true;
}

// sample_bsdf() for any lobes; false where it draws nothing. Not inline: the short way of a diffuse
// surface would have to save as many registers.
[[gnu::noinline]] bool draw_lobes(const Bsdf& b, const vec3& from, const vec3& u,
                                  Transport transport, float gf, BsdfSample& s) {
    const bool front = gf > 0;
    const vec3 l = to_local(b, from, front);
    const float z = transport == Transport::radiance
                        ? std::abs(l.z)
                        : light_cosine(light_side(side_frame(b, front), l));
    const LobeChoice choice = choose_lobes(b, z);
    if (!(choice.diffuse + choice.specular + choice.glass > 0)) return false;
    float v = u.z;
    bool crosses = false;
    if (choose(choice.diffuse, v)) {
        s.to = draw_diffuse(b, u, gf);
    } else {
        const float lobes_left = choice.specular + choice.glass;
        if (!(lobes_left > 0)) return false;
        const bool glass = !choose(choice.specular / lobes_left, v);
        const std::optional<Entry> e = enter_lobe(b, from, front, transport, v);
        if (!e) return false;
        if (b.smooth()) return sample_delta(b, from, *e, glass, v, transport, s);
        const std::optional<FacetOutcome> facet = sample_facet(b, *e, glass, vec2(u), v);
        if (!facet) return false;
        const std::optional<Exit> exit = leave_lobe(*e, facet->w, facet->reflects, transport, v);
        if (!exit) return false;
        s.to = to_world(b, exit->to, front);
        crosses = !facet->reflects;
    }
    if (!weigh(b, from, transport, s)) return false;
    if (crosses && !b.thin && transport == Transport::radiance)
        s.eta_scale = 1 / sqr(eta_beyond(b, front));
    return true;
}

}  // namespace

std::optional<BsdfSample> sample_bsdf(const Bsdf& b, const vec3& from, const vec3& u,
                                      Transport transport) {
    std::optional<BsdfSample> s(std::in_place);
    const float gf = glm::dot(from, b.ng);
    bool drawn = false;
    if (gf != 0 && b.only_diffuse) {
        s->to = draw_diffuse(b, u, gf);
        drawn = b.has_diffuse() && weigh(b, from, transport, *s);
    } else if (gf != 0) {
        drawn = draw_lobes(b, from, u, transport, gf, *s);
    }
    if (!drawn) s.reset();
    return s;
}

}  // namespace midway
