// Random walks from the camera or from a light. One walk serves both ends: extend() traces to the
// next surface and keeps the sums of the MIS weights up to date, scatter() chooses where to go from
// there.
#pragma once

#include <array>
#include <atomic>
#include <optional>

#include "image/pixel_filter.h"
#include "integrator/facts.h"
#include "integrator/mis.h"
#include "math/sampler.h"
#include "scene/scene.h"

namespace midway {

// How many exponents one set of paths can be weighed with at once.
inline constexpr int max_exponents = 8;
// And so many weights there are, with the one that decides about choices.
inline constexpr int max_weights = max_exponents + 1;

struct PixelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // x1, y1 excluded
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    std::int64_t area() const { return std::int64_t{width()} * height(); }
    bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

// What a worker is at, for `midway bench`, which looks now and then.
enum class Work : std::uint8_t { other, rays, sampling, shading, weights, film };
inline constexpr size_t work_kinds = 6;

// So many camera samples, of neighbouring pixels, share their light subpaths (light_subpaths.h).
inline constexpr int group_pixels = 8;

// When walks may end by chance. It stays out of the MIS pdfs: every strategy keeps its own
// expectation, whatever the survival probability.
struct Roulette {
    int start = 4;          // at which bounce
    float camera_sure = 1;  // throughput at which a camera walk goes on for sure

    bool operator==(const Roulette&) const = default;
};

// All that an estimator needs to know apart from the sample's number.
struct Estimator {
    const Scene* scene = nullptr;
    Camera camera;
    PixelFilter filter;
    PixelRect crop;
    Families families;
    bool direct_lamps = true;  // (2,0) is shown, also where emitter hits are not a family in use
    std::array<double, max_weights> exponents{2};
    int exponent_count = 1;
    // The families that the weights of each exponent count: those in use, but for a pilot that asks
    // how others would have weighed the same paths (render/pilot_sums.h).
    std::array<Families, max_weights> weighed;
    int max_bounces = 16;
    std::uint64_t seed = 0;
    SamplerKind sampler = SamplerKind::sobol;
    // Per pass: n of eq. (22).
    std::uint64_t light_subpaths = 1;
    // n of connections: the share of the camera samples that have a light subpath to connect to.
    double connection_share = 1;
    // From how many light subpaths a camera walk chooses what its first rough surface is connected
    // to (light_subpaths.h): so many times n of connections there.
    int choices = group_pixels;
    // Which of the weights decides about choices: always that of exponent 2, lest the paths of an
    // image depend on what it is weighed with. Where nobody asked for it, it is kept behind the
    // others.
    int deciding = 0;
    // What counts of light_subpaths where light tracing competes with next event for direct light,
    // paths of two edges: n there is light_subpaths times this. A camera sample's share of a pixel
    // is stratified, a splat falls by chance, and densities alone do not tell (Grittmann, Georgiev,
    // Slusallek and Krivanek 2019, "Variance-aware multiple importance sampling"). See
    // direct_share() in render/settings.h. Zero: light tracing does not make such paths.
    double direct_share = 1;

    // n of next event on paths of two edges: how often a camera walk's first surface asks for
    // light, 1 or 2 (splitting; Arvo and Kirk 1990, "Particle transport and image synthesis").
    int direct_samples = 1;

    Roulette roulette;

    std::atomic<Work>* watch = nullptr;  // where somebody looks
    void at(Work work) const {
        if (watch) watch->store(work, std::memory_order_relaxed);
    }

    // n of eq. (22) over light_subpaths, for paths of so many edges.
    double share_of(int edges) const { return edges == 2 ? direct_share : 1; }

    // n of next event on paths of so many edges.
    int next_events(int edges) const { return edges == 2 ? direct_samples : 1; }

    // Whether light tracing makes paths of so many edges.
    bool splats(int edges) const { return families.light_tracing && share_of(edges) > 0; }

    // Whether a strategy takes part in images.
    bool forms(const Strategy& k) const {
        return family_of(k) == Family::light_tracing ? splats(k.edges()) : has(k);
    }

