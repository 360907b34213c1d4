#include "report/whole_path_recursion.h"

namespace midway {
namespace {

bool has(const PathSetting& setting, const Strategy& k) {
    return setting.families.has(family_of(k));
}

// n as mis.h wants it beside a vcm. `first`: the strategy's last camera vertex is the first rough
// surface.
double count(const PathSetting& setting, const Strategy& k, bool first) {
    if (!has(setting, k)) return 0;
    if (k.t == 1) return next_event_count(setting, k.edges());
    return k.s >= 2 && k.t >= 2 ? connection_count(setting, first) : 1;
}

// Sums at the vertices of the camera's subpath; element i belongs to vertex i.
template <class H>
std::vector<mis::State> camera_states(const H& h, const PathPdfs& p, const PathSetting& setting) {
    const int last = p.edges();
    std::vector<mis::State> states(last + 1);
    states[1] = mis::start_camera(h, setting.light_subpaths, p.from_camera(1));
    for (int i = 2; i <= last; ++i)
        states[i] = mis::advance(h, states[i - 1],
                                 {p.from_camera(i), p.vertices[i - 1].light_g,
                                  p.vertices[i - 2].light_w, p.vertices[i - 1].delta,
                                  count(setting, {i - 1, 2}, i > 2 && is_first_rough(p, i - 2))});
    return states;
}

// The same from the light; element j belongs to vertex k - j.
template <class H>
std::vector<mis::State> light_states(const H& h, const PathPdfs& p, const PathSetting& setting) {
    const int last = p.edges();
    std::vector<mis::State> states(last);
    mis::LightStart start;
    start.pdf_origin = p.emission;
    start.pdf_a = p.from_light(last - 1);
    start.g_light = p.vertices[last].camera_g;
    start.next_event_ratio = p.next_event / p.emission;
    start.hittable = p.hittable && setting.families.emitter_hit;
    states[1] = mis::start_light(h, start);
    for (int j = 2; j < last; ++j) {
        const int i = last - j;
        states[j] =
            mis::advance(h, states[j - 1],
                         {p.from_light(i), p.vertices[i + 1].camera_g, p.vertices[i + 2].camera_w,
                          p.vertices[i + 1].delta, count(setting, {3, j - 1}, false)});
    }
    return states;
}

template <class H>
double weigh(const H& h, const PathPdfs& c, const PathPdfs& l, const PathSetting& setting,
             const Strategy& k, const std::vector<mis::State>& from_camera,
             const std::vector<mis::State>& from_light) {
    const int s = k.s;
    const double tracing = light_tracing_count(setting, k.edges());
    const double share = tracing / setting.light_subpaths;
    const double next_event = c.next_event * next_event_count(setting, k.edges());
    const mis::State camera = from_camera[s - 1];
    if (k.t == 0)
        return mis::emitter_hit(h, camera,
                                {c.emission * share, c.vertices[s - 2].light_w, next_event,
                                 s > 2 && has(setting, {s - 1, 1})});
    const double towards_camera = l.vertices[s - 1].light_w * c.vertices[s - 1].light_g;
    const double towards_light = c.vertices[s].camera_w * c.vertices[s].camera_g;
    if (s == 1)
        return mis::light_tracing(
            h, from_light[k.t - 1],
            {towards_light, l.vertices[2].camera_w, count(setting, {2, k.t - 1}, true)}, tracing);
    const mis::Side camera_side{
        towards_camera * share, c.vertices[s - 2].light_w,
        count(setting, {s - 1, k.t + 1}, s > 2 && is_first_rough(c, s - 2))};
    if (k.t == 1)
        return mis::next_event(
            h, camera, camera_side,
            {next_event, c.emission, towards_light, c.hittable && setting.families.emitter_hit});
    const mis::Side light_side{towards_light, l.vertices[s + 1].camera_w,
                               count(setting, {s + 1, k.t - 1}, false)};
    return mis::connection(h, camera, camera_side, from_light[k.t - 1], light_side,
                           connection_count(setting, is_first_rough(c, s - 1)));
}

// A strategy that has no density at the path never asks for its weight.
bool can_draw(const PathPdfs& camera, const PathPdfs& light, const Strategy& k) {
    for (int i = 1; i < k.s; ++i)
        if (!(camera.from_camera(i) > 0)) return false;
    for (int i = k.s; i < camera.edges(); ++i)
        if (!(light.from_light(i) > 0)) return false;
    return true;
}

template <class Real>
std::vector<double> weights_in(const PathPdfs& camera, const PathPdfs& light,
                               const PathSetting& setting, double exponent) {
    const int last = camera.edges();
    return mis::with_heuristic<Real>(exponent, [&](const auto& h) {
        const std::vector<mis::State> from_camera = camera_states(h, camera, setting);
        const std::vector<mis::State> from_light = light_states(h, light, setting);
        std::vector<double> weights(last + 1, 0.0);
        for (int s = 1; s <= last + 1; ++s) {
            const Strategy k{s, last + 1 - s};
            if (is_feasible(camera, k, setting) && can_draw(camera, light, k))
                weights[s - 1] = weigh(h, camera, light, setting, k, from_camera, from_light);
        }
        return weights;
    });
}

}  // namespace

std::vector<double> recursive_weights(const PathPdfs& camera, const PathPdfs& light,
                                      const PathSetting& setting, double exponent) {
    return weights_in<double>(camera, light, setting, exponent);
}

std::vector<double> recursive_weights_in_float(const PathPdfs& pdfs, const PathSetting& setting,
                                               double exponent) {
    return weights_in<float>(pdfs, pdfs, setting, exponent);
}

}  // namespace midway
