#include "integrator/walk.h"

#include "math/in_place.h"

namespace midway {
namespace {

enum Stream : std::uint64_t { camera_stream = 1, light_stream = 2 };

// Even and odd passes are two independent scrambles.
SampleKey make_key(const Estimator& e, Stream stream, std::uint64_t pass, std::uint64_t place,
                   std::uint64_t index) {
    const std::uint64_t half = mix64(e.seed + (2 * stream + (pass & 1)) * golden);
    return make_sample_key(mix64(half + place), index, e.sampler);
}

// A permutation of the pixels that leaves neighbours together, so that the subpaths that they share
// come from different strata of the lights: where the pixels from `first` on go. The groups, and
// each one in itself, are turned by chance: every pixel has exactly the same chance of each
// subpath, or it would meet some strata more often. What is left of an image beyond whole groups
// keeps to itself.
struct PermutedGroup {
    std::uint64_t first = 0, to = 0;
    std::uint32_t size = 1, turn = 0;

    std::uint64_t operator()(std::uint64_t pixel) const {
        return to + (static_cast<std::uint32_t>(pixel - first) + turn) % size;
    }
};
PermutedGroup permute_group(std::uint64_t pixel, std::uint64_t pixels, std::uint64_t key) {
    const std::uint64_t groups = pixels / group_pixels, group = pixel / group_pixels;
    PermutedGroup p;
    p.first = p.to = group * group_pixels;
    p.size = static_cast<std::uint32_t>(std::min<std::uint64_t>(group_pixels, pixels - p.first));
    p.turn = static_cast<std::uint32_t>(mix64(key + (group + 1) * golden) % p.size);
    if (group < groups)
        p.to = group_pixels * ((permute_index(group, groups, key) + mix64(key) % groups) % groups);
    return p;
}

// Sums at vertex 1: eq. (22)-(25), (34), (37), (38).
template <Facts F>
void start_sums(const Estimator& e, Walk& w, double cos_in, double distance2) {
    if constexpr (F.path_tracer) return;  // what vertex 1 stands for needs a light subpath
    if (w.transport == Transport::radiance) {
        const double pdf_a = w.pdf_fwd_w * cos_in / distance2;
        for_each_exponent<F>(e, [&](const auto& h, int i) {
            w.vertex.mis[i] = mis::start_camera(h, double(e.light_subpaths), pdf_a);
        });
        return;
    }
    mis::LightStart l;
    l.pdf_origin = w.light_pdfs.origin;
    l.pdf_a = w.light_pdfs.leave * cos_in / (w.infinite_light ? 1 : distance2);
    l.g_light = w.infinite_light ? 1 : w.cos_previous / distance2;
    l.next_event_ratio = next_event_ratio(
        *e.scene, w.light,
        {w.vertex.position, static_cast<float>(w.cos_previous), static_cast<float>(distance2)});
    w.light_pdfs.next_event = static_cast<float>(w.light_pdfs.origin * l.next_event_ratio);
    for_each_exponent<F>(e, [&](const auto& h, int i) {
        l.hittable = w.hittable_light && e.weighed[i].emitter_hit;
        w.vertex.mis[i] = mis::start_light(h, l);
    });
}

template <Facts F>
void advance_sums(const Estimator& e, Walk& w, double g_fwd, double g_rev) {
    mis::Step step{w.pdf_fwd_w * g_fwd, g_rev, w.pdf_rev_w, w.delta, 1};
    const Strategy previous = previous_strategy(w.transport, w.index);
    const bool first = previous_is_first(w.rough, w.index);
    for_each_exponent<F>(e, [&](const auto& h, int i) {
        if constexpr (F.path_tracer) {
            w.vertex.mis[i] = mis::path_tracer::advance(h, step.pdf_fwd_a, step.delta);
        } else {
            step.n = e.count(previous, i, first);
            w.vertex.mis[i] = mis::advance(h, w.vertex.mis[i], step);
        }
    });
}

}  // namespace

SampleKey camera_key(const Estimator& e, int x, int y, std::uint64_t pass) {
    const std::uint64_t place = (std::uint64_t(std::uint32_t(y)) << 32) | std::uint32_t(x);
    return make_key(e, camera_stream, pass, place, pass >> 1);
}

SampleKey light_key(const Estimator& e, std::uint64_t subpath, std::uint64_t pass) {
    return make_key(e, light_stream, pass, 0, (pass >> 1) * e.light_subpaths + subpath);
}

std::uint64_t paired_subpath(const Estimator& e, int x, int y, std::uint64_t pass) {
    const PixelGroup g = group_of(e.crop, x, y);
    return paired_subpaths(e, g, pass)[static_cast<size_t>(g.place_of(x))];
}

PixelGroup group_at(const PixelRect& crop, int n, int y) {
    const int column = n * group_pixels, run = column / run_pixels * run_pixels;
    constexpr int step = run_pixels / group_pixels;
    if (run + run_pixels <= crop.width())
        return {crop.x0 + run + (column - run) / group_pixels, y, step, group_pixels};
    return {crop.x0 + column, y, 1, std::min(group_pixels, crop.width() - column)};
}

std::array<std::uint64_t, group_pixels> paired_subpaths(const Estimator& e, const PixelGroup& g,
                                                        std::uint64_t pass) {
    // In the order of the pixels, neighbours and successive passes would meet subpaths from the
    // same strata; a permutation of its own for every pass leaves no pattern.
    e.at(Work::sampling);
    // Pixels are counted as groups have them.
    const int count = g.count;
    const std::uint64_t pixel = std::uint64_t(g.y - e.crop.y0) * e.crop.width() +
                                std::uint64_t(group_number(e.crop, g.x0)) * group_pixels;
    const auto pixels = static_cast<std::uint64_t>(e.crop.area());
    const auto key = [&](std::uint64_t p) { return hash_combine(e.seed, 0x70616972 + p); };
    std::array<std::uint64_t, group_pixels> numbers{};
    if (e.light_subpaths >= pixels) {
        PermutedGroup group = permute_group(pixel, pixels, key(pass));
        for (int i = 0; i < count; ++i) {
            if (i > 0 && (pixel + i) % group_pixels == 0)
                group = permute_group(pixel + i, pixels, key(pass));
            numbers[i] = group(pixel + i);
        }
        return numbers;
    }
    // Fewer subpaths than pixels go round among all of them before the next permutation, in even
    // and in odd passes apart: the halves of the film stay independent. The permutation turned by
    // chance gives every pixel exactly the same chance.
    const std::uint64_t turns = pixels / e.light_subpaths;
    const std::uint64_t round = (pass >> 1) / turns, turn = (pass >> 1) % turns;
    const std::uint64_t k = key(2 * round + (pass & 1));
    const std::uint64_t shift = turn * e.light_subpaths + mix64(k) % pixels;
    for (int i = 0; i < count; ++i)
        numbers[i] = (permute_index(pixel + i, pixels, k) + shift) % pixels;
    return numbers;
}

Walk start_camera_walk(const Estimator& e, int x, int y, std::uint64_t pass) {
    Walk w;
    w.transport = Transport::radiance;
    w.roulette_start = e.roulette.start;
    w.roulette_reference = e.roulette.camera_sure;
    e.at(Work::sampling);
    w.key = camera_key(e, x, y, pass);
    const vec4 u = sample_4d(w.key, 0);
    e.at(Work::shading);
    const vec2 film = vec2(x + 0.5f, y + 0.5f) + sample_filter(e.filter, {u.x, u.y});
    w.ray.origin = lens_point(e.camera, {u.z, u.w});
    w.ray.direction = camera_direction(e.camera, w.ray.origin, film);
    w.previous_position = w.ray.origin;
    w.pdf_fwd_w = camera_pdf_w(e.camera, glm::dot(w.ray.direction, e.camera.forward));
    return w;
}

std::optional<Walk> start_light_walk(const Estimator& e, std::uint64_t subpath,
                                     std::uint64_t pass) {
    std::optional<Walk> walk;
    e.at(Work::sampling);
    const SampleKey key = light_key(e, subpath, pass);
    const auto [u, more] = sample_4d_pair(key, 0);
    const double pick = fine_number(more.x, more.y);
    e.at(Work::shading);
    const std::optional<EmissionSample> s =
        sample_emission(*e.scene, {pick, {u.x, u.y}, {u.z, u.w}});
    if (!s) return walk;
    Walk& w = walk.emplace();
    w.transport = Transport::importance;
    w.roulette_start = e.roulette.start;
    w.key = key;
    const LightKind kind = e.scene->lights[s->light].kind;
    w.ray.origin = kind == LightKind::area
                       ? offset_origin(s->position, s->normal, s->error, s->direction)
                       : s->position;
    w.ray.direction = s->direction;
    w.previous_position = s->position;
    w.throughput = s->weight;
    w.roulette_reference = max_component(s->weight);
    w.cos_previous = s->cos_theta;
    w.light = s->light;
    w.light_pdfs = s->pdfs;
    w.infinite_light = is_infinite(kind);
    w.hittable_light = !is_delta(kind);
    return walk;
}

template <Facts F>
Reached extend(const Estimator& e, Walk& w) {
    e.at(Work::rays);
    // Where all is opaque nobody looks at the coin.
    const std::uint64_t toss = e.scene->has_transparency ? walk_coin(w.key, w.index) : 0;
    const TriangleHit hit = e.scene->accel->closest(w.ray, {e.scene}, toss);
    e.at(Work::shading);
    build_at(w.point, [&] { return surface_at(*e.scene, hit); });
    ++w.index;
    if (!w.point) {
        if (w.transport == Transport::importance) return Reached::sky;  // nothing will be weighed
        e.at(Work::weights);
        if (w.index == 1)
            start_sums<F>(e, w, 1, 1);
        else
            advance_sums<F>(e, w, 1, w.cos_previous);
        return Reached::sky;
    }
    const SurfacePoint& p = *w.point;
    const vec3 back = w.previous_position - p.position;
    const double distance2 = length_squared(back);
    // Two surfaces that touch within rounding: there is no edge to walk.
    if (!(distance2 > 0)) return Reached::nothing;
    PathVertex& v = w.vertex;
    v.position = p.position;
    v.error = p.error;
    v.ng = p.shading.ng;
    // From an infinitely far light the edge has the direction of the ray, wherever the disc lies.
    v.to_previous = w.infinite_light && w.index == 1
                        ? -w.ray.direction
                        : back / static_cast<float>(std::sqrt(distance2));
    v.throughput = w.throughput;
    build_at(v.bsdf,
             [&] { return make_bsdf(material_at(*e.scene, p), e.scene->textures, p.shading); });
    v.index = w.index;
    v.rough = w.rough;
    v.connectible = v.bsdf.connectible();
    const double cos_in = abs_dot(v.ng, v.to_previous);
    if (!(cos_in > 0)) return Reached::nothing;
    e.at(Work::weights);
    if (w.index == 1)
        start_sums<F>(e, w, cos_in, distance2);
    else
        advance_sums<F>(e, w, cos_in / distance2, w.cos_previous / distance2);
    e.at(Work::sampling);
    const auto u = sample_4d_pair(w.key, 2 + 2 * static_cast<std::uint32_t>(w.index));
    w.numbers = {u[0], u[1]};
    e.at(Work::shading);
    return Reached::surface;
}

template decltype(extend<no_facts>) extend<no_facts>;
template decltype(extend<power2_facts>) extend<power2_facts>;
template decltype(extend<path_tracer_facts>) extend<path_tracer_facts>;

bool scatter(Walk& w) {
    const PathVertex& v = w.vertex;
    const vec4& u = w.numbers.scatter;
    const std::optional<BsdfSample> s = sample_bsdf(v.bsdf, v.to_previous, vec3(u), w.transport);
    if (!s) return false;
    w.throughput *= s->weight;
    // Refraction scales radiance until the path leaves the glass again; survival ignores that.
    w.roulette_reference *= s->eta_scale;
    if (w.index >= w.roulette_start) {
        const float survival = max_component(w.throughput) / w.roulette_reference;
        if (survival < 1) {
            if (!(u.w < survival)) return false;
            w.throughput /= survival;
        }
    }
    w.ray.origin = offset_origin(v.position, v.ng, v.error, s->to);
    w.ray.direction = s->to;
    w.previous_position = v.position;
    w.pdf_fwd_w = s->pdf_fwd_w;
    w.pdf_rev_w = s->pdf_rev_w;
    w.cos_previous = abs_dot(v.ng, s->to);
    w.delta = s->delta;
    const bool from_camera = w.transport == Transport::radiance;
    if (from_camera && w.rough == 0 && !s->delta) w.rough = w.index;
    return true;
}

}  // namespace midway
