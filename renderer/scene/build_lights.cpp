#include "scene/build_lights.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "scene/reach.h"

namespace midway {
namespace {

constexpr double pi_d = 3.14159265358979323846;
// The share of next event's picks that is spread evenly, so that a weak lamp close by is found.
constexpr double even_share = 0.2;
// The share of the material's own emission that a triangle's mean has at least, so that it stays
// positive wherever a texel between the probes may shine.
constexpr double least_mean = 1e-3;

double mean(const vec3& c) { return (double(c.x) + c.y + c.z) / 3; }

// Mean over each triangle of what textures and coverage leave of the emission.
EmissionMeans emission_means(const Scene& s, const Object& o, int object) {
    const Material& m = s.materials[o.material];
    constexpr int n = 6;
    std::vector<vec3> means;
    means.reserve(o.triangles.size());
    for (size_t t = 0; t < o.triangles.size(); ++t) {
        dvec3 sum(0);
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                const TriangleHit at{object, static_cast<int>(t), (i + 1 / 3.0f) / n,
                                     (j + 1 / 3.0f) / n};
                const ShadingPoint p = surface_point(o, at).shading;
                const vec4 texel =
                    sample_texture(s.textures, m.emission_texture, p, ColorSpace::srgb);
                sum += dvec3(vec3(texel)) * double(material_alpha(m, s.textures, p));
            }
        means.push_back(vec3(sum / (n * (n + 1) / 2.0)));
    }
    return std::make_shared<const std::vector<vec3>>(std::move(means));
}

bool same_means(const Material& a, const Material& b) {
    return a.emission_texture == b.emission_texture && a.alpha_mode == b.alpha_mode &&
           a.alpha == b.alpha && a.alpha_cutoff == b.alpha_cutoff &&
           a.base_color_texture == b.base_color_texture;
}

// Keeps the means of objects that are dark by now too: they may be switched on again.
void find_emission_means(Scene& s, const Scene* previous) {
    s.emission_means.resize(s.geometry->objects.size());
    const bool share =
        previous && previous->geometry == s.geometry && previous->textures == s.textures;
    for (size_t k = 0; k < s.geometry->objects.size(); ++k) {
        const Object& o = s.geometry->objects[k];
        const Material& m = s.materials[o.material];
        if (!m.emission_texture.used() && !o.may_be_transparent) continue;
        if (share && same_means(m, previous->materials[o.material]))
            s.emission_means[k] = previous->emission_means[k];
        if (mean(m.emission) > 0 && !s.emission_means[k])
            s.emission_means[k] = emission_means(s, o, static_cast<int>(k));
    }
}

double mean_emission(const Material& m, const EmissionMeans& means, size_t triangle) {
    if (!means) return mean(m.emission);
    return mean(m.emission * (*means)[triangle]) + least_mean * mean(m.emission);
}

void add_area_lights(Scene& s) {
    s.first_light.assign(s.geometry->objects.size(), -1);
    for (size_t k = 0; k < s.geometry->objects.size(); ++k) {
        const Object& o = s.geometry->objects[k];
        const Material& m = s.materials[o.material];
        if (!(mean(m.emission) > 0)) continue;
        s.first_light[k] = static_cast<int>(s.lights.size());
        for (size_t t = 0; t < o.triangles.size(); ++t) {
            const TriangleShape shape = triangle_shape(o, static_cast<int>(t));
            Light l;
            l.kind = LightKind::area;
            l.object = static_cast<int>(k);
            l.triangle = static_cast<int>(t);
            l.area = shape.area;
            const uvec3& v = o.triangles[t];
            l.position = (o.positions[v.x] + o.positions[v.y] + o.positions[v.z]) / 3.0f;
            l.two_sided = m.double_sided;
            l.power = pi_d * shape.area * (l.two_sided ? 2 : 1) *
                      mean_emission(m, s.emission_means[k], t);
            s.lights.push_back(l);
        }
    }
}

// Area lights, and the triangles that they are.
void find_lamps(Scene& s, const Scene* previous) {
    add_area_lights(s);
    const bool share =
        previous && previous->geometry == s.geometry && previous->first_light == s.first_light;
    s.lamps = share ? previous->lamps : make_lamps(*s.geometry, s.lights);
    for (size_t i = 0; i < s.lamps->size(); ++i) {
        if ((*s.lamps)[i].partner <= 0) continue;
        // Both lie about the centre of their parallelogram.
        const vec3 corners = (*s.lamps)[i].shape.v0 + (*s.lamps)[i + 1].shape.v0;
        s.lights[i].position = s.lights[i + 1].position = 0.5f * corners;
    }
}

Light make_punctual(const PunctualLight& d, const Scene& s, float lamp_strength) {
    const Normalisation& n = s.geometry->normalisation;
    Light l;
    const vec3 color = d.color * (d.intensity * lamp_strength);
    l.direction = vec3(-glm::normalize(dvec3(d.to_world[2])));
    if (d.kind == PunctualKind::directional) {
        l.kind = LightKind::directional;
        l.emission = color;
        l.power = mean(color) * pi_d * s.radius * s.radius;
        return l;
    }
    l.position = vec3((dvec3(d.to_world[3]) - n.center) * n.scale);
    // Irradiance is intensity over distance squared, and distances are scaled.
    l.emission = vec3(dvec3(color) * (n.scale * n.scale));
    l.kind = d.kind == PunctualKind::spot ? LightKind::spot : LightKind::point;
    double solid_angle = 4 * pi_d;
    if (d.kind == PunctualKind::spot) {
        l.cos_inner = std::cos(d.inner_cone_angle);
        l.cos_outer = std::cos(d.outer_cone_angle);
        solid_angle = 2 * pi_d * ((1.0 - l.cos_inner) + (double(l.cos_inner) - l.cos_outer) / 3);
    }
    l.power = mean(l.emission) * solid_angle;
    return l;
}

// `needless`: a black one is a light too, which nothing picks.
void add_sky(Scene& s, const SkyDescription& d, const Sky* previous, bool needless) {
    s.sky = make_sky(d, previous);
    if (!(s.sky->mean_radiance > 0) && !needless) return;
    Light l;
    l.kind = LightKind::sky;
    l.power = 4 * pi_d * s.sky->mean_radiance * pi_d * s.radius * s.radius;
    s.sky_light = static_cast<int>(s.lights.size());
    s.lights.push_back(l);
}

LightBounds bounds_of(const Scene& s, int light) {
    const Light& l = s.lights[light];
    if (l.kind == LightKind::point) return {l.position, l.position};
    if (l.kind == LightKind::spot) return {l.position, l.position, l.direction, false};
    const Object& o = s.geometry->objects[l.object];
    const uvec3& t = o.triangles[l.triangle];
    const vec3 &a = o.positions[t.x], &b = o.positions[t.y], &c = o.positions[t.z];
    LightBounds bounds{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)),
                       triangle_shape(o, l.triangle).normal, l.two_sided};
    if ((*s.lamps)[light].partner > 0) {
        const vec3 corner = (*s.lamps)[light + 1].shape.v0;
        bounds.lower = glm::min(bounds.lower, corner);
        bounds.upper = glm::max(bounds.upper, corner);
    }
    return bounds;
}

