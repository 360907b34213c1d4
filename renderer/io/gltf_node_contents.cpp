// What nodes carry besides meshes: cameras, lights, and the places of instances.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/gltf_accessor.h"
#include "io/gltf_material.h"
#include "io/gltf_nodes.h"

namespace midway::gltf {
namespace {

constexpr double largest_intensity = 1e30;

std::string name_or(const std::string& name, const std::string& otherwise) {
    return name.empty() ? otherwise : printable(name);
}

void set_cone(Document& document, const tinygltf::SpotLight& spot, const std::string& name,
              PunctualLight& out) {
    // The fall-off divides by the difference of the cosines, so the cones must differ.
    constexpr float widest_inner = 0.999f;
    constexpr double narrowest = 1e-3;
    constexpr double half_pi = std::numbers::pi / 2;
    out.outer_cone_angle =
        clamped(document, spot.outerConeAngle, narrowest, half_pi, name + " outerConeAngle");
    out.inner_cone_angle = clamped(document, spot.innerConeAngle, 0,
                                   widest_inner * out.outer_cone_angle, name + " innerConeAngle");
}

template <typename V>
std::vector<V> read_instances(Document& document, const tinygltf::Value& attributes,
                              const char* key) {
    const int accessor = integer(attributes, key, -1);
    return accessor < 0 ? std::vector<V>() : read_vectors<V>(document, accessor);
}

}  // namespace

void add_camera(Document& document, int node, const dmat4& to_world, SceneDescription& scene) {
    const int index = document.model.nodes[static_cast<std::size_t>(node)].camera;
    if (index < 0) return;
    const tinygltf::Camera& camera = at(document, document.model.cameras, index, "camera");
    const std::string name = name_or(camera.name, node_name(document, node));
    if (camera.type != "perspective") {
        warn(document, "camera \"" + name + "\" is orthographic; left out");
        return;
    }
    const double yfov = camera.perspective.yfov;
    if (!(yfov > 0 && yfov < std::numbers::pi) || !usable_matrix(to_world)) {
        warn(document, "camera \"" + name + "\" has an impossible angle or place; left out");
        return;
    }
    CameraDescription out;
    out.name = name;
    out.yfov = yfov;
    if (camera.perspective.aspectRatio > 0) out.aspect_ratio = camera.perspective.aspectRatio;
    out.to_world = to_world;
    scene.cameras.push_back(std::move(out));
}

void add_light(Document& document, int node, const dmat4& to_world, SceneDescription& scene) {
    const auto& extensions = document.model.nodes[static_cast<std::size_t>(node)].extensions;
    const tinygltf::Value* reference = extension(extensions, "KHR_lights_punctual");
    const int index = reference ? integer(*reference, "light", -1) : -1;
    if (index < 0) return;
    const tinygltf::Light& light = at(document, document.model.lights, index, "light");
    PunctualLight out;
    out.name = name_or(light.name, node_name(document, node));
    const std::string name = "light \"" + out.name + "\"";
    if (light.type == "spot") {
        out.kind = PunctualKind::spot;
        set_cone(document, light.spot, name, out);
    } else if (light.type == "directional") {
        out.kind = PunctualKind::directional;
    } else if (light.type != "point") {
        warn(document, name + " is of an unknown type; left out");
        return;
    }
    if (!usable_matrix(to_world)) {
        warn(document, name + " has an impossible place; left out");
        return;
    }
    out.color = clamped_color(document, light.color, vec3(1), largest_intensity, name + " color");
    out.intensity = clamped(document, light.intensity, 0, largest_intensity, name + " intensity");
    out.range = clamped(document, light.range, 0, largest_intensity, name + " range");
    out.to_world = to_world;
    scene.lights.push_back(std::move(out));
}

std::vector<dmat4> mesh_transforms(Document& document, int node, const dmat4& to_world) {
    const auto& extensions = document.model.nodes[static_cast<std::size_t>(node)].extensions;
    const tinygltf::Value* instancing = extension(extensions, "EXT_mesh_gpu_instancing");
    const tinygltf::Value* attributes = instancing ? member(*instancing, "attributes") : nullptr;
    if (!attributes || !attributes->IsObject()) return {to_world};
    const auto translations = read_instances<vec3>(document, *attributes, "TRANSLATION");
    const auto rotations = read_instances<vec4>(document, *attributes, "ROTATION");
    const auto scales = read_instances<vec3>(document, *attributes, "SCALE");
    const std::size_t count = std::max({translations.size(), rotations.size(), scales.size()});
    for (const std::size_t size : {translations.size(), rotations.size(), scales.size()}) {
        if (size != 0 && size != count) {
            fail(document.path, "the instances of " + node_name(document, node) +
                                    " have attributes of different lengths");
        }
    }
    std::vector<dmat4> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = to_world * compose(translations.empty() ? dvec3(0) : dvec3(translations[i]),
                                    rotations.empty() ? dvec4(0, 0, 0, 1) : dvec4(rotations[i]),
                                    scales.empty() ? dvec3(1) : dvec3(scales[i]));
    }
    return out;
}

}  // namespace midway::gltf
