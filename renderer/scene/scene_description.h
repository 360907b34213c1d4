// A scene as a person edits it: plain data in the file's own units and coordinates, nothing
// derived. build_scene() (scene/scene.h) freezes it into a Scene that can be traced.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "math/vector.h"
#include "shading/material.h"

namespace midway {

// Triangles of one glTF primitive, in the mesh's own coordinates. Attribute arrays are empty or as
// long as `positions`. Every index is below positions.size(). Front faces wind counter-clockwise.
struct Mesh {
    std::string name;
    std::vector<vec3> positions;
    std::vector<vec3> normals;
    std::vector<vec4> tangents;  // xyz and handedness w, as glTF stores them
    std::array<std::vector<vec2>, 2> texcoords;
    std::vector<vec4> colors;  // linear RGBA, multiplies the base colour
    std::vector<uvec3> triangles;
};

// One use of a mesh in the scene. Ids index the vectors of SceneDescription.
struct Instance {
    std::string name;  // of the node
    int mesh = 0;
    int material = 0;
    dmat4 to_world{1.0};
};

enum class PunctualKind { point, spot, directional };

// KHR_lights_punctual. `color` times `intensity` is radiant intensity per steradian for point and
// spot and irradiance for directional lights (numbers of the file taken as radiometric). The light
// sits at the origin of its node and looks along the node's -z.
struct PunctualLight {
    std::string name;
    PunctualKind kind = PunctualKind::point;
    vec3 color{1};
    float intensity = 1;
    float inner_cone_angle = 0;              // radians, spot only
    float outer_cone_angle = 0.7853981634f;  // radians, spot only, above inner, at most pi/2
    float range = 0;                         // of the file; a hint for rasterisers, not applied
    dmat4 to_world{1.0};
};

// Perspective camera at the origin of its node, looking along -z with +y up (glTF).
struct CameraDescription {
    std::string name;
    double yfov = 0.7;                   // radians, vertical
    std::optional<double> aspect_ratio;  // of the file, width / height
    double aperture_radius = 0;          // of the thin lens, in the file's units; 0: pinhole
    double focus_distance = 0;           // along the view axis; 0 with a lens: the bounds' centre
    dmat4 to_world{1.0};
};

// Light from infinitely far: an equirectangular map, or one colour where `map` is empty. The middle
// of the map looks along -z, a quarter to the right of it is +x, the top row is +y.
struct SkyDescription {
    std::string source;  // file name, or "colour", or "default"
    std::shared_ptr<const Image> map;
    vec3 color{1};
    float strength = 1;
    double rotation_degrees = 0;  // about +y, counter-clockwise seen from above
};

struct SceneDescription {
    std::string source;  // path of the file
    std::string generator;
    std::vector<std::shared_ptr<const Mesh>> meshes;  // none is null; shared by edited copies
    std::vector<Material> materials;                  // never empty once an instance exists
    std::vector<std::shared_ptr<const TextureImage>> images;
    std::vector<Instance> instances;
    std::vector<PunctualLight> lights;
    std::vector<CameraDescription> cameras;
    std::optional<SkyDescription> sky;
    float lamp_strength = 1;            // multiplies every light but the sky
    std::vector<std::string> warnings;  // one line each: what was left out or mended, and why
};

}  // namespace midway