// Whether the same lights shine at the same places, however strongly: then they reach the same
// surfaces, and the tree over them has the same shape.
bool same_places(const Scene& a, const Scene& b) {
    const auto same = [](const Light& x, const Light& y) {
        return x.kind == y.kind && x.object == y.object && x.triangle == y.triangle &&
               x.two_sided == y.two_sided && (x.power > 0) == (y.power > 0) &&
               x.position == y.position && x.direction == y.direction && x.cos_outer == y.cos_outer;
    };
    return a.geometry == b.geometry &&
           std::equal(a.lights.begin(), a.lights.end(), b.lights.begin(), b.lights.end(), same);
}

// The first triangle of a parallelogram is picked for both.
void join_parallelograms(const Scene& s, std::vector<double>& weights) {
    for (size_t i = 0; i < s.lamps->size(); ++i)
        if ((*s.lamps)[i].partner > 0) weights[i] += std::exchange(weights[i + 1], 0.0);
}

// `weights`: of next event, for each light. `previous`: of the same shape, or null.
void make_light_tree(Scene& s, std::vector<double> weights, const Scene* previous) {
    std::vector<double> groups{0};
    for (size_t i = 0; i < s.lights.size(); ++i) {
        if (is_infinite(s.lights[i].kind)) {
            s.infinite_lights.push_back(static_cast<int>(i));
            groups.push_back(std::exchange(weights[i], 0.0));
        } else {
            groups[0] += weights[i];
        }
    }
    s.next_event_group = make_distribution(groups);
    if (previous) {
        s.light_tree = previous->light_tree;
        return s.light_tree.reweigh(weights);
    }
    std::vector<LightBounds> bounds(s.lights.size());
    for (size_t i = 0; i < bounds.size(); ++i)
        if (weights[i] > 0) bounds[i] = bounds_of(s, static_cast<int>(i));
    s.light_tree.build(bounds, weights);
}

