// A scene under construction and its binary glTF 2.0 file (Khronos 2021): JSON and one buffer of
// float32 attributes with uint16 or uint32 indices. Units are metres, radians, and radiometric:
// emission is radiance, point and spot intensity per steradian, directional intensity irradiance.
#pragma once

#include <string>
#include <vector>

#include "mesh.h"

namespace midway::assets {

// Metallic-roughness and KHR_materials_{emissive_strength, specular, transmission, ior, volume}.
struct Material {
    std::string name;
    dvec3 base_color{1};
    double metallic = 0, roughness = 1;
    double specular = 1;  // 0: pure Lambert
    double ior = 1.5;
    bool solid_glass = false;  // lets all light through, as a body of glass
    dvec3 emission{0};
    bool double_sided = false;
};

Material lambert(const std::string& name, const dvec3& color);
Material glossy(const std::string& name, const dvec3& color, double roughness);
Material metal(const std::string& name, const dvec3& color, double roughness);
Material glass(const std::string& name, double ior);
Material lamp(const std::string& name, const dvec3& radiance);

enum class LightKind { point, spot, directional };

struct Light {
    std::string name;
    LightKind kind = LightKind::point;
    dvec3 intensity{1};
    double inner_cone_angle = 0, outer_cone_angle = pi / 4;  // spot only
    dmat4 to_world{1.0};
};

struct Camera {
    std::string name;
    double yfov = 0.7;
    double aspect_ratio = 1;
    dmat4 to_world{1.0};
};

struct Geometry {
    std::string name;
    Mesh mesh;
};

struct Object {
    std::string name;
    int geometry = 0, material = 0;
    dmat4 to_world{1.0};
};

struct Scene {
    std::string name;
    std::vector<Geometry> geometries;
    std::vector<Material> materials;
    std::vector<Object> objects;
    std::vector<Light> lights;
    std::vector<Camera> cameras;
};

int add_material(Scene& scene, const Material& material);
// Solid bodies are checked to be closed and manifold, surfaces (walls, leaves) need not be.
int add_solid(Scene& scene, const std::string& name, Mesh mesh);
int add_surface(Scene& scene, const std::string& name, Mesh mesh);
void place(Scene& scene, const std::string& name, int geometry, int material,
           const dmat4& to_world = dmat4(1.0));
// The same for a thing that stands in the scene once, where it was modelled.
void show_solid(Scene& scene, const std::string& name, int material, Mesh mesh);
void show_surface(Scene& scene, const std::string& name, int material, Mesh mesh);

// The bytes of the .glb file. Equal scenes give equal bytes.
std::string glb_bytes(const Scene& scene);

}  // namespace midway::assets
