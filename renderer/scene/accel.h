// Ray queries against a Geometry. The only user of Embree is accel.cpp.
//
// Alpha is a probability: a walk's ray meets a transparent triangle with probability alpha, decided
// by a hash of (coin, object, triangle), so that the answer depends neither on the order of
// traversal nor on the thread; a connection is multiplied by 1 - alpha of everything that it
// crosses.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "math/lanes.h"
#include "scene/geometry.h"

namespace midway {

struct Ray {
    vec3 origin{0};
    vec3 direction{0, 0, 1};  // any length; tfar is in units of it
    float tfar = std::numeric_limits<float>::infinity();
};

// Eight of them; a lane each.
struct RayLanes {
    Vec3x8 origin, direction;
    Float8 tfar;

    Ray operator[](int lane) const { return {origin[lane], direction[lane], tfar[lane]}; }
};
using HitLanes = std::array<TriangleHit, lane_count>;

// Rays as one thread traced them, in their order.
struct RayLog {
    struct Entry {
        Ray ray;
        bool closest = false;  // or a connection
    };
    std::vector<Entry> rays;
    size_t limit = 0;          // of what is kept
    std::uint64_t missed = 0;  // beyond it
};

struct Scene;

// Coverage at a hit of an object with may_be_transparent (defined in scene.cpp).
struct AlphaLookup {
    const Scene* scene = nullptr;
    float operator()(const TriangleHit& hit) const;
};

class Accel {
  public:
    // Keeps the geometry alive. Throws std::runtime_error where Embree refuses. `ask_all`: opaque
    // objects are asked for their coverage too.
    explicit Accel(std::shared_ptr<const Geometry> geometry, bool ask_all = false);
    // The same tree, for one thread: each ray is written to `log` too.
    Accel(const Accel& other, RayLog& log);
    ~Accel();
    Accel(const Accel&) = delete;
    Accel& operator=(const Accel&) = delete;

    // The first surface that the walk's ray meets; object < 0: none.
    TriangleHit closest(const Ray& ray, const AlphaLookup& alpha, std::uint64_t coin) const;

    // The same for those lanes of eight rays that are wanted, whose hits are written.
    void closest(const RayLanes& rays, const Mask8& wanted, const AlphaLookup& alpha,
                 const std::array<std::uint64_t, lane_count>& coins, HitLanes& hits) const;

    // What arrives over the segment origin + [0, tfar] * direction: 0 where something opaque is
    // hit.
    float transmittance(const Ray& ray, const AlphaLookup& alpha) const;

    // The same for lanes; 1 where it is not wanted.
    Float8 transmittance(const RayLanes& rays, const Mask8& wanted, const AlphaLookup& alpha) const;

    // Traces a log once more and nothing else; returns how many rays met something.
    std::uint64_t replay(const RayLog& log, const AlphaLookup& alpha) const;

  private:
    struct Embree;
    std::shared_ptr<const Geometry> geometry_;
    std::shared_ptr<const Embree> embree_;
    RayLog* log_ = nullptr;
};

}  // namespace midway
