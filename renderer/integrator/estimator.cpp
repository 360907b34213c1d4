#include "integrator/estimator.h"

#include "integrator/edge.h"

namespace midway {
namespace {

// Fills the weights; `weigh` is called with the heuristic of each exponent.
template <Facts F, class Weigh>
void fill_weights(const Estimator& e, Contribution& c, const Weigh& weigh) {
    for_each_exponent<F>(e, [&](const auto& h, int i) { c.weights[i] = weigh(h, i); });
}

template <Facts F>
bool no_weight(const Estimator& e, const Contribution& c) {
    // A weight that is not a number goes on, to be counted. Bare estimates lose nothing: a weight
    // below double's range belongs to a path that its strategy draws less than once in 1e9 samples
    // (densities 1e9 apart for exponent 32, 1e38 for 8).
    for (int i = 0; i < exponent_count<F>(e); ++i)
        if (c.weights[i] != 0) return false;
    return true;
}

// Whether anything of a contribution arrives over its edge; `seen` traces the edge's ray.
template <class Seen>
bool arrives(const Estimator& e, Contribution& c, RayCounts& rays, const Seen& seen) {
    rays.count_shadow(c.strategy);
    e.at(Work::rays);
    const float part = seen();
    e.at(Work::other);
    c.value *= part;
    return part > 0;
}

// Whether the ray need not be traced to know that nothing arrives.
template <Facts F>
bool is_nothing(const Estimator& e, const Contribution& c) {
    return is_black(c.value) || no_weight<F>(e, c);
}

// n of the strategy that moves the connecting edge one step towards the camera (or the light);
// where a vertex or a light forbids it, the sums are zero.
mis::Side towards_camera(const Estimator& e, const PathVertex& v, const Strategy& k, int exponent,
                         mis::Side side) {
    side.n = e.count({k.s - 1, k.t + 1}, exponent, v.rough == v.index - 1);
    return side;
}
// Seen from the camera the light's last vertex follows a rough one, but for light tracing's.
mis::Side towards_light(const Estimator& e, const Strategy& k, int exponent, mis::Side side) {
    side.n = e.count({k.s + 1, k.t - 1}, exponent, k.s == 1);
    return side;
}

}  // namespace

template <Facts F>
std::optional<Contribution> hit_light(const Estimator& e, const Walk& w, Reached reached) {
    e.at(Work::shading);
    std::optional<Contribution> found;
    if (reached == Reached::nothing) return found;
    const Strategy k{w.index + 1, 0};
    if (!e.families.emitter_hit && !(k.s == 2 && e.direct_lamps)) return found;
    const std::optional<EmitterHit> hit =
        reached == Reached::sky
            ? sky_hit(*e.scene, w.ray.direction)
            : emitter_hit(*e.scene, *w.point, w.vertex.to_previous, w.previous_position);
    if (hit) found = weigh_hit<F>(e, *hit, k, w.throughput, w.vertex.mis.data());
    return found;
}

template <Facts F>
Contribution weigh_hit(const Estimator& e, const EmitterHit& hit, const Strategy& k,
                       const vec3& throughput, const mis::State* sums) {
    Contribution c;
    c.strategy = k;
    c.value = throughput * hit.radiance;
    // (1,1) is not a strategy: a lamp seen directly has emitter hits alone.
    // On a path of two edges light tracing is all that the sum of emission's density stands for.
    mis::EmitterHitPdfs pdfs{hit.pdfs.origin * e.share_of(k.edges()), hit.pdfs.leave,
                             double(hit.pdfs.next_event) * e.next_events(k.edges()), true};
    e.at(Work::weights);
    fill_weights<F>(e, c, [&](const auto& h, int i) {
        pdfs.next_event_feasible = e.weighed[i].next_event;
        if (k.s == 2) return 1.0;
        if constexpr (F.path_tracer) return mis::path_tracer::emitter_hit(h, sums[i], pdfs);
        return mis::emitter_hit(h, sums[i], pdfs);
    });
    return c;
}

template <Facts F>
std::optional<Contribution> connect_to_light(const Estimator& e, const PathVertex& v, const vec4& u,
                                             RayCounts& rays) {
    e.at(Work::shading);
    std::optional<Contribution> found;
    const std::optional<NextEventSample> n =
        sample_next_event(*e.scene, v.position, next_event_numbers(u));
    if (!n) return found;
    const BsdfEval f = eval_bsdf(v.bsdf, v.to_previous, n->direction, Transport::radiance);
    if (is_black(f.f)) return found;
    const LightKind kind = e.scene->lights[n->light].kind;
    const double cos_v = abs_dot(v.ng, n->direction);
    Contribution& c = found.emplace();
    c.strategy = {v.index + 1, 1};
    const int count = e.next_events(c.strategy.edges());
    c.value = v.throughput * f.f * n->value * static_cast<float>(cos_v / count);

    const double g_light = n->cos_theta / double(n->distance_squared);  // 1 at infinity
    // As in hit_light(): towards the camera a path of two edges has light tracing alone.
    const mis::Side side{
        n->pdfs.leave * cos_v / n->distance_squared * e.share_of(c.strategy.edges()), f.pdf_rev_w};
    mis::NextEventPdfs pdfs{double(n->pdfs.next_event) * count, n->pdfs.origin,
                            f.pdf_fwd_w * g_light};
    e.at(Work::weights);
    fill_weights<F>(e, c, [&](const auto& h, int i) {
        pdfs.hit_feasible = !is_delta(kind) && e.weighed[i].emitter_hit;
        if constexpr (F.path_tracer) return mis::path_tracer::next_event(h, pdfs);
        return mis::next_event(h, v.mis[i], towards_camera(e, v, c.strategy, i, side), pdfs);
    });
    const auto seen = [&] {
        const vec3 from = leave(v, n->direction);
        if (is_infinite(kind)) return visibility_to_infinity(*e.scene, from, n->direction);
        return visibility(*e.scene, from, offset_end(n->target, n->normal, n->error, v.position));
    };
    if (is_nothing<F>(e, c) || !arrives(e, c, rays, seen)) found.reset();
    return found;
}

template <Facts F>
void offer_connection(const Estimator& e, const PathVertex& v, const PathVertex& l, int count,
                      int place, ConnectionChoice& choice) {
    e.at(Work::shading);
    const vec3 d = l.position - v.position;
    const double distance2 = length_squared(d);
    if (!(distance2 > 0)) return;
    const vec3 direction = d / static_cast<float>(std::sqrt(distance2));
    if (!may_scatter(v.bsdf, v.to_previous, direction) ||
        !may_scatter(l.bsdf, l.to_previous, -direction))
        return;
    const BsdfEval fv = eval_bsdf(v.bsdf, v.to_previous, direction, Transport::radiance);
    if (is_black(fv.f)) return;
    const BsdfEval fl = eval_bsdf(l.bsdf, l.to_previous, -direction, Transport::importance);
    if (is_black(fl.f)) return;
    const double cos_v = abs_dot(v.ng, direction), near = 1 / distance2;
    const double g_v = cos_v * near, g_l = abs_dot(l.ng, direction) * near;
    Contribution c;
    c.strategy = {v.index + 1, l.index + 1};
    c.value = v.throughput * fv.f * fl.f * l.throughput *
              static_cast<float>(cos_v * g_l * (1 / (e.connection_share * count)));

    const mis::Side camera{fl.pdf_fwd_w * g_v, fv.pdf_rev_w};
    const mis::Side light{fv.pdf_fwd_w * g_l, fl.pdf_rev_w};
    const double n = e.connections(v.rough == 0);
    e.at(Work::weights);
    fill_weights<F>(e, c, [&](const auto& h, int i) {
        return mis::connection(h, v.mis[i], towards_camera(e, v, c.strategy, i, camera), l.mis[i],
                               towards_light(e, c.strategy, i, light), n);
    });
    if (!choice.among.offer(importance_of(c.value, c.weights[e.deciding]))) return;
    choice.contribution = c;
    choice.light = &l;
    choice.place = place;
}

std::optional<Contribution> connect(const Estimator& e, const PathVertex& v,
                                    const ConnectionChoice& choice, RayCounts& rays) {
    std::optional<Contribution> found = choice.contribution;
    const double factor = choice.among.factor();
    found->value *= static_cast<float>(factor);
    found->probability = 1 / factor;
    const auto seen = [&] { return edge_visibility(*e.scene, v, *choice.light); };
    if (is_nothing<no_facts>(e, *found) || !arrives(e, *found, rays, seen)) found.reset();
    return found;
}

template <Facts F>
std::optional<Splat> connect_to_camera(const Estimator& e, const PathVertex& l, const vec4& u,
                                       RayCounts& rays) {
    e.at(Work::shading);
    std::optional<Splat> splat;
    const vec3 lens = lens_point(e.camera, {u.x, u.y});
    const vec3 d = lens - l.position;
    const double distance2 = length_squared(d);
    if (!(distance2 > 0)) return splat;
    const vec3 direction = d / static_cast<float>(std::sqrt(distance2));
    if (!may_scatter(l.bsdf, l.to_previous, direction)) return splat;
    const std::optional<vec2> film = film_position(e.camera, lens, -direction);
    if (!film) return splat;
    const SplatPixel pixel = choose_splat_pixel(e.filter, *film, {u.z, u.w});
    if (!(pixel.factor > 0) || !e.crop.contains(pixel.x, pixel.y)) return splat;
    const BsdfEval f = eval_bsdf(l.bsdf, l.to_previous, direction, Transport::importance);
    if (is_black(f.f)) return splat;
    const double cos_l = abs_dot(l.ng, direction);
    // Density per area at the vertex of one camera sample per pixel area: also the importance.
    const double pdf_a =
        camera_pdf_w(e.camera, -glm::dot(direction, e.camera.forward)) * cos_l / distance2;
    Splat& s = splat.emplace();
    s.x = pixel.x;
    s.y = pixel.y;
    Contribution& c = s.contribution;
    c.strategy = {1, l.index + 1};
    c.value =
        l.throughput * f.f * static_cast<float>(pdf_a * pixel.factor / double(e.light_subpaths));
    const mis::Side side{pdf_a, f.pdf_rev_w};
    e.at(Work::weights);
    fill_weights<F>(e, c, [&](const auto& h, int i) {
        return mis::light_tracing(h, l.mis[i], towards_light(e, c.strategy, i, side),
                                  double(e.light_subpaths) * e.share_of(c.strategy.edges()));
    });
    const auto seen = [&] { return edge_visibility(*e.scene, l, lens); };
    if (is_nothing<F>(e, c) || !arrives(e, c, rays, seen)) splat.reset();
    return splat;
}

// The instances; a path tracer connects nothing to light subpaths.
template decltype(hit_light<no_facts>) hit_light<no_facts>;
template decltype(hit_light<power2_facts>) hit_light<power2_facts>;
template decltype(hit_light<path_tracer_facts>) hit_light<path_tracer_facts>;
template decltype(weigh_hit<power2_facts>) weigh_hit<power2_facts>;
template decltype(weigh_hit<path_tracer_facts>) weigh_hit<path_tracer_facts>;
template decltype(connect_to_light<no_facts>) connect_to_light<no_facts>;
template decltype(connect_to_light<power2_facts>) connect_to_light<power2_facts>;
template decltype(connect_to_light<path_tracer_facts>) connect_to_light<path_tracer_facts>;
template decltype(offer_connection<no_facts>) offer_connection<no_facts>;
template decltype(offer_connection<power2_facts>) offer_connection<power2_facts>;
template decltype(connect_to_camera<no_facts>) connect_to_camera<no_facts>;
template decltype(connect_to_camera<power2_facts>) connect_to_camera<power2_facts>;

}  // namespace midway
