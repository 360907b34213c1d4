#include "io/gltf_material.h"

#include <cmath>

namespace midway::gltf {
namespace {

constexpr double huge = 1e30;  // above it the products of a renderer in float overflow

// What a conversion needs at hand.
struct Context {
    Document& document;
    ImageTable& images;
    SceneDescription& scene;
    std::string name;
};

std::vector<double> numbers(const tinygltf::Value* value) {
    std::vector<double> out;
    for (std::size_t i = 0; value && i < value->ArrayLen(); ++i) {
        const tinygltf::Value& entry = value->Get(static_cast<int>(i));
        if (entry.IsNumber()) out.push_back(entry.GetNumberAsDouble());
    }
    return out;
}

Wrap convert_wrap(Context& context, int mode) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            return Wrap::repeat;
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::clamp;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::mirror;
        default:
            warn(context.document, "unknown wrap mode of a sampler; repeats instead");
    }
    return Wrap::repeat;
}

// KHR_texture_transform: uv' = T * R * S * uv, as two rows; it may also choose the set of
// coordinates.
void apply_transform(Context& context, const tinygltf::ExtensionMap& extensions, TextureRef& out) {
    const tinygltf::Value* transform = extension(extensions, "KHR_texture_transform");
    if (!transform) return;
    std::vector<double> offset = numbers(member(*transform, "offset"));
    std::vector<double> scale = numbers(member(*transform, "scale"));
    if (offset.size() != 2) offset = {0, 0};
    if (scale.size() != 2) scale = {1, 1};
    const double angle = number(*transform, "rotation", 0);
    const double c = std::cos(angle), s = std::sin(angle);
    out.texcoord = integer(*transform, "texCoord", out.texcoord);
    const vec3 rows[2] = {vec3(c * scale[0], s * scale[1], offset[0]),
                          vec3(-s * scale[0], c * scale[1], offset[1])};
    if (is_finite(rows[0]) && is_finite(rows[1])) {
        out.rows[0] = rows[0];
        out.rows[1] = rows[1];
    } else {
        warn(context.document, context.name + ": a texture transform is not finite; left out");
    }
}

