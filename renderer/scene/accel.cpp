#include "scene/accel.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define MIDWAY_EMBREE4 1
#else
#include <embree3/rtcore.h>
#define MIDWAY_EMBREE4 0
#endif

#include <stdexcept>
#include <string>

#include "math/hash.h"

namespace midway {
namespace {

#if MIDWAY_EMBREE4
using QueryContext = RTCRayQueryContext;
void init_context(QueryContext* c) { rtcInitRayQueryContext(c); }
#else
using QueryContext = RTCIntersectContext;
void init_context(QueryContext* c) { rtcInitIntersectContext(c); }
#endif

// What a filter needs to know about the ray it is called for. Embree hands the first member back.
struct Query {
    QueryContext embree;
    const AlphaLookup* alpha = nullptr;
    std::uint64_t coin = 0;
    float transmittance = 1;
};

TriangleHit filter_hit(const RTCFilterFunctionNArguments* args) {
    RTCHitN* hit = args->hit;
    return {static_cast<int>(RTCHitN_geomID(hit, args->N, 0)),
            static_cast<int>(RTCHitN_primID(hit, args->N, 0)), RTCHitN_u(hit, args->N, 0),
            RTCHitN_v(hit, args->N, 0)};
}

// Walks: the coin says whether the ray meets this triangle.
void flip_coin(const RTCFilterFunctionNArguments* args) {
    const Query& q = *reinterpret_cast<const Query*>(args->context);
    const TriangleHit hit = filter_hit(args);
    const std::uint64_t place =
        (static_cast<std::uint64_t>(hit.object) << 32) | static_cast<std::uint32_t>(hit.triangle);
    const float u = to_unit_float(static_cast<std::uint32_t>(hash_combine(q.coin, place)));
    if (u >= (*q.alpha)(hit)) args->valid[0] = 0;
}

// Connections: multiply, and go on unless nothing is left.
void multiply_through(const RTCFilterFunctionNArguments* args) {
    Query& q = *reinterpret_cast<Query*>(args->context);
    const float alpha = (*q.alpha)(filter_hit(args));
    if (alpha >= 1) return;
    q.transmittance *= 1 - alpha;
    args->valid[0] = 0;
}

typedef float Quad __attribute__((vector_size(16), may_alias));
static_assert(offsetof(RTCRay, tnear) == 12 && offsetof(RTCRay, dir_x) == 16 &&
              offsetof(RTCRay, time) == 28 && offsetof(RTCRay, tfar) == 32 &&
              alignof(RTCRay) == 16);

// What Embree reads of a ray, in the widths that it reads it in: it would otherwise wait for
// several narrow stores, a tenth of a path tracer's time.
struct RayQuads {
    Quad origin;     // ..., tnear
    Quad direction;  // ..., time
};
RayQuads quads_of(const Ray& ray) {
    return {Quad{ray.origin.x, ray.origin.y, ray.origin.z, 0},
            Quad{ray.direction.x, ray.direction.y, ray.direction.z, 0}};
}

// Vectors of eight lanes as quads, the fourth number zero: of lane k at place[k].
constexpr std::array<int, lane_count> place = {0, 2, 4, 6, 1, 3, 5, 7};
struct QuadLanes {
    alignas(32) Quad quads[lane_count];
    const Quad& operator[](int lane) const { return quads[place[lane]]; }
};
QuadLanes quads_of(const Vec3x8& v) {
    const Float8 zero{};
    const Float8 xy = interleave_low(v.x, v.y), xy_next = interleave_high(v.x, v.y);
    const Float8 zw = interleave_low(v.z, zero), zw_next = interleave_high(v.z, zero);
    const auto lower = [](const Float8& a, const Float8& b) {
        return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
    };
    const auto upper = [](const Float8& a, const Float8& b) {
        return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    };
    return std::bit_cast<QuadLanes>(std::array<Float8, 4>{
        lower(xy, zw), upper(xy, zw), lower(xy_next, zw_next), upper(xy_next, zw_next)});
}

void fill_ray(RTCRay& r, const RayQuads& q, float tfar) {
    Quad* quads = reinterpret_cast<Quad*>(&r);
    quads[0] = q.origin;
    quads[1] = q.direction;
    r.tfar = tfar;
    r.mask = ~0u;
    r.id = 0;
    r.flags = 0;
}

TriangleHit trace_closest(RTCScene scene, Query& q, const RayQuads& ray, float tfar) {
    RTCRayHit r;
    fill_ray(r.ray, ray, tfar);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if MIDWAY_EMBREE4
    RTCIntersectArguments args;
    rtcInitIntersectArguments(&args);
    args.context = &q.embree;
    rtcIntersect1(scene, &r, &args);
#else
    rtcIntersect1(scene, &q.embree, &r);
#endif
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {static_cast<int>(r.hit.geomID), static_cast<int>(r.hit.primID), r.hit.u, r.hit.v};
}

float trace_segment(RTCScene scene, Query& q, const RayQuads& ray, float tfar) {
    RTCRay r;
    fill_ray(r, ray, tfar);
    q.transmittance = 1;
#if MIDWAY_EMBREE4
    RTCOccludedArguments args;
    rtcInitOccludedArguments(&args);
    args.context = &q.embree;
    rtcOccluded1(scene, &r, &args);
#else
    rtcOccluded1(scene, &q.embree, &r);
#endif
    // Embree marks an occluded ray by tfar = -inf.
    return r.tfar < 0 ? 0.0f : q.transmittance;
}

Query make_query(const AlphaLookup& alpha) {
    Query q;
    init_context(&q.embree);
    q.alpha = &alpha;
    return q;
}

void write(RayLog& log, const RayLog::Entry& entry) {
    if (log.rays.size() < log.limit)
        log.rays.push_back(entry);
    else
        ++log.missed;
}

}  // namespace

struct Accel::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    ~Embree() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
};

