// Closed meshes of a scene, each with a tree of its own, and the ray tests that they allow.
#pragma once

#include <memory>
#include <vector>

#include "scene/scene.h"

namespace midway {

// Space is parted by a mesh whose every edge is shared by two triangles in opposite directions: a
// ray that starts before the front of one must next meet a front of the mesh or nothing, one that
// starts behind it a back; in the bounded part it must meet something.
struct ClosedMesh {
    std::shared_ptr<const Geometry> geometry;  // this object alone, not transparent
    std::unique_ptr<Accel> accel;
    bool front_bounded = false;  // fronts look into the bounded part, as in a room
    const Object& object() const { return geometry->objects.front(); }
};

// One entry per object; null where it is not closed. At most so many objects get one.
std::vector<std::unique_ptr<ClosedMesh>> closed_meshes(const Scene& scene, size_t most);

enum class RayOutcome { as_it_must, leak, overlap, unexplained };

struct LeakFinding {
    RayOutcome outcome = RayOutcome::as_it_must;
    double edge_distance = 0;  // of a leak, in error bounds of the hit
};

// A ray that leaves a hit of the mesh.
struct LeavingRay {
    Ray ray;
    vec3 start{0};  // the hit, before its offset
    float error = 0;
    int triangle = -1;
    bool front = true;  // leaves on the side of the front
};
LeakFinding follow(const ClosedMesh& mesh, const LeavingRay& leaving);

}  // namespace midway
