// The pieces that a sample is made of, each alone and in cache: cmake -DMIDWAY_BENCHMARKS=ON, then
// bin/midway_bench. What counts is `midway bench` on whole scenes and error at equal time; these
// tell which piece moved.
#include <benchmark/benchmark.h>

#include <random>

#include "image/film.h"
#include "integrator/mis.h"
#include "math/sampler.h"
#include "math/warp.h"
#include "scene/light_tree.h"
#include "shading/texture.h"

namespace midway {
namespace {

void draw_one_group(benchmark::State& state) {
    std::uint64_t i = 3;
    for (auto _ : state)
        benchmark::DoNotOptimize(sample_4d(make_sample_key(7, i++ & 63, SamplerKind::sobol), 4));
}
BENCHMARK(draw_one_group);

void draw_a_vertex(benchmark::State& state) {
    std::uint64_t i = 3;
    for (auto _ : state)
        benchmark::DoNotOptimize(
            sample_4d_pair(make_sample_key(7, i++ & 63, SamplerKind::sobol), 4));
}
BENCHMARK(draw_a_vertex);

Bsdf bsdf_of(float metallic, float specular, float transmission) {
    Material m;
    m.metallic = metallic;
    m.specular = specular;
    m.transmission = transmission;
    m.roughness = 0.4f;
    return make_bsdf(m, {}, ShadingPoint{});
}

const vec3 up_left = glm::normalize(vec3(0.4f, 0.1f, 0.8f));

void evaluate(benchmark::State& state, const Bsdf& b) {
    float x = 0.1f;
    for (auto _ : state) {
        x = x < 0.8f ? x + 0.01f : 0.1f;
        const vec3 to = glm::normalize(vec3(-x, 0.2f, 0.7f));
        benchmark::DoNotOptimize(eval_bsdf(b, up_left, to, Transport::radiance));
    }
}
BENCHMARK_CAPTURE(evaluate, diffuse, bsdf_of(0, 0, 0));
BENCHMARK_CAPTURE(evaluate, plastic, bsdf_of(0, 1, 0));
BENCHMARK_CAPTURE(evaluate, glass, bsdf_of(0, 1, 1));

void scatter_at(benchmark::State& state, const Bsdf& b) {
    std::uint64_t i = 0;
    for (auto _ : state) {
        const vec4 u = sample_4d(make_sample_key(1, i++, SamplerKind::sobol), 2);
        benchmark::DoNotOptimize(sample_bsdf(b, up_left, vec3(u), Transport::radiance));
    }
}
BENCHMARK_CAPTURE(scatter_at, diffuse, bsdf_of(0, 0, 0));
BENCHMARK_CAPTURE(scatter_at, plastic, bsdf_of(0, 1, 0));
BENCHMARK_CAPTURE(scatter_at, glass, bsdf_of(0, 1, 1));

void weigh_a_connection(benchmark::State& state) {
    const mis::State camera{0.3, 12}, light{4, 0.02};
    mis::Side a{0.7, 1.2}, b{2.5, 0.3};
    for (auto _ : state) {
        a.pdf_a += 1e-9;
        mis::with_heuristic(double(state.range(0)) / 10, [&](const auto& h) {
            benchmark::DoNotOptimize(mis::connection(h, camera, a, light, b, 1));
        });
    }
}
BENCHMARK(weigh_a_connection)->Arg(0)->Arg(10)->Arg(20)->Arg(80);

void pick_a_lamp(benchmark::State& state) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> u(-1, 1);
    std::vector<LightBounds> lamps;
    for (int i = 0; i < state.range(0); ++i) {
        const vec3 at(u(random), u(random), u(random));
        lamps.push_back({at, at + vec3(0.01f), glm::normalize(at), false});
    }
    LightTree tree;
    tree.build(lamps, std::vector<double>(lamps.size(), 1));
    std::uint64_t i = 0;
    for (auto _ : state) {
        const vec4 v = sample_4d(make_sample_key(1, i++, SamplerKind::sobol), 2);
        double p = 0;
        benchmark::DoNotOptimize(tree.sample(vec3(v) - 0.5f, v.w, p));
    }
}
BENCHMARK(pick_a_lamp)->Arg(2)->Arg(100)->Arg(10'000)->Arg(1'000'000);

void add_to_the_film(benchmark::State& state) {
    Film film(512, 512, -90);
    FixedCounts counts;
    std::uint32_t i = 1;
    for (auto _ : state) {
        i = i * 1664525u + 1013904223u;
        const FixedRgb v{to_fixed(0.3f, -90, counts), to_fixed(0.2f, -90, counts),
                         to_fixed(0.1f, -90, counts)};
        benchmark::DoNotOptimize(film.add(0, i >> 23, (i >> 14) & 511, v));
    }
}
BENCHMARK(add_to_the_film);

}  // namespace
}  // namespace midway
