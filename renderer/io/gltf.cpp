#include "io/gltf.h"

#include <map>
#include <new>
#include <stdexcept>

#include "io/gltf_accessor.h"
#include "io/gltf_document.h"
#include "io/gltf_material.h"
#include "io/gltf_mesh.h"
#include "io/gltf_nodes.h"

namespace midway {
namespace {

using namespace gltf;

constexpr std::size_t max_instances = std::size_t{1} << 22;

// A primitive as it was built: the id of its mesh, -1 where nothing is left of it.
struct BuiltPrimitive {
    int mesh = -1;
    std::optional<dvec3> world_origin;
};

struct Importer {
    Document document;
    NodeTree tree;
    SceneDescription scene;
    ImageTable images;
    std::map<int, int> materials;  // of the file to the scene's; -1: the default
    std::map<std::pair<int, int>, BuiltPrimitive>
        primitives;  // (mesh, primitive) as the mesh has it
};

int use_material(Importer& importer, int material) {
    if (material < 0) material = -1;
    const auto [entry, added] = importer.materials.try_emplace(material, 0);
    if (added) {
        Material converted =
            convert_material(importer.document, importer.images, material, importer.scene);
        entry->second = static_cast<int>(importer.scene.materials.size());
        importer.scene.materials.push_back(std::move(converted));
    }
    return entry->second;
}

std::string primitive_name(const Importer& importer, int mesh, std::size_t primitive) {
    const tinygltf::Mesh& entry = importer.document.model.meshes[static_cast<std::size_t>(mesh)];
    std::string name = entry.name.empty() ? "mesh " + std::to_string(mesh) : printable(entry.name);
    if (entry.primitives.size() > 1) name += " / " + std::to_string(primitive);
    return name;
}

// World matrices of the joints times their inverse bind matrices; empty without a usable skin.
std::vector<dmat4> joint_matrices(Importer& importer, int skin_index) {
    Document& document = importer.document;
    const tinygltf::Skin& skin = at(document, document.model.skins, skin_index, "skin");
    if (skin.joints.size() > document.elements_left) {
        fail(document.path, "more than 2^29 joints", "split the scene");
    }
    document.elements_left -= skin.joints.size();
    std::vector<float> inverse_bind;
    if (skin.inverseBindMatrices >= 0) {
        inverse_bind = read_floats(document, skin.inverseBindMatrices, 16);
        if (inverse_bind.size() / 16 < skin.joints.size()) {
            warn(document, "skin " + std::to_string(skin_index) +
                               " has too few matrices; its meshes are shown unposed");
            return {};
        }
    }
    std::vector<dmat4> out;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        at(document, document.model.nodes, skin.joints[j], "node");
        dmat4 bind(1.0);
        for (int i = 0; i < 16 && !inverse_bind.empty(); ++i) {
            bind[i / 4][i % 4] = inverse_bind[j * 16 + static_cast<std::size_t>(i)];
        }
        out.push_back(importer.tree.to_world[static_cast<std::size_t>(skin.joints[j])] * bind);
    }
    return out;
}

BuiltPrimitive build_primitive(Importer& importer, int mesh, std::size_t index, int material,
                               const Deformation& deformation) {
    const tinygltf::Mesh& entry = importer.document.model.meshes[static_cast<std::size_t>(mesh)];
    const Material& look = importer.scene.materials[static_cast<std::size_t>(material)];
    const TextureRef& normal_map = look.normal_texture;
    std::optional<BuiltMesh> built = build_mesh(
        importer.document, entry.primitives[index], deformation,
        normal_map.used() ? normal_map.texcoord : -1, primitive_name(importer, mesh, index));
    if (!built) return {};
    for (const int set : {0, 1}) {
        if (uses_texcoord(look, set) &&
            built->mesh.texcoords[static_cast<std::size_t>(set)].empty()) {
            warn(importer.document, built->mesh.name + " lacks the texture coordinates " +
                                        std::to_string(set) + " that its material uses");
        }
    }
    importer.scene.meshes.push_back(std::make_shared<Mesh>(std::move(built->mesh)));
    return {static_cast<int>(importer.scene.meshes.size()) - 1, built->world_origin};
}

void add_instance(Importer& importer, int node, const BuiltPrimitive& primitive, int material,
                  const dmat4& to_world) {
    if (primitive.mesh < 0) return;
    Instance instance{node_name(importer.document, node), primitive.mesh, material, to_world};
    if (primitive.world_origin) {
        instance.to_world = dmat4(1.0);
        instance.to_world[3] = dvec4(*primitive.world_origin, 1);
    }
    if (!usable_matrix(instance.to_world)) {
        warn(importer.document, instance.name + " has an infinite transform; left out");
        return;
    }
    if (importer.scene.instances.size() >= max_instances) {
        fail(importer.document.path, "more than 2^22 instances", "split the scene");
    }
    importer.scene.instances.push_back(std::move(instance));
}

// A use of a mesh whose vertices differ from the mesh's own.
void add_deformed_use(Importer& importer, int node, const dmat4& to_world,
                      const Deformation& deformation) {
    const tinygltf::Model& model = importer.document.model;
    const int index = model.nodes[static_cast<std::size_t>(node)].mesh;
    const tinygltf::Mesh& mesh = model.meshes[static_cast<std::size_t>(index)];
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
        const int material = use_material(importer, mesh.primitives[p].material);
        const BuiltPrimitive built = build_primitive(importer, index, p, material, deformation);
        add_instance(importer, node, built, material, to_world);
    }
}