// `black_too`: black lights are picked as if each had the mean power.
void make_light_tables(Scene& s, const Scene* previous, bool black_too) {
    std::vector<double> power, next_event;
    power.reserve(s.lights.size());
    next_event.reserve(s.lights.size());
    size_t shining = 0;
    double picked = 0;
    for (const Light& l : s.lights) {
        power.push_back(l.reaches ? l.power : 0);
        s.total_power += l.power;
        picked += power.back();
        shining += power.back() > 0;
        if (l.reaches) continue;
        ++s.unreached_lights;
        s.unreached_power += l.power;
    }
    if (!std::isfinite(s.total_power))
        throw std::runtime_error(
            "the lights' power is not finite (emission or intensity); use smaller numbers");
    if (black_too && shining > 0) {
        const double mean_power = picked / double(shining);
        for (size_t i = 0; i < power.size(); ++i)
            if (!(s.lights[i].power > 0)) power[i] = mean_power, picked += mean_power, ++shining;
    }
    // From the short list: the lights themselves are many times as large.
    for (const double p : power)
        next_event.push_back(p > 0 ? (1 - even_share) * p / picked + even_share / double(shining)
                                   : 0.0);
    join_parallelograms(s, power);
    join_parallelograms(s, next_event);
    s.emission_pick = make_distribution(power);
    for (size_t i = 0; i < s.lights.size(); ++i) {
        const auto light = static_cast<int>(i);
        s.lights[i].emission_pick = share_of_lamp(*s.lamps, light) *
                                    s.emission_pick.probability(first_of_lamp(*s.lamps, light));
    }
    make_light_tree(s, std::move(next_event), previous);
}

// An object that shines is one lamp, of however many triangles.
double same_lamp_probability(const Scene& s) {
    double sum = 0, lamp = 0;
    for (size_t i = 0; i < s.lights.size(); ++i) {
        lamp += s.lights[i].emission_pick;
        const bool goes_on = s.lights[i].kind == LightKind::area && i + 1 < s.lights.size() &&
                             s.lights[i + 1].object == s.lights[i].object;
        if (goes_on) continue;
        sum += sqr(lamp);
        lamp = 0;
    }
    return sum;
}

size_t count_lights(const Scene& s, const SceneDescription& d) {
    size_t count = d.lights.size() + 1;
    for (const Object& o : s.geometry->objects)
        if (mean(s.materials[o.material].emission) > 0) count += o.triangles.size();
    return count;
}

}  // namespace

void build_lights(Scene& s, const SceneDescription& d, const BuildOptions& options) {
    const Scene* previous = options.previous;
    for (Material& m : s.materials) m.emission *= d.lamp_strength;
    s.lights.reserve(count_lights(s, d));
    find_emission_means(s, previous);
    find_lamps(s, previous);
    for (const PunctualLight& l : d.lights)
        s.lights.push_back(make_punctual(l, s, d.lamp_strength));
    const Sky* const previous_sky = previous && previous->sky ? &*previous->sky : nullptr;
    if (d.sky) {
        add_sky(s, *d.sky, previous_sky, options.needless.sky);
    } else if (options.needless.sky) {
        SkyDescription black = default_sky();
        black.strength = 0;
        add_sky(s, black, nullptr, true);
    }
    const bool black_too = options.needless.black_lights;
    const bool same = previous && !options.needless.lights && same_places(*previous, s);
    if (same) {
        for (size_t i = 0; i < s.lights.size(); ++i)
            s.lights[i].reaches = previous->lights[i].reaches;
    } else if (!options.needless.lights) {
        find_reach(s);
    }
    for (size_t i = 0; i < s.lamps->size(); ++i)
        if ((*s.lamps)[i].partner > 0)
            s.lights[i].reaches = s.lights[i + 1].reaches |= s.lights[i].reaches;
    make_light_tables(s, same && !black_too ? previous : nullptr, black_too);
    if (s.emission_pick.total > 0) s.same_lamp = same_lamp_probability(s);
}

}  // namespace midway
