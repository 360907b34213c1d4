#include "shading/bsdf.h"

#include "shading/albedo_table.h"
#include "shading/microfacet.h"

namespace midway {
namespace {

// Below this distance from 1 a refraction bends rays by less than the width of a smooth lobe.
constexpr float matched_index = 1e-3f;

// `from` and `to` in the shading frame, mirrored so that `from` lies above by ng. Where z of a
// direction disagrees with its side by ng, only the diffuse lobe sees it.
struct LocalPair {
    vec3 from, to;
    float eta;  // index beyond the surface over that at `from`
    bool reflects;
    bool from_matches, to_matches;
};

struct LobeChoice {
    float diffuse = 0, specular = 0, glass = 0;
};

vec3 to_local(const Bsdf& b, const vec3& w, bool front) {
    vec3 l = b.frame.to_local(w);
    if (!front) l.z = -l.z;
    return l;
}

vec3 to_world(const Bsdf& b, vec3 l, bool front) {
    if (!front) l.z = -l.z;
    return b.frame.to_world(l);
}

// A thin sheet has the same medium on both sides: rays enter it from either.
float eta_from(const Bsdf& b, bool front) { return front || b.thin ? b.eta : 1 / b.eta; }

// What the coat leaves over for the diffuse lobe in direction cosine mu.
float below_coat(const Bsdf& b, float mu) {
    if (b.coat_f90 == 0 && b.coat_f0 == 0) return 1;
    const SchlickAlbedo e = directional_albedo(mu, b.alpha);
    return std::max(0.0f, 1 - b.coat_f0 * e.a - b.coat_f90 * e.b);
}

float coat_normalisation(const Bsdf& b) {
    if (b.coat_f90 == 0 && b.coat_f0 == 0) return 1;
    const SchlickAlbedo e = average_albedo(b.alpha);
    return 1 / std::max(1e-4f, 1 - b.coat_f0 * e.a - b.coat_f90 * e.b);
}

// Probabilities with which sampling picks a lobe when it comes in at cosine z above the surface
// (z <= 0: the shading normal disagrees, only diffuse light is left).
LobeChoice choose_lobes(const Bsdf& b, float z) {
    LobeChoice c;
    const float mu = std::min(1.0f, std::abs(z));
    if (b.has_diffuse()) c.diffuse = max_component(b.diffuse) * below_coat(b, mu);
    if (z > 0) {
        if (b.has_specular()) {
            const SchlickAlbedo e = directional_albedo(mu, b.alpha);
            c.specular = max_component(b.f0 * e.a + b.f90 * e.b);
        }
        if (b.has_glass()) c.glass = max_component(b.glass);
        // Where the coat takes nearly all, the layer below still needs a chance: f > 0 there.
        if (b.has_diffuse()) c.diffuse = std::max(c.diffuse, 0.02f * (c.specular + c.glass));
    }
    const float sum = c.diffuse + c.specular + c.glass;
    if (sum > 0) {
        c.diffuse /= sum;
        c.specular /= sum;
        c.glass /= sum;
    }
    return c;
}

// Reflectance of a thin sheet with all orders of internal reflection, or of one interface.
float glass_reflectance(const Bsdf& b, float cos_h, float eta) {
    const float r = fresnel_dielectric(std::min(cos_h, 1.0f), eta);
    return b.thin ? 2 * r / (1 + r) : r;
}

void add_diffuse(const Bsdf& b, const LocalPair& p, const LobeChoice& from, const LobeChoice& to,
                 BsdfEval& e) {
    const float mu_f = std::abs(p.from.z), mu_t = std::abs(p.to.z);
    e.f += b.diffuse * (inv_pi * below_coat(b, mu_f) * below_coat(b, mu_t) * coat_normalisation(b));
    e.pdf_fwd_w += from.diffuse * cosine_hemisphere_pdf_w(mu_t);
    e.pdf_rev_w += to.diffuse * cosine_hemisphere_pdf_w(mu_f);
}

// Mirror-like microfacet lobes of the pair (w, v), both above the surface; `share` scales the
// value, the two probabilities the densities.
void add_facet_reflection(const Bsdf& b, const vec3& w, const vec3& v, const vec3& h,
                          const vec3& share, float probability_w, float probability_v,
                          BsdfEval& e) {
    const float d = ggx_d(h, b.alpha);
    e.f += share * (d * ggx_g2(w, v, b.alpha) / (4 * w.z * v.z));
    e.pdf_fwd_w += probability_w * ggx_g1(w, b.alpha) * d / (4 * w.z);
    e.pdf_rev_w += probability_v * ggx_g1(v, b.alpha) * d / (4 * v.z);
}

void add_refraction(const Bsdf& b, const LocalPair& p, float choice_from, float choice_to,
                    Transport transport, BsdfEval& e) {
    vec3 h = p.from + p.eta * p.to;
    const float len2 = length_squared(h);
    if (len2 == 0) return;
    h *= (h.z < 0 ? -1 : 1) / std::sqrt(len2);
    const float cf = glm::dot(p.from, h), ct = glm::dot(p.to, h);
    if (cf <= 0 || ct >= 0) return;
    const float transmitted = 1 - glass_reflectance(b, cf, p.eta);
    if (transmitted <= 0) return;
    const float d = ggx_d(h, b.alpha);
    const float inv_denominator = 1 / sqr(cf + p.eta * ct);
    const vec3 below(p.to.x, p.to.y, -p.to.z);
    // Walter et al. 2007, eq. 21, has the index of the medium that radiance ends in: the camera's.
    const float scale = transport == Transport::radiance ? 1.0f : sqr(p.eta);
    e.f += b.glass * b.glass_tint *
           (transmitted * d * ggx_g2(p.from, below, b.alpha) * cf * -ct * scale * inv_denominator /
            (p.from.z * below.z));
    e.pdf_fwd_w += choice_from * transmitted * ggx_g1(p.from, b.alpha) * d * cf / p.from.z * -ct *
                   sqr(p.eta) * inv_denominator;
    e.pdf_rev_w +=
        choice_to * transmitted * ggx_g1(below, b.alpha) * d * -ct / below.z * cf * inv_denominator;
}

// Sums the lobes that are not deltas, with f_s and not yet the shading-normal factor.
BsdfEval eval_lobes(const Bsdf& b, const LocalPair& p, Transport transport) {
    BsdfEval e;
    const LobeChoice from = choose_lobes(b, p.from.z);
    const LobeChoice to = choose_lobes(b, p.reflects ? p.to.z : -p.to.z);
    if (p.reflects && b.has_diffuse()) add_diffuse(b, p, from, to, e);
    if (!p.from_matches || !p.to_matches || b.smooth()) return e;
    if (p.reflects) {
        const vec3 h = glm::normalize(p.from + p.to);
        const float cos_h = std::max(0.0f, glm::dot(p.from, h));
        if (b.has_specular()) {
            const vec3 fresnel = b.f0 + (b.f90 - b.f0) * schlick_weight(cos_h);
            add_facet_reflection(b, p.from, p.to, h, fresnel, from.specular, to.specular, e);
        }
        if (b.has_glass()) {
            const float r = glass_reflectance(b, cos_h, p.eta);
            add_facet_reflection(b, p.from, p.to, h, b.glass * r, from.glass * r, to.glass * r, e);
        }
    } else if (b.has_glass() && b.thin) {
        const vec3 above(p.to.x, p.to.y, -p.to.z);
        const vec3 h = glm::normalize(p.from + above);
        const float t = 1 - glass_reflectance(b, std::max(0.0f, glm::dot(p.from, h)), p.eta);
        add_facet_reflection(b, p.from, above, h, b.glass * b.glass_tint * t, from.glass * t,
                             to.glass * t, e);
    } else if (b.has_glass()) {
        add_refraction(b, p, from.glass, to.glass, transport, e);
    }
    return e;
}

// |i . ns| / |i . ng| for the direction towards the light.
float shading_normal_factor(const Bsdf& b, const vec3& light) {
    return abs_dot(light, b.frame.n) / abs_dot(light, b.ng);
}

// Finishes a sample of a delta lobe that `to` was chosen from with `probability`, and that would be
// chosen from the other side with `reverse`. eta is n_to / n_from. The Dirac factors of the two
// densities are related by d(omega) |cos| n^2, which is invariant under refraction; that ratio is
// put into the two numbers, so that weights can treat them as ordinary densities.
std::optional<BsdfSample> finish_delta(const Bsdf& b, const vec3& from, const vec3& to,
                                       const vec3& reflectance, float probability, float reverse,
                                       float eta, Transport transport) {
    if (!(probability > 0)) return {};
    BsdfSample s;
    s.delta = true;
    s.to = to;
    s.weight = reflectance / probability;
    const float mu_f = abs_dot(from, b.frame.n), mu_t = abs_dot(to, b.frame.n);
    if (transport == Transport::radiance) {
        s.weight /= sqr(eta);
        s.eta_scale = 1 / sqr(eta);
    } else {
        s.weight *= mu_f * abs_dot(to, b.ng) / (mu_t * abs_dot(from, b.ng));
    }
    s.pdf_fwd_w = probability * mu_t * eta;
    s.pdf_rev_w = reverse * mu_f / eta;
    return s;
}

std::optional<BsdfSample> sample_mirror(const Bsdf& b, const vec3& from, const vec3& l, bool front,
                                        Transport transport) {
    const vec3 to = to_world(b, {-l.x, -l.y, l.z}, front);
    if ((glm::dot(to, b.ng) > 0) != front) return {};
    const vec3 fresnel = b.f0 + (b.f90 - b.f0) * schlick_weight(l.z);
    const float p = choose_lobes(b, l.z).specular;
    return finish_delta(b, from, to, fresnel, p, p, 1, transport);
}

std::optional<BsdfSample> sample_smooth_glass(const Bsdf& b, const vec3& from, const vec3& l,
                                              bool front, float u, Transport transport) {
    const float eta = eta_from(b, front);
    const float r = glass_reflectance(b, l.z, eta);
    const float p = choose_lobes(b, l.z).glass;
    if (u < r) {
        const vec3 to = to_world(b, {-l.x, -l.y, l.z}, front);
        if ((glm::dot(to, b.ng) > 0) != front) return {};
        return finish_delta(b, from, to, b.glass * r, p * r, p * r, 1, transport);
    }
    const float cos_t = b.thin ? l.z : safe_sqrt(1 - (1 - l.z) * (1 + l.z) / sqr(eta));
    const float bend = b.thin ? 1 : 1 / eta;
    const vec3 to = to_world(b, {-l.x * bend, -l.y * bend, -cos_t}, front);
    if ((glm::dot(to, b.ng) > 0) == front || cos_t == 0) return {};
    const float back = choose_lobes(b, cos_t).glass * (1 - r);
    return finish_delta(b, from, to, b.glass * b.glass_tint * (1 - r), p * (1 - r), back,
                        b.thin ? 1 : eta, transport);
}

// A direction of the rough lobes in the local frame; empty where the facet turns it to the wrong
// side.
std::optional<vec3> sample_facet(const Bsdf& b, const vec3& l, bool front, bool glass,
                                 const vec3& u) {
    const vec3 h = sample_ggx_visible(l, b.alpha, vec2(u));
    const float cos_h = glm::dot(l, h);
    if (cos_h <= 0) return {};
    const vec3 mirrored = 2 * cos_h * h - l;
    if (!glass) return mirrored.z > 0 ? std::optional(mirrored) : std::nullopt;
    const float eta = eta_from(b, front);
    if (u.z < glass_reflectance(b, cos_h, eta))
        return mirrored.z > 0 ? std::optional(mirrored) : std::nullopt;
    if (b.thin)
        return mirrored.z > 0 ? std::optional(vec3(mirrored.x, mirrored.y, -mirrored.z))
                              : std::nullopt;
    const float sin2_t = (1 - cos_h) * (1 + cos_h) / sqr(eta);
    if (sin2_t >= 1) return {};
    const vec3 t = h * (cos_h / eta - std::sqrt(1 - sin2_t)) - l / eta;
    return t.z < 0 ? std::optional(glm::normalize(t)) : std::nullopt;
}

}  // namespace

bool Bsdf::smooth() const {
    return alpha < smooth_alpha || (has_glass() && !thin && std::abs(eta - 1) < matched_index);
}

BsdfEval eval_bsdf(const Bsdf& b, const vec3& from, const vec3& to, Transport transport) {
    const float gf = glm::dot(from, b.ng), gt = glm::dot(to, b.ng);
    if (gf == 0 || gt == 0) return {};
    const bool front = gf > 0;
    LocalPair p;
    p.from = to_local(b, from, front);
    p.to = to_local(b, to, front);
    p.eta = eta_from(b, front);
    p.reflects = gf * gt > 0;
    p.from_matches = p.from.z > 0;
    p.to_matches = p.reflects ? p.to.z > 0 : p.to.z < 0;
    BsdfEval e = eval_lobes(b, p, transport);
    e.f *= shading_normal_factor(b, transport == Transport::radiance ? to : from);
    return e;
}

std::optional<BsdfSample> sample_bsdf(const Bsdf& b, const vec3& from, const vec3& u,
                                      Transport transport) {
    const float gf = glm::dot(from, b.ng);
    if (gf == 0) return {};
    const bool front = gf > 0;
    const vec3 l = to_local(b, from, front);
    const LobeChoice choice = choose_lobes(b, l.z);
    if (!(choice.diffuse + choice.specular + choice.glass > 0)) return {};
    vec3 local;
    if (u.z < choice.diffuse) {
        local = square_to_cosine_hemisphere(vec2(u));
    } else {
        const bool glass = u.z >= choice.diffuse + choice.specular && choice.glass > 0;
        const float start = choice.diffuse + (glass ? choice.specular : 0);
        const float width = glass ? choice.glass : choice.specular;
        const float inside = std::clamp((u.z - start) / width, 0.0f, 1 - 0x1p-24f);
        if (b.smooth())
            return glass ? sample_smooth_glass(b, from, l, front, inside, transport)
                         : sample_mirror(b, from, l, front, transport);
        const std::optional<vec3> facet = sample_facet(b, l, front, glass, {u.x, u.y, inside});
        if (!facet) return {};
        local = *facet;
    }
    BsdfSample s;
    s.to = to_world(b, local, front);
    const bool above = glm::dot(s.to, b.ng) * gf > 0;
    if (u.z < choice.diffuse) {
        // The part of the hemisphere about ns that lies below ng is folded back through the point.
        if (!above) s.to = -s.to;
    } else if (above != (local.z > 0)) {
        return {};
    }
    const BsdfEval e = eval_bsdf(b, from, s.to, transport);
    if (!(e.pdf_fwd_w > 0) || is_black(e.f)) return {};
    s.weight = e.f * (abs_dot(s.to, b.ng) / e.pdf_fwd_w);
    s.pdf_fwd_w = e.pdf_fwd_w;
    s.pdf_rev_w = e.pdf_rev_w;
    if (!above && u.z >= choice.diffuse && !b.thin && transport == Transport::radiance)
        s.eta_scale = 1 / sqr(eta_from(b, front));
    return s;
}

vec3 approximate_albedo(const Bsdf& b) {
    return b.diffuse + b.f0 + b.glass * (0.04f + 0.96f * b.glass_tint);
}

}  // namespace midway
