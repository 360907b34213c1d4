#include "shading/bsdf.h"

#include "shading/bsdf_lobes.h"

namespace midway {
namespace lobes {
namespace {

bool has_coat(const Bsdf& b) { return b.coat_f90 != 0 || b.coat_f0 != 0; }

float coat_normalisation(const Bsdf& b) {
    if (!has_coat(b)) return 1;
    const SchlickAlbedo e = average_albedo(b.alpha);
    return 1 / std::max(1e-4f, 1 - b.coat_f0 * e.a - b.coat_f90 * e.b);
}

// Sums over lobes for one pair: f times the light side's cosine, and both densities.
struct PairSums {
    vec3 value{0};
    float pdf_light = 0;   // of i given o
    float pdf_camera = 0;  // of o given i
};

// A lobe between ao and w; the shares scale the value and the densities.
struct LobeShares {
    vec3 value{0};
    float light = 0, camera = 0;
};

// Microfacet reflection of w and v, both above; v is the light side.
void add_reflection(const Bsdf& b, const vec3& o, const vec3& v, const vec3& h,
                    const LobeShares& share, PairSums& sums) {
    const float d = ggx_d(h, b.alpha);
    sums.value += share.value * (d * ggx_g2(o, v, b.alpha) / (4 * o.z));
    sums.pdf_light += share.light * ggx_g1(o, b.alpha) * d / (4 * o.z);
    sums.pdf_camera += share.camera * ggx_g1(v, b.alpha) * d / (4 * v.z);
}

// Refraction from o (above) to w (below); eta = index beyond over that at o. Walter et al. 2007,
// eq. 21: radiance ends in the camera's medium, hence no eta^2 in the numerator.
void add_refraction(const Bsdf& b, const vec3& o, const vec3& w, float eta, const LobeShares& share,
                    PairSums& sums) {
    vec3 h = o + eta * w;
    const float len2 = length_squared(h);
    if (len2 == 0) return;
    h *= (h.z < 0 ? -1 : 1) / std::sqrt(len2);
    const float co = glm::dot(o, h), cw = -glm::dot(w, h);
    if (co <= 0 || cw <= 0) return;
    const float transmitted = 1 - glass_reflectance(b, co, eta);
    if (transmitted <= 0) return;
    const vec3 mirrored = above(w);
    const float common = transmitted * ggx_d(h, b.alpha) * co * cw / sqr(co - eta * cw);
    sums.value += share.value * (common * ggx_g2(o, mirrored, b.alpha) / o.z);
    sums.pdf_light += share.light * common * sqr(eta) * ggx_g1(o, b.alpha) / o.z;
    sums.pdf_camera += share.camera * common * ggx_g1(mirrored, b.alpha) / mirrored.z;
}

// All rough lobes between ao and one of the light side's w. `choice_o` and `choice_i` already hold
// the probabilities of the folds.
void add_facets(const Bsdf& b, const vec3& ao, const vec3& w, bool reflects, float eta,
                const LobeChoice& choice_o, const LobeChoice& choice_i, PairSums& sums) {
    if (!reflects && !b.thin) {
        if (b.has_glass())
            add_refraction(b, ao, w, eta, {b.glass * b.glass_tint, choice_o.glass, choice_i.glass},
                           sums);
        return;
    }
    const vec3 v = above(w);
    const vec3 h = glm::normalize(ao + v);
    const float cos_h = std::max(0.0f, glm::dot(ao, h));
    if (reflects && b.has_specular())
        add_reflection(b, ao, v, h,
                       {specular_fresnel(b, cos_h), choice_o.specular, choice_i.specular}, sums);
    if (!b.has_glass()) return;
    const float r = glass_reflectance(b, cos_h, eta);
    const float part = reflects ? r : 1 - r;
    const vec3 tint = reflects ? vec3(1) : b.glass_tint;
    add_reflection(b, ao, v, h,
                   {b.glass * tint * part, choice_o.glass * part, choice_i.glass * part}, sums);
}

LobeChoice scaled(const LobeChoice& c, float by) {
    return {c.diffuse * by, c.specular * by, c.glass * by};
}

// sum_lobes() where there is Lambert's lobe alone, with the same bits.
PairSums sum_diffuse(const Bsdf& b, const vec3& o, const vec3& i) {
    if (!b.has_diffuse()) return {};
    const float mu_o = abs_dot(b.frame.n, o), mu_i = abs_dot(b.frame.n, i);
    return {b.diffuse * (inv_pi * mu_i), cosine_hemisphere_pdf_w(mu_i),
            cosine_hemisphere_pdf_w(mu_o)};
}

// Not inline: the short way beside it would have to save as many registers.
[[gnu::noinline]] PairSums sum_lobes(const Bsdf& b, const vec3& o_world, const vec3& i_world,
                                     bool front, bool reflects) {
    const SideFrame side = side_frame(b, front);
    const bool light_front = front == reflects;
    const vec3 o = to_local(b, o_world, front);
    const vec3 i = to_local(b, i_world, light_front);
    const LightSide light = light_side(side_frame(b, light_front), i);
    const float mu_o = std::abs(o.z), mu_i = std::abs(i.z), z_i = light_cosine(light);
    const LayerAlbedo at_o = layer_albedo(b, mu_o), at_i = layer_albedo(b, z_i);
    const LobeChoice choice_o = choose_lobes(b, mu_o, at_o);
    const LobeChoice choice_i = choose_lobes(b, z_i, at_i);
    PairSums sums;
    if (reflects && b.has_diffuse()) {
        // Where the light's direction was folded, the diffuse lobe sees its own cosine.
        const float below_i = mu_i == z_i ? at_i.below : layer_albedo(b, mu_i).below;
        sums.value = b.diffuse * (inv_pi * mu_i * at_o.below * below_i * coat_normalisation(b));
        sums.pdf_light = choice_o.diffuse * cosine_hemisphere_pdf_w(mu_i);
        sums.pdf_camera = choice_i.diffuse * cosine_hemisphere_pdf_w(mu_o);
    }
    if (b.smooth() || light.count == 0 || o.z == 0) return sums;
    const LobeChoice from_light =
        scaled(choice_i, 1.0f / static_cast<float>(light.count * camera_folds(side, o)));
    for (int k = 0; k < light.count; ++k) {
        // The light side's directions are above in their own frame; below in o's for transmission.
        const vec3 w(light.w[k].x, light.w[k].y, reflects ? light.w[k].z : -light.w[k].z);
        add_facets(b, above(o), w, reflects, eta_beyond(b, front), choice_o, from_light, sums);
    }
    return sums;
}

}  // namespace

LayerAlbedo layer_albedo(const Bsdf& b, float mu) {
    LayerAlbedo l;
    if (!has_coat(b) && !b.has_specular()) return l;
    l.specular = directional_albedo(mu, b.alpha);
    if (has_coat(b))
        l.below = std::max(0.0f, 1 - b.coat_f0 * l.specular.a - b.coat_f90 * l.specular.b);
    return l;
}

LobeChoice choose_lobes(const Bsdf& b, float z, const LayerAlbedo& at_z) {
    LobeChoice c;
    if (b.only_diffuse) {
        c.diffuse = b.has_diffuse() ? 1.0f : 0.0f;
        return c;
    }
    if (b.has_diffuse()) c.diffuse = max_component(b.diffuse) * at_z.below;
    if (z > 0) {
        if (b.has_specular())
            c.specular = max_component(b.f0 * at_z.specular.a + b.f90 * at_z.specular.b);
        if (b.has_glass()) c.glass = max_component(b.glass);
    }
    // Where the coat takes nearly all, the layer below still needs a chance: f > 0 there.
    if (b.has_diffuse()) c.diffuse = std::max({c.diffuse, 0.02f * (c.specular + c.glass), 1e-6f});
    const float sum = c.diffuse + c.specular + c.glass;
    if (sum > 0) {
        c.diffuse /= sum;
        c.specular /= sum;
        c.glass /= sum;
    }
    return c;
}

}  // namespace lobes

bool Bsdf::smooth() const {
    // Below this distance from 1 a refraction bends rays by less than the width of a smooth lobe.
    constexpr float matched_index = 1e-3f;
    return alpha < smooth_alpha || (has_glass() && !thin && std::abs(eta - 1) < matched_index);
}

BsdfEval eval_bsdf(const Bsdf& b, const vec3& from, const vec3& to, Transport transport) {
    const bool radiance = transport == Transport::radiance;
    const vec3& o = radiance ? from : to;
    const vec3& i = radiance ? to : from;
    const float go = glm::dot(o, b.ng), gi = glm::dot(i, b.ng);
    if (go == 0 || gi == 0) return {};
    const bool reflects = go * gi > 0;
    if (!reflects && !b.has_glass()) return {};
    const lobes::PairSums s =
        b.only_diffuse ? lobes::sum_diffuse(b, o, i) : lobes::sum_lobes(b, o, i, go > 0, reflects);
    const vec3 f = s.value * (1.0f / std::abs(gi));
    return radiance ? BsdfEval{f, s.pdf_light, s.pdf_camera}
                    : BsdfEval{f, s.pdf_camera, s.pdf_light};
}

vec3 approximate_albedo(const Bsdf& b) {
    return b.diffuse + b.f0 + b.glass * (0.04f + 0.96f * b.glass_tint);
}

}  // namespace midway