    bool has(const Strategy& k) const { return families.has(family_of(k)); }
    // n of connections, at the camera walk's first rough surface or elsewhere.
    double connections(bool first) const { return connection_share * (first ? choices : 1); }
    // n of a strategy in the weights of an exponent, as mis.h wants it beside a vcm. `first`: its
    // last camera vertex is the first rough surface.
    double count(const Strategy& k, int exponent, bool first) const {
        const Family family = family_of(k);
        if (!weighed[exponent].has(family)) return 0;
        if (family == Family::next_event) return next_events(k.edges());
        return family == Family::connection ? connections(first) : 1;
    }
};

template <Facts F>
int exponent_count(const Estimator& e) {
    return F.one_power2 ? 1 : e.exponent_count;
}

// Calls `use` with the heuristic of each exponent, and its number; also of the one that decides.
template <Facts F, class Use>
void for_each_exponent(const Estimator& e, const Use& use) {
    if constexpr (F.one_power2) {
        use(mis::Power2<>{}, 0);
    } else {
        for (int i = 0; i < std::max(e.exponent_count, e.deciding + 1); ++i)
            mis::with_heuristic(e.exponents[i], [&](const auto& h) { use(h, i); });
    }
}

// A surface vertex of a subpath. Endpoints (lens, light) are never stored.
struct PathVertex {
    vec3 position{0};
    float error = 0;
    vec3 ng{0, 0, 1};
    vec3 to_previous{0, 0, 1};  // unit
    vec3 throughput{0};         // of the subpath up to here, this vertex's scattering excluded
    Bsdf bsdf;
    std::array<mis::State, max_weights> mis;
    int index = 0;  // edges walked: 1 for the first surface
    int rough = 0;  // as in Walk
    bool connectible = false;
};

// A number with 48 bits from two with 24; the first alone decides where it lies, nearly.
inline double fine_number(float coarse, float fine) { return coarse + 0x1p-24 * double(fine); }

inline Double8 fine_numbers(const Float8& coarse, const Float8& fine) {
    return to_double(coarse) + all_lanes(0x1p-24) * to_double(fine);
}

// Random numbers that a vertex uses: for the walk's next direction and roulette, and for next event
// or the lens.
struct VertexNumbers {
    vec4 scatter{0}, connect{0};
};

// What next event makes of a vertex's numbers.
inline NextEventNumbers next_event_numbers(const vec4& u) {
    return {fine_number(u.x, u.w), {u.y, u.z}};
}

// Calls `use` with the numbers of every next event from the camera vertex of that index, and which
// it is. The second ones lie in the other half of each dimension: the first binary digit is the
// other one, which keeps what stratifies them.
template <class Four, class Use>
void for_each_next_event(const Estimator& e, int index, const Four& u, const Use& use) {
    use(u, 0);
    if (e.next_events(index + 1) == 1) return;
    const auto other_half = [](const auto& x) { return select(x < 0.5f, x + 0.5f, x - 0.5f); };
    Four second = u;
    for (int i = 0; i < 3; ++i) second[i] = other_half(u[i]);
    use(second, 1);
}

struct Walk {
    Transport transport = Transport::radiance;
    SampleKey key;
    Ray ray;
    vec3 throughput{1};
    float roulette_reference = 1;  // throughput at which a walk survives for sure
    int roulette_start = 4;

    // Of the scattering at the previous vertex (or the start), for the next extend().
    vec3 previous_position{0};
    float pdf_fwd_w = 0, pdf_rev_w = 0;
    float cos_previous = 1;
    bool delta = false;

    // Start of a light subpath; unused by the camera.
    int light = -1;
    LightPdfs light_pdfs;
    bool infinite_light = false, hittable_light = true;

