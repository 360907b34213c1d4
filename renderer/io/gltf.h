// glTF 2.0 (.gltf with its files, or .glb) into a SceneDescription, in the file's own units, with
// node transforms in double. Files are taken as hostile: everything in them is checked before use.
// What the renderer cannot show is left out or mended with a line in SceneDescription::warnings; a
// file that is broken throws std::runtime_error with one line "WHAT (FILE); REMEDY". Source:
// Khronos, glTF 2.0 specification (2.0.1, 2021) and the KHR/EXT extensions named below.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scene/scene_description.h"

namespace midway {

inline constexpr std::array<std::string_view, 12> supported_gltf_extensions = {
    "KHR_materials_emissive_strength",
    "KHR_lights_punctual",
    "KHR_materials_transmission",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_volume",
    "KHR_materials_unlit",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression"};

// Whether the file is .gltf or .glb is decided by its content, not by its name.
SceneDescription load_gltf(const std::string& path);

// The same from memory; `path` is for messages and for the folder of the files it refers to.
SceneDescription load_gltf_from_memory(std::span<const std::uint8_t> file, const std::string& path);

}  // namespace midway
