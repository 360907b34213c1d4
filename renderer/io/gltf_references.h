// The files that a scene is made of, without loading it: for whoever watches them for changes.
#pragma once

#include <string>
#include <vector>

namespace midway {

// The files that a .gltf or .glb names for its buffers and images, as paths; whether they exist or
// may be opened is not asked. Empty where the scene cannot be read.
std::vector<std::string> gltf_references(const std::string& path);

}  // namespace midway
