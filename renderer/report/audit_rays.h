// Rays traced back from what a walk hit: does a ray meet the triangle it leaves, does a closed mesh
// let one through, does a connection see what a walk saw?
//
// From every hit of a walk, rays leave as those of the renderer do (offset by the error bound of
// the hit): back along the edge, and along random directions on either side. A triangle is flat, so
// a ray that meets the very triangle it left is a self-hit whatever the distance. A closed mesh
// (every edge shared by two triangles in opposite directions) parts space: a ray that starts before
// a front must next see a front of that mesh, one that starts behind a front the back of one. Where
// it does not, the ray is followed through all triangles of the mesh in long double to tell a leak
// from a mesh that cuts through itself, and how far from an edge it passed.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "integrator/walk.h"
#include "report/audit_sums.h"

namespace midway {

struct RayFault {
    std::uint64_t count = 0;
    AuditPlace place;  // of lowest pixel and sample; the walk's vertex; s = 1: of a camera walk
    std::string object;
    void add(const AuditPlace& at, const std::string& name);
    void merge(const RayFault& other);
};

struct RayAudit {
    std::uint64_t rays = 0;  // traced back from a surface
    RayFault self_hits;
    std::uint64_t closed_rays = 0;  // of which left a closed mesh
    RayFault leaks;                 // that pass an edge or a vertex within rounding
    RayFault unexplained;           // that do not
    std::uint64_t overlaps = 0;     // rays in meshes that cut through themselves
    double farthest_leak = 0;       // largest distance of a leak to an edge, in error bounds
    std::uint64_t edges = 0;        // edges of walks, tried as connections
    RayFault blocked;               // that a connection finds blocked
    std::uint64_t pairs = 0;        // connections traced in both directions
    RayFault unequal;               // that differ
    std::uint64_t stopped = 0;      // walks that ended because rounding left no edge
    void merge(const RayAudit& other);
};

struct RayAuditOptions {
    std::int64_t rays = 1000000;  // at least; whole passes are drawn
    int threads = 0;              // 0: all processors
    std::function<void(double)> tick;
};
RayAudit audit_rays(const Estimator& estimator, const RayAuditOptions& options);

}  // namespace midway
