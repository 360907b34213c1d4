#include "gltf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

namespace midway::assets {

Material lambert(const std::string& name, const dvec3& color) {
    return {.name = name, .base_color = color, .specular = 0};
}

Material glossy(const std::string& name, const dvec3& color, double roughness) {
    return {.name = name, .base_color = color, .roughness = roughness};
}

Material metal(const std::string& name, const dvec3& color, double roughness) {
    return {.name = name, .base_color = color, .metallic = 1, .roughness = roughness};
}

Material glass(const std::string& name, double ior) {
    return {.name = name, .roughness = 0, .ior = ior, .solid_glass = true};
}

Material lamp(const std::string& name, const dvec3& radiance) {
    return {.name = name, .base_color = dvec3(0), .specular = 0, .emission = radiance};
}

int add_surface(Scene& scene, const std::string& name, Mesh mesh) {
    check_mesh(mesh, scene.name + "/" + name, false);
    scene.geometries.push_back({name, std::move(mesh)});
    return static_cast<int>(scene.geometries.size()) - 1;
}

int add_solid(Scene& scene, const std::string& name, Mesh mesh) {
    check_mesh(mesh, scene.name + "/" + name, true);
    return add_surface(scene, name, std::move(mesh));
}

int add_material(Scene& scene, const Material& material) {
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

void place(Scene& scene, const std::string& name, int geometry, int material,
           const dmat4& to_world) {
    scene.objects.push_back({name, geometry, material, to_world});
}

void show_solid(Scene& scene, const std::string& name, int material, Mesh mesh) {
    place(scene, name, add_solid(scene, name, std::move(mesh)), material);
}

void show_surface(Scene& scene, const std::string& name, int material, Mesh mesh) {
    place(scene, name, add_surface(scene, name, std::move(mesh)), material);
}

namespace {

using nlohmann::json;

// Seven digits are more than a float of the renderer keeps, and hide the last bits of the C
// library.
double rounded(double x) { return std::round(x * 1e7) / 1e7 + 0.0; }

json to_json(const dvec3& v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr int type_float = 5126, type_uint16 = 5123, type_uint32 = 5125;

struct Writer {
    json root;
    std::string buffer;
};

template <class T>
int add_accessor(Writer& out, const std::vector<T>& values, int count, int component, int target,
                 const char* type) {
    const std::size_t bytes = values.size() * sizeof(T);
    out.root["bufferViews"].push_back({{"buffer", 0},
                                       {"byteOffset", out.buffer.size()},
                                       {"byteLength", bytes},
                                       {"target", target}});
    out.buffer.append(reinterpret_cast<const char*>(values.data()), bytes);
    out.buffer.resize((out.buffer.size() + 3) / 4 * 4, '\0');
    out.root["accessors"].push_back({{"bufferView", out.root["bufferViews"].size() - 1},
                                     {"componentType", component},
                                     {"count", count},
                                     {"type", type}});
    return static_cast<int>(out.root["accessors"].size()) - 1;
}

int add_vectors(Writer& out, const std::vector<dvec3>& vectors, bool with_bounds) {
    std::vector<float> values;
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const dvec3& v : vectors) {
        const glm::vec3 f(v);
        values.insert(values.end(), {f.x, f.y, f.z});
        low = glm::min(low, f);
        high = glm::max(high, f);
    }
    const int id = add_accessor(out, values, int(vectors.size()), type_float, array_buffer, "VEC3");
    if (with_bounds) {
        out.root["accessors"][id]["min"] = {low.x, low.y, low.z};
        out.root["accessors"][id]["max"] = {high.x, high.y, high.z};
    }
    return id;
}

template <class Index>
int add_indices(Writer& out, const std::vector<uvec3>& triangles, int component) {
    std::vector<Index> values;
    for (const uvec3& t : triangles)
        values.insert(values.end(), {Index(t.x), Index(t.y), Index(t.z)});
    return add_accessor(out, values, int(values.size()), component, element_array_buffer, "SCALAR");
}

json material_json(const Material& m) {
    json j = {{"name", m.name},
              {"pbrMetallicRoughness",
               {{"baseColorFactor",
                 {rounded(m.base_color.x), rounded(m.base_color.y), rounded(m.base_color.z), 1}},
                {"metallicFactor", m.metallic},
                {"roughnessFactor", m.roughness}}}};
    if (m.double_sided) j["doubleSided"] = true;
    json extensions = json::object();
    const double strength = std::max({m.emission.x, m.emission.y, m.emission.z});
    if (strength > 0) {
        j["emissiveFactor"] = to_json(m.emission / strength);
        extensions["KHR_materials_emissive_strength"]["emissiveStrength"] = rounded(strength);
    }
    if (m.specular != 1) extensions["KHR_materials_specular"]["specularFactor"] = m.specular;
    if (m.solid_glass) {
        extensions["KHR_materials_transmission"]["transmissionFactor"] = 1;
        extensions["KHR_materials_ior"]["ior"] = m.ior;
        extensions["KHR_materials_volume"]["thicknessFactor"] = 1;
    }
    if (!extensions.empty()) j["extensions"] = extensions;
    return j;
}

json light_json(const Light& light) {
    const double strength = std::max({light.intensity.x, light.intensity.y, light.intensity.z});
    const char* const kinds[] = {"point", "spot", "directional"};
    json j = {{"name", light.name},
              {"type", kinds[static_cast<int>(light.kind)]},
              {"color", to_json(light.intensity / strength)},
              {"intensity", rounded(strength)}};
    if (light.kind == LightKind::spot)
        j["spot"] = {{"innerConeAngle", rounded(light.inner_cone_angle)},
                     {"outerConeAngle", rounded(light.outer_cone_angle)}};
    return j;
}

void add_node(Writer& out, json node, const dmat4& to_world) {
    if (to_world != dmat4(1.0)) {
        json matrix = json::array();
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) matrix.push_back(rounded(to_world[column][row]));
        node["matrix"] = matrix;
    }
    out.root["scenes"][0]["nodes"].push_back(out.root["nodes"].size());
    out.root["nodes"].push_back(std::move(node));
}

// One glTF mesh for each pair of geometry and material; the accessors of a geometry are shared.
void add_objects(Writer& out, const Scene& scene) {
    std::vector<json> primitives;
    for (const Geometry& g : scene.geometries) {
        const int positions = add_vectors(out, g.mesh.positions, true);
        const int normals = add_vectors(out, g.mesh.normals, false);
        const bool is_small = g.mesh.positions.size() < 65535;
        const int indices = is_small
                                ? add_indices<std::uint16_t>(out, g.mesh.triangles, type_uint16)
                                : add_indices<std::uint32_t>(out, g.mesh.triangles, type_uint32);
        primitives.push_back(
            {{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"indices", indices}});
    }
    std::map<std::pair<int, int>, std::size_t> mesh_ids;
    for (const Object& object : scene.objects) {
        const auto [entry, is_new] =
            mesh_ids.try_emplace({object.geometry, object.material}, out.root["meshes"].size());
        if (is_new) {
            json primitive = primitives[object.geometry];
            primitive["material"] = object.material;
            out.root["meshes"].push_back({{"name", scene.geometries[object.geometry].name},
                                          {"primitives", json::array({primitive})}});
        }
        add_node(out, {{"name", object.name}, {"mesh", entry->second}}, object.to_world);
    }
}

void add_lights_and_cameras(Writer& out, const Scene& scene) {
    json lights = json::array();
    for (const Light& light : scene.lights) {
        const json reference = {{"KHR_lights_punctual", {{"light", lights.size()}}}};
        lights.push_back(light_json(light));
        add_node(out, {{"name", light.name}, {"extensions", reference}}, light.to_world);
    }
    if (!lights.empty()) out.root["extensions"]["KHR_lights_punctual"]["lights"] = lights;
    for (const Camera& camera : scene.cameras) {
        out.root["cameras"].push_back({{"name", camera.name},
                                       {"type", "perspective"},
                                       {"perspective",
                                        {{"yfov", rounded(camera.yfov)},
                                         {"aspectRatio", rounded(camera.aspect_ratio)},
                                         {"znear", 0.01}}}});
        add_node(out, {{"name", camera.name}, {"camera", out.root["cameras"].size() - 1}},
                 camera.to_world);
    }
}

void append_chunk(std::string& file, const char* type, const std::string& data, char padding) {
    const auto length = static_cast<std::uint32_t>((data.size() + 3) / 4 * 4);
    file.append(reinterpret_cast<const char*>(&length), 4);
    file.append(type, 4);
    file.append(data);
    file.append(length - data.size(), padding);
}

}  // namespace

std::string glb_bytes(const Scene& scene) {
    Writer out;
    out.root["asset"] = {{"version", "2.0"}, {"generator", "midway-assets"}};
    out.root["scene"] = 0;
    out.root["scenes"] = json::array({{{"name", scene.name}, {"nodes", json::array()}}});
    out.root["nodes"] = json::array();
    out.root["meshes"] = json::array();
    std::map<std::string, bool> extensions;
    for (const Material& m : scene.materials) {
        out.root["materials"].push_back(material_json(m));
        if (!out.root["materials"].back().contains("extensions")) continue;
        for (const auto& item : out.root["materials"].back()["extensions"].items())
            extensions[item.key()] = true;
    }
    add_objects(out, scene);
    add_lights_and_cameras(out, scene);
    if (!scene.lights.empty()) extensions["KHR_lights_punctual"] = true;
    for (const auto& [name, used] : extensions) out.root["extensionsUsed"].push_back(name);
    out.root["buffers"] = json::array({{{"byteLength", out.buffer.size()}}});

    std::string chunks;
    append_chunk(chunks, "JSON", out.root.dump(), ' ');
    append_chunk(chunks, "BIN\0", out.buffer, '\0');
    const std::uint32_t header[2] = {2, static_cast<std::uint32_t>(12 + chunks.size())};
    return "glTF" + std::string(reinterpret_cast<const char*>(header), 8) + chunks;
}

}  // namespace midway::assets
