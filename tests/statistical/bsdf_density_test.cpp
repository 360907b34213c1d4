// sample_bsdf and eval_bsdf of every lobe against each other. False-alarm rate of each random case:
// 1e-4, shared by its comparisons. Held with 20 other seeds (MIDWAY_TEST_SEED=1..20).
#include <gtest/gtest.h>

#include <map>

#include "math/warp.h"
#include "support/bsdfs.h"
#include "support/density.h"
#include "support/tier.h"
#include "support/worker_mode.h"

namespace midway::test {
namespace {

constexpr double alarm = 1e-4;
using BsdfDensity = WorkerMode;

// The directions that the tests look from: cosines with ng, from both sides.
constexpr float cosines[] = {0.95f, 0.5f, 0.12f, -0.12f, -0.7f};

vec3 looking_from(const Bsdf& b, float cosine) {
    return frame_from_normal(b.ng).to_world(direction_from_z(cosine, 0.17f));
}

// Probability per solid angle without the Dirac factors.
double delta_probability(const Bsdf& b, const BsdfSample& s, const vec3& from) {
    const bool crosses = glm::dot(from, b.ng) * glm::dot(s.to, b.ng) < 0;
    const float eta = !crosses || b.thin ? 1 : glm::dot(from, b.ng) > 0 ? b.eta : 1 / b.eta;
    return s.pdf_fwd_w / (double(abs_dot(s.to, b.frame.n)) * eta);
}

bool tilted(const std::string& name) { return name.find("tilted") != std::string::npos; }

DensityResult density_of(const Bsdf& b, Transport transport, float cosine, int samples,
                         std::uint64_t seed) {
    const vec3 from = looking_from(b, cosine);
    Random random(seed);
    const auto draw = [&]() -> std::optional<vec3> {
        const auto s = sample_bsdf(b, from, random.next3(), transport);
        if (!s || s->delta) return {};
        return s->to;
    };
    const auto pdf = [&](const vec3& to) {
        return double(eval_bsdf(b, from, to, transport).pdf_fwd_w);
    };
    return test_sphere_density(frame_from_normal(b.frame.n), {32, 32}, samples, draw, pdf);
}

// Every direction that is drawn follows pdf_fwd_w of eval, integrated over the cells of the sphere;
// what the density leaves over is drawn as a delta or lost. Finds a lobe's probability that is 3 %
// wrong, or a width of 2 %.
TEST_F(BsdfDensity, SamplesFollowTheDensityOfEval) {
    const int samples = by_tier(60'000, 2'000'000);
    const std::vector<NamedBsdf> all = every_bsdf();
    const double level = sidak_level(alarm, std::int64_t(2 * all.size() * std::size(cosines)));
    std::uint64_t seed = 100;
    for (const auto& [name, b] : all)
        for (const Transport transport : {Transport::radiance, Transport::importance})
            for (const float cosine : cosines) {
                // Only folds at a tilted normal make the ends differ.
                if (transport == Transport::importance && !tilted(name)) continue;
                SCOPED_TRACE(testing::Message()
                             << name << ", cos " << cosine << ", transport " << int(transport));
                const DensityResult r = density_of(b, transport, cosine, samples, ++seed);
                EXPECT_GT(r.test.p_value, level)
                    << "chi-square " << r.test.statistic << " of " << r.test.degrees_of_freedom
                    << ", lost " << r.lost << " of " << 1 - r.integral;
                // Slivers of cells that the integral's grid misses.
                EXPECT_LE(r.test.impossible, 1e-4 * samples);
                EXPECT_LE(r.integral, 1 + 2e-3);
            }
}

// What is drawn agrees with eval: weight = f |cos| / pdf, and both densities are eval's.
TEST_F(BsdfDensity, WeightsAreValuesOverDensities) {
    Random random(200);
    for (const auto& [name, b] : every_bsdf())
        for (const Transport transport : {Transport::radiance, Transport::importance})
            for (const float cosine : cosines) {
                SCOPED_TRACE(testing::Message() << name << ", cos " << cosine);
                const vec3 from = looking_from(b, cosine);
                for (int i = 0; i < 500; ++i) {
                    const auto s = sample_bsdf(b, from, random.next3(), transport);
                    if (!s || s->delta) continue;
                    const BsdfEval e = eval_bsdf(b, from, s->to, transport);
                    EXPECT_EQ(s->pdf_fwd_w, e.pdf_fwd_w);
                    EXPECT_EQ(s->pdf_rev_w, e.pdf_rev_w);
                    EXPECT_GT(s->pdf_fwd_w, 0);
                    EXPECT_NEAR(glm::length(s->to), 1, 1e-5);
                    const vec3 expected = e.f * (abs_dot(s->to, b.ng) / e.pdf_fwd_w);
                    EXPECT_LE(glm::length(s->weight - expected), 1e-5f * glm::length(expected));
                }
            }
}

// Delta lobes: the share of the draws is the probability that the densities hold, the probabilities
// of the outcomes and of the lobes beside them sum to one, and the two directions' numbers belong
// to each other.
TEST_F(BsdfDensity, DeltaLobesHaveTheirProbabilities) {
    constexpr int samples = 100'000;
    std::uint64_t seed = 300;
    const std::vector<NamedBsdf> all = smooth_bsdfs();
    const double level = sidak_level(alarm, std::int64_t(3 * all.size() * std::size(cosines)));
    for (const auto& [name, b] : all)
        for (const float cosine : cosines) {
            // Folds at a tilted normal draw one direction in two ways; the case below sees them.
            if (tilted(name)) continue;
            SCOPED_TRACE(testing::Message() << name << ", cos " << cosine);
            const vec3 from = looking_from(b, cosine);
            Random random(++seed);
            // Two lobes may send light the same way: outcomes are told apart by their density too.
            std::map<std::pair<bool, float>, std::pair<double, double>> outcomes;
            for (int i = 0; i < samples; ++i) {
                const auto s = sample_bsdf(b, from, random.next3(), Transport::radiance);
                if (!s || !s->delta) continue;
                const bool across = glm::dot(from, b.ng) * glm::dot(s->to, b.ng) < 0;
                auto& [count, probability] = outcomes[{across, s->pdf_fwd_w}];
                ++count;
                probability = delta_probability(b, *s, from);
            }
            double sum = 0;
            for (const auto& [outcome, found] : outcomes) {
                const auto& [count, probability] = found;
                const double error = std::sqrt(count + 1) / samples;
                EXPECT_GT(z_test({count / samples, error}, {probability, 0}), level);
                sum += probability;
            }
            EXPECT_LE(sum, 1 + 1e-5);
            if (!b.has_diffuse()) {
                EXPECT_NEAR(sum, 1, 1e-5);
            }
        }
}

// Is `back`, drawn from the importance side at s.to, the scattering s the other way round? f of a
// path does not depend on the end that built it: weight times density is its coefficient times the
// cosine at the side that the walk goes to.
bool reverses(const Bsdf& b, const vec3& from, const BsdfSample& s, const BsdfSample& back) {
    const vec3 there = s.weight * s.pdf_fwd_w * abs_dot(from, b.ng);
    const vec3 here = back.weight * back.pdf_fwd_w * abs_dot(s.to, b.ng);
    return glm::length(back.to - from) < 1e-3f &&
           std::abs(back.pdf_fwd_w / s.pdf_rev_w - 1) < 2e-4f &&
           std::abs(back.pdf_rev_w / s.pdf_fwd_w - 1) < 2e-4f &&
           glm::length(there - here) < 5e-4f * glm::length(there);
}

TEST_F(BsdfDensity, DeltaLobesAreTheSameFromBothEnds) {
    Random random(400);
    for (const auto& [name, b] : smooth_bsdfs())
        for (const float cosine : cosines) {
            SCOPED_TRACE(testing::Message() << name << ", cos " << cosine);
            const vec3 from = looking_from(b, cosine);
            for (int i = 0; i < 200; ++i) {
                const auto s = sample_bsdf(b, from, random.next3(), Transport::radiance);
                if (!s || !s->delta) continue;
                // Of the few outcomes seen from the other end, one is this one the other way round.
                bool found = false;
                for (int k = 0; k < 3000 && !found; ++k) {
                    const auto back = sample_bsdf(b, s->to, random.next3(), Transport::importance);
                    found = back && back->delta && reverses(b, from, *s, *back);
                }
                EXPECT_TRUE(found);
            }
        }
}

TEST_F(BsdfDensity, EveryRandomNumberIsSafe) {
    const float last = 1 - 0x1p-24f;
    for (const auto& list : {every_bsdf(), smooth_bsdfs()})
        for (const auto& [name, b] : list)
            for (const float cosine : {1.0f, 0.3f, 1e-4f, 1e-7f, -1e-5f, -1.0f})
                for (const float x : {0.0f, 0.5f, last})
                    for (const float y : {0.0f, 0.25f, last})
                        for (const float z : {0.0f, 0.5f, last}) {
                            SCOPED_TRACE(testing::Message() << name << ", cos " << cosine << " at "
                                                            << x << ' ' << y << ' ' << z);
                            const auto s = sample_bsdf(b, looking_from(b, cosine), {x, y, z},
                                                       Transport::importance);
                            if (!s) continue;
                            EXPECT_TRUE(is_finite(s->weight));
                            EXPECT_TRUE(is_finite(s->to));
                            EXPECT_TRUE(std::isfinite(s->pdf_fwd_w) && s->pdf_fwd_w > 0);
                            EXPECT_TRUE(std::isfinite(s->pdf_rev_w));
                        }
}

}  // namespace
}  // namespace midway::test
