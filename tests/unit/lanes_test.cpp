// Eight samples side by side (math/lanes.h and what is built on it) against each of them alone: the
// same bits, whatever the lanes beside hold. Everything is exact. Whole renders are compared by
// facts_test.cpp.
#include "math/lanes.h"

#include <gtest/gtest.h>

#include <random>

#include "integrator/mis.h"
#include "integrator/mis_lanes.h"
#include "math/float_mode.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "scene/light_lanes.h"
#include "scene/surface_lanes.h"
#include "support/agreement_scenes.h"
#include "support/bsdfs.h"
#include "support/rooms.h"

namespace midway::test {
namespace {

constexpr int rounds = 200;

struct Draw {
    std::mt19937 random{7};
    std::uniform_real_distribution<float> uniform{0, 1 - 0x1p-24f};

    // Corners and the middle come as often as the rest: they have ways of their own.
    float number() {
        const float u = uniform(random);
        if (u < 0.05f) return 0;
        if (u < 0.1f) return 0.5f;
        return u < 0.15f ? 1 - 0x1p-24f : uniform(random);
    }
    Float8 numbers() {
        Float8 x{};
        for (int k = 0; k < lane_count; ++k) x[k] = number();
        return x;
    }
    vec3 direction() { return square_to_sphere({uniform(random), uniform(random)}); }
    Vec3x8 directions() {
        Vec3x8 v{};
        for (int k = 0; k < lane_count; ++k) v.set(k, direction());
        return v;
    }
    Mask8 mask() {
        Mask8 m{};
        for (int k = 0; k < lane_count; ++k) m[k] = uniform(random) < 0.6f ? -1 : 0;
        return m;
    }
};

TEST(Lanes, TurnAndConvert) {
    const Float8 x{0, 1, 2, 3, 4, 5, 6, 7};
    for (int shift = 0; shift < lane_count; ++shift) {
        const Mask8 from = rotation(shift);
        const Float8 turned = rotate(x, from);
        const Double8 wide = rotate(to_double(x), from);
        for (int k = 0; k < lane_count; ++k) {
            EXPECT_EQ(turned[k], float((k + shift) % lane_count));
            EXPECT_EQ(wide[k], double((k + shift) % lane_count));
        }
    }
    const Mask8 odd = (Mask8{0, 1, 2, 3, 4, 5, 6, 7} & 1) == 1;
    EXPECT_EQ(bits(odd), 0xaau);
    const Double8 chosen = select(odd, to_double(x), all_lanes(-1.0));
    for (int k = 0; k < lane_count; ++k) EXPECT_EQ(chosen[k], k % 2 == 1 ? k : -1);
    EXPECT_EQ(bits(not_zero(select(odd, to_double(x), all_lanes(0.0)))), 0xaau);
    EXPECT_EQ(bits(not_zero(all_lanes(std::nan("")))), 0xffu);
    EXPECT_EQ(bits(is_finite(x / x)), 0xfeu);
    std::vector<int> visited;
    for_each_lane(odd, [&](int k) { visited.push_back(k); });
    EXPECT_EQ(visited, (std::vector<int>{1, 3, 5, 7}));
}

TEST(Lanes, DrawTheNumbersOfEachSample) {
    for (const SamplerKind kind : {SamplerKind::sobol, SamplerKind::independent})
        for (std::uint64_t index = 0; index < 3000; index += 37) {
            std::array<SampleKey, lane_count> keys;
            for (std::uint64_t k = 0; k < lane_count; ++k)
                keys[k] = make_sample_key(mix64(k), index * (k + 1), kind);
            const std::uint32_t group = 2 * static_cast<std::uint32_t>(index % 9);
            const NumberLanes u = sample_4d_pairs(keys, every_lane, group);
            for (int k = 0; k < lane_count; ++k) {
                const auto one = sample_4d_pair(keys[size_t(k)], group);
                for (int i = 0; i < 4; ++i) {
                    EXPECT_EQ(u.first[size_t(i)][k], one[0][i]);
                    EXPECT_EQ(u.second[size_t(i)][k], one[1][i]);
                }
            }
        }
}

TEST(Lanes, WarpAlike) {
    Draw draw;
    for (int round = 0; round < rounds; ++round) {
        const Float8 u = draw.numbers(), v = draw.numbers();
        const Vec3x8 cosine = square_to_cosine_hemisphere(u, v), n = draw.directions();
        const TrianglePlace<Float8> place = square_to_triangle(u, v);
        const Frame8 frames = frames_from_normals(n);
        for (int k = 0; k < lane_count; ++k) {
            EXPECT_EQ(cosine[k], square_to_cosine_hemisphere({u[k], v[k]}));
            EXPECT_EQ(vec2(place.b1[k], place.b2[k]), square_to_triangle(vec2(u[k], v[k])));
            const Frame f = frame_from_normal(n[k]);
            EXPECT_EQ(frames.s[k], f.s);
            EXPECT_EQ(frames.t[k], f.t);
            EXPECT_EQ(frames.to_world(cosine)[k], f.to_world(cosine[k]));
            EXPECT_EQ(normalize(cosine)[k], glm::normalize(cosine[k]));
            EXPECT_EQ(cross(n, cosine)[k], glm::cross(n[k], cosine[k]));
        }
    }
}

TEST(Lanes, CamerasLookAlike) {
    Draw draw;
    CameraDescription d;
    for (const double aperture : {0.0, 0.1}) {
        d.aperture_radius = aperture;
        d.focus_distance = 2;
        const Camera c = make_camera(d, {}, 31, 17);
        for (const FilterKind kind :
             {FilterKind::box, FilterKind::gaussian, FilterKind::blackman_harris}) {
            const PixelFilter filter = make_filter(kind);
            for (int round = 0; round < rounds; ++round) {
                const Float8 u = draw.numbers(), v = draw.numbers();
                const auto offsets = sample_filters(filter, u, v);
                const Vec3x8 lens = lens_points(c, every_lane, u, v);
                const Vec3x8 to = camera_directions(c, lens, 31.0f * v, 17.0f * u);
                const Float8 pdf_w = camera_pdf_w(c, dot(to, all_lanes(c.forward)));
                for (int k = 0; k < lane_count; ++k) {
                    EXPECT_EQ(vec2(offsets[0][k], offsets[1][k]),
                              sample_filter(filter, {u[k], v[k]}));
                    EXPECT_EQ(lens[k], lens_point(c, {u[k], v[k]}));
                    EXPECT_EQ(to[k], camera_direction(c, lens[k], {31.0f * v[k], 17.0f * u[k]}));
                    EXPECT_EQ(pdf_w[k], camera_pdf_w(c, glm::dot(to[k], c.forward)));
                }
            }
        }
    }
}

struct MixedBsdfs {
    BsdfLanes lanes{};
    std::array<Bsdf, lane_count> one;
};
// Diffuse ones, and one of every kind among them.
MixedBsdfs mix_bsdfs(const std::vector<NamedBsdf>& all, int round) {
    MixedBsdfs m;
    for (int k = 0; k < lane_count; ++k) {
        const size_t which = k % 3 == 0 ? size_t(round + k) % all.size() : size_t(k) % 2;
        const Bsdf& b = m.one[size_t(k)] = all[which].bsdf;
        m.lanes.ng.set(k, b.ng);
        m.lanes.normal.set(k, b.frame.n);
        m.lanes.diffuse.set(k, b.only_diffuse ? b.diffuse : vec3(0));
        m.lanes.others[k] = b.only_diffuse ? 0 : -1;
        m.lanes.other[size_t(k)] = &m.one[size_t(k)];
    }
    return m;
}

void expect_sample(const BsdfSample8& s, int k, const std::optional<BsdfSample>& one) {
    ASSERT_EQ(s.drawn[k] != 0, one.has_value());
    if (!one) return;
    EXPECT_EQ(s.to[k], one->to);
    EXPECT_EQ(s.weight[k], one->weight);
    EXPECT_EQ(s.pdf_fwd_w[k], one->pdf_fwd_w);
    EXPECT_EQ(s.pdf_rev_w[k], one->pdf_rev_w);
    EXPECT_EQ(s.eta_scale[k], one->eta_scale);
    EXPECT_EQ(s.delta[k] != 0, one->delta);
}

TEST(Lanes, SurfacesScatterAlike) {
    const ScopedFlushToZero flush;
    Draw draw;
    std::vector<NamedBsdf> all = every_bsdf();
    for (const NamedBsdf& b : smooth_bsdfs()) all.push_back(b);
    all.push_back({"black", bsdf_of(lambert(vec3(0)))});
    for (int round = 0; round < rounds; ++round) {
        const MixedBsdfs m = mix_bsdfs(all, round);
        const Vec3x8 from = draw.directions(), to = draw.directions();
        const Vec3x8 u{draw.numbers(), draw.numbers(), draw.numbers()};
        const Mask8 wanted = draw.mask();
        const Mask8 meets = connectible(m.lanes);
        for (const Transport t : {Transport::radiance, Transport::importance}) {
            const BsdfEval8 e = eval_bsdfs(m.lanes, wanted, from, to, t);
            const BsdfSample8 s = sample_bsdfs(m.lanes, wanted, from, u, t);
            EXPECT_EQ(bits(s.drawn & ~wanted), 0u);
            for_each_lane(wanted, [&](int k) {
                const Bsdf& b = m.one[size_t(k)];
                const BsdfEval one = eval_bsdf(b, from[k], to[k], t);
                EXPECT_EQ(e.f[k], one.f);
                EXPECT_EQ(e.pdf_fwd_w[k], one.pdf_fwd_w);
                EXPECT_EQ(e.pdf_rev_w[k], one.pdf_rev_w);
                expect_sample(s, k, sample_bsdf(b, from[k], u[k], t));
                EXPECT_EQ(meets[k] != 0, b.connectible());
            });
        }
    }
}

void expect_state(const mis::State8& s, int k, const mis::State& one) {
    EXPECT_EQ(s.vcm[k], one.vcm);
    EXPECT_EQ(s.vc[k], one.vc);
}

// Densities over many decades.
Double8 densities(Draw& draw) {
    Double8 d{};
    for (int k = 0; k < lane_count; ++k)
        d.set(k, std::pow(10.0, 16 * double(draw.uniform(draw.random)) - 8));
    return d;
}

TEST(Lanes, WeightsAreThoseOfTheRecursion) {
    const mis::Power2<> h;
    Draw draw;
    for (int round = 0; round < rounds; ++round) {
        const Double8 a = densities(draw), b = densities(draw), c = densities(draw),
                      d = densities(draw), e = densities(draw);
        const Mask8 some = draw.mask();
        Double8 n{};
        for (int k = 0; k < lane_count; ++k)
            n.set(k, std::array{0.0, 1.0, 0.25, 8.0}[(round + k) % 4]);
        const mis::State8 s{a, b}, t{c, d};
        const mis::State8 next = mis::advance(s, {c, d, e, some, n});
        const mis::State8 path = mis::path_tracer::advance(c, some);
        const mis::Side8 side{d, e, n};
        const mis::NextEvent8 pdfs{c, d, e, some};
        const Double8 connected = mis::connection(s, side, t, {e, a, n}, 0.5);
        const Double8 asked = mis::next_event(s, side, pdfs);
        const Double8 alone = mis::path_tracer::next_event(pdfs);
        const Double8 splatted = mis::light_tracing(s, side, 7);
        for (int k = 0; k < lane_count; ++k) {
            const bool yes = some[k] != 0;
            const mis::State one{a[k], b[k]}, other{c[k], d[k]};
            const mis::Side its{d[k], e[k], n[k]};
            const mis::NextEventPdfs of_one{c[k], d[k], e[k], yes};
            expect_state(next, k, mis::advance(h, one, {c[k], d[k], e[k], yes, n[k]}));
            expect_state(path, k, mis::path_tracer::advance(h, c[k], yes));
            EXPECT_EQ(connected[k], mis::connection(h, one, its, other, {e[k], a[k], n[k]}, 0.5));
            EXPECT_EQ(asked[k], mis::next_event(h, one, its, of_one));
            EXPECT_EQ(alone[k], mis::path_tracer::next_event(h, of_one));
            EXPECT_EQ(splatted[k], mis::light_tracing(h, one, its, 7));
        }
    }
}

void expect_next_event(const Scene& s, const NextEventLanes& n, int k,
                       const std::optional<NextEventSample>& one) {
    ASSERT_EQ(n.found[k] != 0, one.has_value());
    if (!one) return;
    const LightKind kind = s.lights[size_t(one->light)].kind;
    EXPECT_EQ(n.delta[k] != 0, is_delta(kind));
    EXPECT_EQ(n.infinite[k] != 0, is_infinite(kind));
    EXPECT_EQ(n.direction[k], one->direction);
    EXPECT_EQ(n.value[k], one->value);
    EXPECT_EQ(n.cos_theta[k], one->cos_theta);
    EXPECT_EQ(n.distance_squared[k], one->distance_squared);
    EXPECT_EQ(n.origin[k], one->pdfs.origin);
    EXPECT_EQ(n.leave[k], one->pdfs.leave);
    EXPECT_EQ(n.next_event[k], one->pdfs.next_event);
    if (is_infinite(kind)) return;
    EXPECT_EQ(n.target[k], one->target);
    EXPECT_EQ(n.normal[k], one->normal);
    EXPECT_EQ(n.error[k], one->error);
}

void expect_emission(const Scene& s, const EmissionLanes& e, int k,
                     const std::optional<EmissionSample>& one) {
    ASSERT_EQ(e.found[k] != 0, one.has_value());
    if (!one) return;
    const LightKind kind = s.lights[size_t(one->light)].kind;
    EXPECT_EQ(e.lights[size_t(k)], one->light);
    EXPECT_EQ(e.area[k] != 0, kind == LightKind::area);
    EXPECT_EQ(e.delta[k] != 0, is_delta(kind));
    EXPECT_EQ(e.infinite[k] != 0, is_infinite(kind));
    EXPECT_EQ(e.position[k], one->position);
    EXPECT_EQ(e.normal[k], one->normal);
    EXPECT_EQ(e.direction[k], one->direction);
    EXPECT_EQ(e.weight[k], one->weight);
    EXPECT_EQ(e.error[k], one->error);
    EXPECT_EQ(e.cos_theta[k], one->cos_theta);
    EXPECT_EQ(e.origin[k], one->pdfs.origin);
    EXPECT_EQ(e.leave[k], one->pdfs.leave);
}

TEST(Lanes, LightsAreDrawnAlike) {
    const ScopedFlushToZero flush;
    Draw draw;
    for (const std::string& name : oracle_scene_names()) {
        SCOPED_TRACE(name);
        const AgreementScene a = make_agreement_scene(name);
        const Scene& s = *a.scene;
        for (int round = 0; round < rounds; ++round) {
            const Vec3x8 at = draw.directions() * draw.numbers();
            const std::array<Float8, 4> u{draw.numbers(), draw.numbers(), draw.numbers(),
                                          draw.numbers()};
            const Double8 pick = to_double(draw.numbers());
            const Mask8 wanted = draw.mask();
            const NextEventLanes n = sample_next_events(s, wanted, at, {pick, u[0], u[1]});
            const EmissionLanes e = sample_emissions(s, wanted, {pick, u});
            EXPECT_EQ(bits((n.found | e.found) & ~wanted), 0u);
            const auto ratios = next_event_ratios(s, e.found, e.lights, at, u[0], u[1] + 1.0f);
            for_each_lane(wanted, [&](int k) {
                const vec2 point{u[0][k], u[1][k]}, to{u[2][k], u[3][k]};
                expect_next_event(s, n, k, sample_next_event(s, at[k], {pick[k], point}));
                expect_emission(s, e, k, sample_emission(s, {pick[k], point, to}));
                if (e.found[k]) {
                    EXPECT_EQ(
                        ratios[size_t(k)],
                        next_event_ratio(s, e.lights[size_t(k)], {at[k], u[0][k], u[1][k] + 1.0f}));
                }
            });
        }
    }
}

struct Met {
    int surfaces = 0, others = 0, turned = 0;
};

void expect_surface(const Scene& s, const TriangleHit& hit, const SurfaceLanes& lanes, int k,
                    Met& met) {
    const SurfacePoint p = *surface_at(s, hit);
    const Bsdf b = make_bsdf(material_at(s, p), s.textures, p.shading);
    ++met.surfaces;
    met.turned += glm::dot(p.shading.normal, b.ng) < 0;
    EXPECT_EQ(lanes.position[k], p.position);
    EXPECT_EQ(lanes.error[k], p.error);
    EXPECT_EQ(lanes.bsdf.ng[k], b.ng);
    EXPECT_EQ(lanes.bsdf.normal[k], b.frame.n);
    ASSERT_EQ(lanes.bsdf.others[k] == 0, b.only_diffuse);
    EXPECT_EQ(lanes.bsdf.diffuse[k], b.only_diffuse ? b.diffuse : vec3(0));
    if (b.only_diffuse) return;
    ++met.others;
    const Bsdf& other = *lanes.bsdf.other[size_t(k)];
    EXPECT_EQ(other.frame.s, b.frame.s);
    EXPECT_EQ(other.f0, b.f0);
    EXPECT_EQ(other.glass, b.glass);
    EXPECT_EQ(other.alpha, b.alpha);
    EXPECT_EQ(other.thin, b.thin);
}

void expect_rays(const Scene& s, Draw& draw, Met& met) {
    BsdfStore store;
    for (int round = 0; round < rounds; ++round) {
        // From outside towards a place within the scene.
        const Vec3x8 from = draw.directions() * all_lanes(1.5f);
        const Vec3x8 place = draw.directions() * (0.6f * draw.numbers());
        const RayLanes rays{from, place - from, all_lanes(std::numeric_limits<float>::infinity())};
        const Mask8 wanted = draw.mask();
        const std::array<std::uint64_t, lane_count> coins{1, 2, 3, 4, 5, 6, 7, 8};
        HitLanes hits;
        s.accel->closest(rays, wanted, {&s}, coins, hits);
        const Float8 part = s.accel->transmittance(rays, wanted, {&s});
        Mask8 surface{};
        for_each_lane(wanted, [&](int k) {
            const TriangleHit one = s.accel->closest(rays[k], {&s}, coins[size_t(k)]);
            const TriangleHit& hit = hits[size_t(k)];
            EXPECT_EQ(part[k], s.accel->transmittance(rays[k], {&s}));
            ASSERT_EQ(hit.object, one.object);
            if (one.object < 0) return;
            surface[k] = -1;
            EXPECT_EQ(hit.triangle, one.triangle);
            EXPECT_EQ(vec2(hit.b1, hit.b2), vec2(one.b1, one.b2));
        });
        SurfaceLanes lanes{};
        surfaces_at(s, hits, surface, lanes, store);
        for_each_lane(surface, [&](int k) { expect_surface(s, hits[size_t(k)], lanes, k, met); });
    }
}

// A ball whose normals point inwards, as some files have them.
std::shared_ptr<const Scene> inside_out() {
    SceneDescription d = plain_room();
    Mesh ball = make_icosphere({0, 0.5f, 0.8f}, 0.4f, 2, false, true);
    for (vec3& n : ball.normals) n = -n;
    add(d, ball, lambert(vec3(0.5f)));
    return build(d);
}

TEST(Lanes, RaysMeetTheSameSurfaces) {
    const ScopedFlushToZero flush;
    Draw draw;
    Met met;
    for (const std::string& name : oracle_scene_names()) {
        SCOPED_TRACE(name);
        expect_rays(*make_agreement_scene(name).scene, draw, met);
    }
    expect_rays(*inside_out(), draw, met);
    EXPECT_GT(met.surfaces, 1000);
    EXPECT_GT(met.others, 100);
    EXPECT_GT(met.turned, 10);
}

}  // namespace
}  // namespace midway::test
