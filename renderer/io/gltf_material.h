// Materials and textures of a glTF file. Factors outside their range are clamped with a warning; a
// texture that cannot be used is left out with a warning. Internal to renderer/io.
#pragma once

#include "io/gltf_document.h"
#include "io/gltf_images.h"
#include "scene/scene_description.h"

namespace midway::gltf {

// `material` < 0 gives the default material of glTF.
Material convert_material(Document& document, ImageTable& images, int material,
                          SceneDescription& scene);

// Whether a texture of the material reads this set of texture coordinates.
bool uses_texcoord(const Material& material, int set);

// A number of the file as float; clamped to [low, high] with a warning that names `what`.
float clamped(Document& document, double value, double low, double high, const std::string& what);

// Three numbers, `otherwise` where absent or of another length; each clamped as above.
vec3 clamped_color(Document& document, const std::vector<double>& values, vec3 otherwise,
                   double high, const std::string& what);

}  // namespace midway::gltf