Accel::Accel(std::shared_ptr<const Geometry> geometry, bool ask_all)
    : geometry_(std::move(geometry)) {
    const auto embree = std::make_shared<Embree>();
    embree_ = embree;
    Embree& e = *embree;
    e.device = rtcNewDevice(nullptr);
    if (!e.device) throw std::runtime_error("Embree cannot start (device); check the processor");
    e.scene = rtcNewScene(e.device);
    // High quality was not deterministic; the robust flag closes the edges between triangles.
    rtcSetSceneBuildQuality(e.scene, RTC_BUILD_QUALITY_MEDIUM);
    int flags = RTC_SCENE_FLAG_ROBUST;
#if !MIDWAY_EMBREE4
    flags |= RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif
    rtcSetSceneFlags(e.scene, static_cast<RTCSceneFlags>(flags));
    for (size_t i = 0; i < geometry_->objects.size(); ++i) {
        const Object& o = geometry_->objects[i];
        RTCGeometry g = rtcNewGeometry(e.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* vertices = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                 sizeof(vec3), o.positions.size());
        void* indices = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                sizeof(uvec3), o.triangles.size());
        if (!vertices || !indices) {
            rtcReleaseGeometry(g);
            throw std::runtime_error("out of memory for triangles (object \"" + o.name +
                                     "\"); use a smaller scene");
        }
        std::copy(o.positions.begin(), o.positions.end(), static_cast<vec3*>(vertices));
        std::copy(o.triangles.begin(), o.triangles.end(), static_cast<uvec3*>(indices));
        if (o.may_be_transparent || ask_all) {
            rtcSetGeometryIntersectFilterFunction(g, flip_coin);
            rtcSetGeometryOccludedFilterFunction(g, multiply_through);
        }
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(e.scene, g, static_cast<unsigned>(i));
        rtcReleaseGeometry(g);
    }
    rtcCommitScene(e.scene);
    if (rtcGetDeviceError(e.device) != RTC_ERROR_NONE)
        throw std::runtime_error("Embree cannot build its tree (scene); use a smaller scene");
}

Accel::Accel(const Accel& other, RayLog& log)
    : geometry_(other.geometry_), embree_(other.embree_), log_(&log) {}

Accel::~Accel() = default;

TriangleHit Accel::closest(const Ray& ray, const AlphaLookup& alpha, std::uint64_t coin) const {
    if (log_) write(*log_, {ray, true});
    Query q = make_query(alpha);
    q.coin = coin;
    return trace_closest(embree_->scene, q, quads_of(ray), ray.tfar);
}

namespace {

// Asks the memory for what surfaces_at() will read of a hit: its triangle, and once that is there
// its corners. Each is fetched while the next ray is traced.
void prefetch_triangle(const Geometry& g, const TriangleHit& hit) {
    if (hit.object >= 0) __builtin_prefetch(&g.objects[hit.object].triangles[hit.triangle]);
}
void prefetch_corners(const Geometry& g, const TriangleHit& hit) {
    if (hit.object < 0) return;
    const Object& o = g.objects[hit.object];
    const uvec3& t = o.triangles[hit.triangle];
    for (int i = 0; i < 3; ++i) {
        __builtin_prefetch(&o.positions[t[i]]);
        if (!o.normals.empty()) __builtin_prefetch(&o.normals[t[i]]);
    }
}

}  // namespace

void Accel::closest(const RayLanes& rays, const Mask8& wanted, const AlphaLookup& alpha,
                    const std::array<std::uint64_t, lane_count>& coins, HitLanes& hits) const {
    const QuadLanes origins = quads_of(rays.origin), directions = quads_of(rays.direction);
    Query q = make_query(alpha);
    TriangleHit previous;
    for_each_lane(wanted, [&](int k) {
        if (log_) write(*log_, {rays[k], true});
        q.coin = coins[k];
        hits[k] = trace_closest(embree_->scene, q, {origins[k], directions[k]}, rays.tfar[k]);
        prefetch_triangle(*geometry_, hits[k]);
        prefetch_corners(*geometry_, previous);
        previous = hits[k];
    });
    prefetch_corners(*geometry_, previous);
}

float Accel::transmittance(const Ray& ray, const AlphaLookup& alpha) const {
    if (log_) write(*log_, {ray, false});
    Query q = make_query(alpha);
    return trace_segment(embree_->scene, q, quads_of(ray), ray.tfar);
}

Float8 Accel::transmittance(const RayLanes& rays, const Mask8& wanted,
                            const AlphaLookup& alpha) const {
    const QuadLanes origins = quads_of(rays.origin), directions = quads_of(rays.direction);
    Query q = make_query(alpha);
    Float8 parts = all_lanes(1.0f);
    for_each_lane(wanted, [&](int k) {
        if (log_) write(*log_, {rays[k], false});
        parts[k] = trace_segment(embree_->scene, q, {origins[k], directions[k]}, rays.tfar[k]);
    });
    return parts;
}

std::uint64_t Accel::replay(const RayLog& log, const AlphaLookup& alpha) const {
    std::uint64_t met = 0;
    for (const RayLog::Entry& e : log.rays)
        met += e.closest ? closest(e.ray, alpha, 0).object >= 0 : transmittance(e.ray, alpha) < 1;
    return met;
}

}  // namespace midway
