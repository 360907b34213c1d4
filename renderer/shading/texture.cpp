#include "shading/texture.h"

#include <array>

#include "shading/microfacet.h"

namespace midway {
namespace {

// sRGB to linear for all 256 codes (IEC 61966-2-1).
const std::array<float, 256>& srgb_table() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> t{};
        for (int i = 0; i < 256; ++i) {
            const double c = i / 255.0;
            t[i] =
                static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
        }
        return t;
    }();
    return table;
}

int wrap_index(std::int64_t i, int n, Wrap wrap) {
    if (i >= 0 && i < n) return static_cast<int>(i);  // spares the division, mostly
    if (wrap == Wrap::clamp) return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
    const std::int64_t period = wrap == Wrap::mirror ? 2 * std::int64_t{n} : n;
    std::int64_t r = i % period;
    if (r < 0) r += period;
    return static_cast<int>(r < n ? r : period - 1 - r);
}

vec4 texel(const TextureImage& image, const TextureRef& ref, std::int64_t x, std::int64_t y,
           ColorSpace space) {
    const size_t at =
        4 * (static_cast<size_t>(wrap_index(y, image.height, ref.wrap_v)) * image.width +
             wrap_index(x, image.width, ref.wrap_u));
    const std::uint8_t* c = &image.rgba[at];
    const float a = c[3] / 255.0f;
    if (space == ColorSpace::linear) return {c[0] / 255.0f, c[1] / 255.0f, c[2] / 255.0f, a};
    const auto& t = srgb_table();
    return {t[c[0]], t[c[1]], t[c[2]], a};
}

// Tangent frame of the interpolated normal, tilted by the normal map.
vec3 mapped_normal(const Material& m, const TextureSet& textures, const ShadingPoint& p) {
    if (!m.normal_texture.used()) return p.normal;
    const vec3 t_raw = vec3(p.tangent) - p.normal * glm::dot(p.normal, vec3(p.tangent));
    const float t_len = glm::length(t_raw);
    if (!(t_len > 0)) return p.normal;
    const vec3 t = t_raw / t_len, b = glm::cross(p.normal, t) * p.tangent.w;
    vec3 n = vec3(sample_texture(textures, m.normal_texture, p, ColorSpace::linear)) * 2.0f - 1.0f;
    n.x *= m.normal_scale;
    n.y *= m.normal_scale;
    const vec3 mapped = t * n.x + b * n.y + p.normal * n.z;
    const float len = glm::length(mapped);
    return len > 0 ? mapped / len : p.normal;
}

// The side of the normals is ng's; files whose normals point inwards would otherwise turn black.
vec3 shading_normal(const Material& m, const TextureSet& textures, const ShadingPoint& p) {
    const vec3 n = mapped_normal(m, textures, p);
    const float c = glm::dot(n, p.ng);
    if (c == 0) return p.ng;
    return c > 0 ? n : -n;
}

}  // namespace

vec4 look_up_texture(const TextureSet& textures, const TextureRef& ref, const ShadingPoint& point,
                     ColorSpace space) {
    const TextureImage& image = *textures[ref.image];
    const vec3 uv1(point.uv[ref.texcoord], 1);
    const double x = double(glm::dot(ref.rows[0], uv1)) * image.width;
    const double y = double(glm::dot(ref.rows[1], uv1)) * image.height;
    // Coordinates beyond any use would overflow the integers below.
    if (!(std::abs(x) < 1e15 && std::abs(y) < 1e15)) return texel(image, ref, 0, 0, space);
    if (ref.nearest)
        return texel(image, ref, static_cast<std::int64_t>(std::floor(x)),
                     static_cast<std::int64_t>(std::floor(y)), space);
    const double fx = std::floor(x - 0.5), fy = std::floor(y - 0.5);
    const float tx = static_cast<float>(x - 0.5 - fx), ty = static_cast<float>(y - 0.5 - fy);
    const auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
    const vec4 top =
        glm::mix(texel(image, ref, ix, iy, space), texel(image, ref, ix + 1, iy, space), tx);
    const vec4 bottom = glm::mix(texel(image, ref, ix, iy + 1, space),
                                 texel(image, ref, ix + 1, iy + 1, space), tx);
    return glm::mix(top, bottom, ty);
}

float material_alpha(const Material& m, const TextureSet& textures, const ShadingPoint& p) {
    if (m.alpha_mode == AlphaMode::opaque) return 1;
    const float a =
        m.alpha * p.color.w * sample_texture(textures, m.base_color_texture, p, ColorSpace::srgb).w;
    if (m.alpha_mode == AlphaMode::mask) return a >= m.alpha_cutoff ? 1.0f : 0.0f;
    return std::clamp(a, 0.0f, 1.0f);
}

vec3 material_emission(const Material& m, const TextureSet& textures, const ShadingPoint& p) {
    return m.emission * vec3(sample_texture(textures, m.emission_texture, p, ColorSpace::srgb));
}

Bsdf make_bsdf(const Material& m, const TextureSet& textures, const ShadingPoint& p) {
    const vec3 base =
        glm::clamp(m.base_color * vec3(p.color) *
                       vec3(sample_texture(textures, m.base_color_texture, p, ColorSpace::srgb)),
                   0.0f, 1.0f);
    const vec4 mr = sample_texture(textures, m.metallic_roughness_texture, p, ColorSpace::linear);
    const float metallic = std::clamp(m.metallic * mr.z, 0.0f, 1.0f);
    const float roughness = std::clamp(m.roughness * mr.y, 0.0f, 1.0f);
    const float transmission =
        m.transmission > 0
            ? m.transmission *
                  sample_texture(textures, m.transmission_texture, p, ColorSpace::linear).x
            : 0.0f;
    const float specular =
        m.specular * sample_texture(textures, m.specular_texture, p, ColorSpace::linear).w;
    const vec3 tint = m.specular_color *
                      vec3(sample_texture(textures, m.specular_color_texture, p, ColorSpace::srgb));

    Bsdf b;
    b.ng = p.ng;
    b.frame = frame_from_normal(shading_normal(m, textures, p));
    b.alpha = sqr(roughness);
    b.eta = m.ior;
    // A material with a thickness fills a body whatever its mesh looks like.
    b.thin = !(m.transmission > 0) || (p.thin && !m.has_thickness);
    // glTF 2.0 appendix B and KHR_materials_specular: a dielectric coat over a diffuse layer, mixed
    // with a metal; the transmitted part replaces coat and diffuse layer together.
    const vec3 coat_f0 = glm::min(tint * sqr((m.ior - 1) / (m.ior + 1)), vec3(1)) * specular;
    const float opaque = (1 - metallic) * (1 - transmission);
    b.diffuse = base * opaque;
    b.coat_f0 = max_component(coat_f0);
    b.coat_f90 = specular;
    b.f0 = base * metallic + coat_f0 * opaque;
    b.f90 = vec3(metallic + specular * opaque);
    b.glass = vec3((1 - metallic) * transmission);
    b.glass_tint = base;
    b.only_diffuse = !b.has_specular() && !b.has_glass() && b.coat_f0 == 0 && b.coat_f90 == 0;
    return b;
}

bool may_be_smooth(const Material& m) {
    return sqr(m.roughness) < smooth_alpha || m.metallic_roughness_texture.used() ||
           std::abs(m.ior - 1) < 1e-3f;
}

}  // namespace midway