// A use of a mesh as it is, which all such uses share.
void add_shared_use(Importer& importer, int node, const dmat4& to_world) {
    const tinygltf::Model& model = importer.document.model;
    const int index = model.nodes[static_cast<std::size_t>(node)].mesh;
    const tinygltf::Mesh& mesh = model.meshes[static_cast<std::size_t>(index)];
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
        const int material = use_material(importer, mesh.primitives[p].material);
        const auto key = std::make_pair(index, static_cast<int>(p));
        const auto [known, added] = importer.primitives.try_emplace(key);
        if (added) {
            known->second =
                build_primitive(importer, index, p, material, {mesh.weights, {}, std::nullopt});
        }
        add_instance(importer, node, known->second, material, to_world);
    }
}

// A skinned mesh stands where its joints are: neither its node nor instancing moves it. A matrix
// that flattens a mesh has no inverse, so the mesh itself is flattened.
void add_meshes(Importer& importer, int node) {
    Document& document = importer.document;
    const tinygltf::Node& entry = document.model.nodes[static_cast<std::size_t>(node)];
    if (entry.mesh < 0) return;
    const tinygltf::Mesh& mesh = at(document, document.model.meshes, entry.mesh, "mesh");
    const dmat4& to_world = importer.tree.to_world[static_cast<std::size_t>(node)];
    Deformation deformation;
    deformation.weights = entry.weights.empty() ? mesh.weights : entry.weights;
    if (entry.skin >= 0) deformation.joints = joint_matrices(importer, entry.skin);
    if (!deformation.joints.empty()) {
        add_deformed_use(importer, node, to_world, deformation);
        return;
    }
    const bool own_weights = deformation.weights != mesh.weights;
    for (const dmat4& matrix : mesh_transforms(document, node, to_world)) {
        const bool flat = usable_matrix(matrix) && glm::determinant(dmat3(matrix)) == 0;
        if (flat) deformation.bake = matrix;
        if (!flat) deformation.bake.reset();
        if (flat || own_weights) {
            add_deformed_use(importer, node, matrix, deformation);
        } else {
            add_shared_use(importer, node, matrix);
        }
    }
}

SceneDescription import_document(ByteSpan file, const std::string& path) {
    Importer importer;
    importer.document = parse_document(file, path);
    importer.tree = build_node_tree(importer.document);
    importer.scene.source = path;
    importer.scene.generator = printable(importer.document.model.asset.generator);
    for (const int node : importer.tree.shown) {
        const dmat4& to_world = importer.tree.to_world[static_cast<std::size_t>(node)];
        add_camera(importer.document, node, to_world, importer.scene);
        add_light(importer.document, node, to_world, importer.scene);
        add_meshes(importer, node);
    }
    importer.scene.warnings = std::move(importer.document.warnings);
    return std::move(importer.scene);
}

}  // namespace

SceneDescription load_gltf_from_memory(std::span<const std::uint8_t> file,
                                       const std::string& path) {
    try {
        return import_document(file, path);
    } catch (const std::bad_alloc&) {
        fail(path, "not enough memory for the scene", "close programs or split the scene");
    } catch (const std::length_error&) {
        fail(path, "not enough memory for the scene", "close programs or split the scene");
    } catch (const std::runtime_error&) {
        throw;
    } catch (const std::exception& error) {
        fail(path, "not valid glTF: " + printable(error.what()));
    }
}

SceneDescription load_gltf(const std::string& path) {
    return load_gltf_from_memory(read_file(path), path);
}

}  // namespace midway