TextureRef convert_texture(Context& context, int index, int texcoord,
                           const tinygltf::ExtensionMap& extensions) {
    TextureRef out;
    if (index < 0) return out;
    Document& document = context.document;
    const tinygltf::Texture& texture = at(document, document.model.textures, index, "texture");
    out.texcoord = texcoord;
    apply_transform(context, extensions, out);
    if (out.texcoord < 0 || out.texcoord > 1) {
        warn(document, context.name + ": a texture uses coordinate set " +
                           std::to_string(out.texcoord) +
                           "; only 0 and 1 are read, it is left out");
        return {};
    }
    if (texture.source < 0) {
        warn(document, context.name + ": texture " + std::to_string(index) +
                           " has no PNG or JPEG image; left out");
        return {};
    }
    if (texture.sampler >= 0) {
        const auto& sampler = at(document, document.model.samplers, texture.sampler, "sampler");
        out.wrap_u = convert_wrap(context, sampler.wrapS);
        out.wrap_v = convert_wrap(context, sampler.wrapT);
        out.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    out.image = load_image(document, context.images, texture.source, context.scene);
    return out.image < 0 ? TextureRef{} : out;
}

// A textureInfo inside an extension object, which tinygltf leaves as plain values.
TextureRef extension_texture(Context& context, const tinygltf::Value& object, const char* key) {
    const tinygltf::Value* info = member(object, key);
    if (!info || !info->IsObject()) return {};
    tinygltf::ExtensionMap extensions;
    if (const tinygltf::Value* nested = member(*info, "extensions"); nested && nested->IsObject()) {
        extensions = nested->Get<tinygltf::Value::Object>();
    }
    return convert_texture(context, integer(*info, "index", -1), integer(*info, "texCoord", 0),
                           extensions);
}

void convert_core(Context& context, const tinygltf::Material& in, Material& out) {
    Document& document = context.document;
    const std::string& name = context.name;
    const tinygltf::PbrMetallicRoughness& pbr = in.pbrMetallicRoughness;
    if (pbr.baseColorFactor.size() == 4) {
        const std::vector<double> rgb(pbr.baseColorFactor.begin(), pbr.baseColorFactor.begin() + 3);
        out.base_color = clamped_color(document, rgb, vec3(1), 1, name + " baseColorFactor");
        out.alpha = clamped(document, pbr.baseColorFactor[3], 0, 1, name + " alpha");
    }
    out.metallic = clamped(document, pbr.metallicFactor, 0, 1, name + " metallicFactor");
    out.roughness = clamped(document, pbr.roughnessFactor, 0, 1, name + " roughnessFactor");
    const auto texture = [&](const auto& info) {
        return convert_texture(context, info.index, info.texCoord, info.extensions);
    };
    out.base_color_texture = texture(pbr.baseColorTexture);
    out.metallic_roughness_texture = texture(pbr.metallicRoughnessTexture);
    out.normal_texture = texture(in.normalTexture);
    out.emission_texture = texture(in.emissiveTexture);
    out.normal_scale =
        clamped(document, in.normalTexture.scale, -huge, huge, name + " normal scale");
    out.emission =
        clamped_color(document, in.emissiveFactor, vec3(0), huge, name + " emissiveFactor");
    out.emissive_factor = out.emission;
    out.alpha_cutoff = clamped(document, in.alphaCutoff, 0, huge, name + " alphaCutoff");
    out.double_sided = in.doubleSided;
    if (in.alphaMode == "MASK") out.alpha_mode = AlphaMode::mask;
    if (in.alphaMode == "BLEND") out.alpha_mode = AlphaMode::blend;
}

// KHR_materials_volume: the body is kept, its absorption is not rendered.
void convert_volume(Context& context, const tinygltf::Value& volume, Material& out) {
    out.has_thickness = number(volume, "thicknessFactor", 0) > 0;
    if (!out.has_thickness || number(volume, "attenuationDistance", 0) <= 0) return;
    const std::vector<double> color = numbers(member(volume, "attenuationColor"));
    const bool white = color.size() != 3 || (color[0] >= 1 && color[1] >= 1 && color[2] >= 1);
    if (!white) {
        warn(context.document, context.name + ": absorption inside the volume is left out");
    }
}

// KHR_materials_ior: 0 stands for a Fresnel factor of one, which a very large index approaches.
float convert_ior(Context& context, double ior) {
    constexpr double mirror_like = 1000;
    if (ior == 0) {
        warn(context.document, context.name + " ior is 0; read as " + std::to_string(1000));
        return mirror_like;
    }
    return clamped(context.document, ior, 1, mirror_like, context.name + " ior");
}

void convert_extensions(Context& context, const tinygltf::Material& in, Material& out) {
    Document& document = context.document;
    const std::string& name = context.name;
    if (const auto* e = extension(in.extensions, "KHR_materials_emissive_strength")) {
        out.emissive_strength = clamped(document, number(*e, "emissiveStrength", 1), 0, huge,
                                        name + " emissiveStrength");
        out.emission *= out.emissive_strength;
        if (!is_finite(out.emission)) fail(document.path, name + " emits infinite light");
    }
    if (const auto* e = extension(in.extensions, "KHR_materials_transmission")) {
        out.transmission = clamped(document, number(*e, "transmissionFactor", 0), 0, 1,
                                   name + " transmissionFactor");
        out.transmission_texture = extension_texture(context, *e, "transmissionTexture");
    }
    if (const auto* e = extension(in.extensions, "KHR_materials_ior")) {
        out.ior = convert_ior(context, number(*e, "ior", 1.5));
    }
    if (const auto* e = extension(in.extensions, "KHR_materials_specular")) {
        out.specular =
            clamped(document, number(*e, "specularFactor", 1), 0, 1, name + " specularFactor");
        out.specular_texture = extension_texture(context, *e, "specularTexture");
        out.specular_color = clamped_color(document, numbers(member(*e, "specularColorFactor")),
                                           vec3(1), huge, name + " specularColorFactor");
        out.specular_color_texture = extension_texture(context, *e, "specularColorTexture");
    }
    if (const auto* e = extension(in.extensions, "KHR_materials_volume")) {
        convert_volume(context, *e, out);
    }
    if (in.extensions.count("KHR_materials_unlit")) {
        warn(document, name + " is unlit; it is rendered as an ordinary surface");
    }
}

}  // namespace

float clamped(Document& document, double value, double low, double high, const std::string& what) {
    if (value >= low && value <= high) return static_cast<float>(value);
    const double mended = std::clamp(value, low, high);
    warn(document, what + " is out of range; clamped");
    return static_cast<float>(mended);
}

vec3 clamped_color(Document& document, const std::vector<double>& values, vec3 otherwise,
                   double high, const std::string& what) {
    if (values.size() != 3) return otherwise;
    vec3 out;
    for (int c = 0; c < 3; ++c) {
        out[c] = clamped(document, values[static_cast<std::size_t>(c)], 0, high, what);
    }
    return out;
}

bool uses_texcoord(const Material& material, int set) {
    for (const TextureRef* texture :
         {&material.base_color_texture, &material.metallic_roughness_texture,
          &material.normal_texture, &material.emission_texture, &material.transmission_texture,
          &material.specular_texture, &material.specular_color_texture}) {
        if (texture->used() && texture->texcoord == set) return true;
    }
    return false;
}

Material convert_material(Document& document, ImageTable& images, int material,
                          SceneDescription& scene) {
    Material out;
    if (material < 0) {
        out.name = "default";
        return out;
    }
    const tinygltf::Material& in = at(document, document.model.materials, material, "material");
    const std::string number = "material " + std::to_string(material);
    out.name = in.name.empty() ? number : printable(in.name);
    Context context{document, images, scene,
                    in.name.empty() ? number : number + " \"" + out.name + "\""};
    convert_core(context, in, out);
    convert_extensions(context, in, out);
    return out;
}

}  // namespace midway::gltf