    int index = 0;  // of the vertex reached last
    // Of the camera walk's first vertex that did not scatter by a delta lobe; 0: none before the
    // last. Light subpaths keep 0.
    int rough = 0;
    std::optional<SurfacePoint> point;
    PathVertex vertex;  // its mis also where the walk left the scene
    VertexNumbers numbers;
};

// What decides about transparent surfaces on the walk's next edge: of a walk's edges, all
// different; who tosses it hashes it.
inline std::uint64_t walk_coin(const SampleKey& key, int index) {
    return key.key + key.reversed * 0xbf58476d1ce4e5b9ull +
           std::uint64_t(index) * 0x94d049bb133111ebull;
}

// The strategy that the previous vertex's vcm stands for, when a walk has reached vertex `index`.
// On the camera side vertex i stands for the connection of its i predecessors to a longer light
// subpath (light tracing for i = 1); on the light side for i light vertices (next event for i = 1)
// and the camera's, three or more: the edge is followed by another.
inline Strategy previous_strategy(Transport transport, int index) {
    const int i = index - 1;
    return transport == Transport::radiance ? Strategy{i, 2} : Strategy{3, i};
}

// Whether the last camera vertex of that strategy is the walk's first rough one. On the light side
// it is behind a rough one, the end of the edge that will be connected.
template <class Int>
auto previous_is_first(const Int& rough, int index) {
    return rough == index - 2;
}

SampleKey camera_key(const Estimator& e, int x, int y, std::uint64_t pass);
SampleKey light_key(const Estimator& e, std::uint64_t subpath, std::uint64_t pass);
// The pixels that share light subpaths: eight of one row, or fewer at its end. They do not stand
// side by side where a row is long enough, but in a run of 32 every fourth: what their samples have
// in common would be a streak.
struct PixelGroup {
    int x0 = 0, y = 0;
    int step = 1, count = 0;
    int size() const { return count; }
    int x(int place) const { return x0 + step * place; }
    int place_of(int pixel_x) const { return (pixel_x - x0) / step; }
};
inline constexpr int run_pixels = 32;

// Number n of a row's groups, and the one of a pixel.
PixelGroup group_at(const PixelRect& crop, int n, int y);
inline int group_number(const PixelRect& crop, int x) {
    const int column = x - crop.x0, run = column / run_pixels * run_pixels;
    constexpr int step = run_pixels / group_pixels;
    const bool whole = run + run_pixels <= crop.width();
    return run / group_pixels + (whole ? column % step : (column - run) / group_pixels);
}
inline PixelGroup group_of(const PixelRect& crop, int x, int y) {
    return group_at(crop, group_number(crop, x), y);
}
inline int group_count(const PixelRect& crop) {
    return (crop.width() + group_pixels - 1) / group_pixels;
}

// The light subpath that belongs to the sample of a pixel in a pass. Where this is not below
// e.light_subpaths, the sample has none; where adding the crop's area (again) is, it has more.
std::uint64_t paired_subpath(const Estimator& e, int x, int y, std::uint64_t pass);

// The same of the pixels of a group.
std::array<std::uint64_t, group_pixels> paired_subpaths(const Estimator& e, const PixelGroup& g,
                                                        std::uint64_t pass);

// Calls `use` with the number of every light subpath of a sample, of which `paired` is the first.
template <class Use>
void for_each_subpath(const Estimator& e, std::uint64_t paired, const Use& use) {
    const auto step = static_cast<std::uint64_t>(e.crop.area());
    for (std::uint64_t i = paired; i < e.light_subpaths; i += step) use(i);
}

Walk start_camera_walk(const Estimator& e, int x, int y, std::uint64_t pass);
std::optional<Walk> start_light_walk(const Estimator& e, std::uint64_t subpath, std::uint64_t pass);

// Traces to the next vertex. Where a camera's ray leaves the scene, walk.vertex.mis holds the sums
// for a vertex at infinity (g = 1, eq. 37). `nothing`: rounding left no edge to walk, and the walk
// ends.
enum class Reached : std::uint8_t { surface, sky, nothing };
template <Facts F = no_facts>
Reached extend(const Estimator& e, Walk& walk);

// Chooses the next direction. False where the walk ends.
bool scatter(Walk& walk);

}  // namespace midway
