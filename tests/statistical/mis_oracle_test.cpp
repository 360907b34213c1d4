// The estimator's weights against the oracle, over a million paths drawn from real scenes with
// every kind of light and surface. Nothing here is random beyond the paths: a weight is right or
// wrong, so there is no false alarm; the limits are those of float geometry.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>

#include "math/float_mode.h"
#include "render/pilot.h"
#include "report/drawn_path.h"
#include "report/whole_path_recursion.h"
#include "support/agreement_scenes.h"
#include "support/tier.h"

namespace midway::test {
namespace {

const std::vector<double> exponents{0, 0.5, 1, 2, 8};
constexpr int power = 3;  // index of exponent 2

struct Subject {
    AgreementScene scene;
    Estimator estimator;
    PathSetting setting;
};

Subject prepare(AgreementScene scene, const Plan& plan) {
    RenderSettings s;
    s.width = 20;
    s.height = 16;
    s.exponents = exponents;
    s.technique = Technique::automatic;
    s.plan = plan;
    s.max_bounces = 6;
    Subject r{std::move(scene), {}, {}};
    r.estimator = make_estimator(*r.scene.scene, r.scene.camera, s);
    r.setting = path_setting(r.estimator);
    return r;
}

// Draws at least so many paths, pass by pass.
template <class Visit>
std::int64_t draw(const Subject& s, std::int64_t wanted, const Visit& visit) {
    const ScopedFlushToZero flush;
    std::int64_t count = 0;
    for (std::uint64_t pass = 0; count < wanted && pass < 100000; ++pass)
        for (int y = s.estimator.crop.y0; y < s.estimator.crop.y1; ++y)
            for (int x = s.estimator.crop.x0; x < s.estimator.crop.x1; ++x)
                draw_paths(s.estimator, x, y, pass, [&](const DrawnPath& p) {
                    if (p.edges() < 2) return;
                    ++count;
                    visit(p);
                });
    return count;
}

double sum_of(const std::vector<double>& weights) {
    double sum = 0;
    for (const double w : weights) sum += w;
    return sum;
}

// What makes float geometry inexact: grazing directions, narrow lobes, short edges.
std::string cause_of(const DrawnPath& p) {
    float cosine = 1, alpha = 1;
    float shortest = std::numeric_limits<float>::infinity();
    for (int i = 1; i < p.edges(); ++i) {
        const PathVertex& v = p.surfaces[i];
        if (!p.pdfs.vertices[i].delta && (v.bsdf.has_specular() || v.bsdf.has_glass()))
            alpha = std::min(alpha, v.bsdf.alpha);
        for (const int n : {i - 1, i + 1}) {
            if (n == p.edges() && p.infinite) {
                cosine = std::min(cosine, abs_dot(v.ng, p.light));
                continue;
            }
            const vec3 d = (n == 0           ? p.lens
                            : n == p.edges() ? p.light
                                             : p.surfaces[n].position) -
                           v.position;
            shortest = std::min(shortest, glm::length(d));
            cosine = std::min(cosine, abs_dot(v.ng, d) / glm::length(d));
        }
    }
    return fmt::format("cause: smallest cosine {:.2g}, narrowest lobe {:.2g}, shortest edge {:.2g}",
                       cosine, alpha, shortest);
}

std::string in_words(const Subject& s, const DrawnPath& p) {
    std::string text = cause_of(p) + "\n    " + describe(p.contribution.strategy) +
                       ", surfaces from the camera on:";
    for (int i = 1; i < p.edges(); ++i)
        text +=
            fmt::format(" {}{} alpha {:.3g}", p.pdfs.vertices[i].delta ? "delta" : "rough",
                        p.surfaces[i].bsdf.has_glass() ? " glass" : "", p.surfaces[i].bsdf.alpha);
    for (int i = 1; i < p.edges(); ++i)
        text +=
            fmt::format("\n    vertex {}: from camera {:.6g} x {:.6g}, from light {:.6g} x {:.6g}",
                        i, p.pdfs.vertices[i].camera_w, p.pdfs.vertices[i].camera_g,
                        p.pdfs.vertices[i].light_w, p.pdfs.vertices[i].light_g);
    return text + fmt::format("\n    light: {}, emission {:.6g}, next event {:.6g} ({})",
                              p.infinite ? "infinite" : "finite", p.pdfs.emission,
                              p.pdfs.next_event, s.scene.name);
}

// What is not a number is the worst of all, and stays it.
void keep_worst(double& worst, double off) {
    if (!(off <= worst)) worst = std::isnan(off) ? std::numeric_limits<double>::infinity() : off;
}

// Largest differences of a scene's paths.
struct SamePdfs {
    double recursion = 0, sum = 0;  // against the direct form, over all strategies
    // The estimator's weight against the direct form, for each exponent.
    std::array<std::vector<float>, 5> estimator;
    double worst_estimator = 0;
    std::string worst;
};

void compare_same_pdfs(const Subject& s, const DrawnPath& p, SamePdfs& r) {
    const Strategy k = p.contribution.strategy;
    for (size_t b = 0; b < exponents.size(); ++b) {
        const std::vector<double> direct = direct_weights(p.pdfs, s.setting, exponents[b]);
        const std::vector<double> recursive =
            recursive_weights(p.pdfs, p.pdfs, s.setting, exponents[b]);
        for (size_t i = 0; i < direct.size(); ++i)
            keep_worst(r.recursion, std::abs(direct[i] - recursive[i]));
        keep_worst(r.sum, std::abs(sum_of(recursive) - 1));
        double off = 0;
        keep_worst(off, std::abs(p.contribution.weights[b] - direct[k.s - 1]));
        r.estimator[b].push_back(float(off));
        if (off > r.worst_estimator) {
            r.worst_estimator = off;
            r.worst = fmt::format("b {}: estimator {:.9g}, direct form {:.9g}: {}", exponents[b],
                                  p.contribution.weights[b], direct[k.s - 1], in_words(s, p));
        }
    }
}

float quantile(std::vector<float>& v, double q) {
    const size_t i = std::min(v.size() - 1, static_cast<size_t>(q * v.size()));
    std::nth_element(v.begin(), v.begin() + i, v.end());
    return v[i];
}

// An exponent of 8 makes four times as much of a rounded density as one of 2.
void expect_estimator(SamePdfs& r, double tail, const std::string& worst) {
    for (size_t b = 0; b < exponents.size(); ++b) {
        const double times = std::max(1.0, exponents[b] / exponents[power]);
        EXPECT_LE(quantile(r.estimator[b], 0.5), times * 1e-6) << "b " << exponents[b] << worst;
        EXPECT_LE(quantile(r.estimator[b], tail), times * 1e-3) << "b " << exponents[b] << worst;
    }
}

class MisOracle : public testing::TestWithParam<std::string> {};

// Given the same pdfs, the recursion is the direct form, and sums to one, within 1e-9. The weights
// that the estimator puts into the image are the same but for the rounding of its float geometry.
TEST_P(MisOracle, RecursionIsTheDirectFormGivenTheSamePdfs) {
    const Subject s = prepare(make_agreement_scene(GetParam()), {});
    SamePdfs r;
    const std::int64_t paths =
        draw(s, by_tier(50000, 2000000), [&](const DrawnPath& p) { compare_same_pdfs(s, p, r); });
    std::cout << fmt::format(
        "{}: {} paths, recursion {:.1e}, sum {:.1e}, estimator median {:.1e}, 99.9 % {:.1e}, worst "
        "{:.1e}\n",
        s.scene.name, paths, r.recursion, r.sum, quantile(r.estimator[power], 0.5),
        quantile(r.estimator[power], 0.999), r.worst_estimator);
    EXPECT_GE(paths, 50000);
    EXPECT_LE(r.recursion, 1e-9);
    EXPECT_LE(r.sum, 1e-9);
    expect_estimator(r, 0.999, r.worst);
}

void expect_weights_of(const std::string& scene, const std::vector<Plan>& plans) {
    for (const Plan& plan : plans) {
        const Subject s = prepare(make_agreement_scene(scene), plan);
        SamePdfs r;
        draw(s, by_tier(1500, 50000), [&](const DrawnPath& p) {
            if (s.estimator.forms(p.contribution.strategy)) compare_same_pdfs(s, p, r);
        });
        ASSERT_FALSE(r.estimator[power].empty());
        EXPECT_LE(r.recursion, 1e-9);
        EXPECT_LE(r.sum, 1e-9);
        expect_estimator(r, 0.99, describe(plan) + "\n" + r.worst);
    }
}

// The same with families taken out, which the walks' sums have to know.
TEST_P(MisOracle, KnowsTheFamiliesTakenOut) {
    expect_weights_of(GetParam(), {{{false, true, true, true}},
                                   {{true, false, true, true}},
                                   {{true, true, false, true}},
                                   {{true, true, true, false}}});
}

// The same where not every camera sample has connections, there are more light subpaths, or direct
// light is sampled twice.
TEST_P(MisOracle, KnowsHowManySamplesThereAre) {
    expect_weights_of(GetParam(), {{{}, 1},
                                   {{true, true, false, true}, 2},
                                   {{}, 8},
                                   {{}, 4, false},
                                   {{}, 1, false},
                                   {{}, 4, true, 2},
                                   {{}, 1, false, 2},
                                   {{true, true, false, false}, 0, true, 2}});
}

// Sum over the strategies of a path, each with the pdfs that it evaluates from its own side.
double sum_of_own_weights(const Subject& s, const DrawnPath& p) {
    const OwnPdfs camera = own_pdfs(s.estimator, p, Transport::radiance);
    const OwnPdfs light = own_pdfs(s.estimator, p, Transport::importance);
    const std::vector<double> own =
        recursive_weights(camera.pdfs, light.pdfs, s.setting, exponents[power]);
    double sum = 0;
    for (size_t i = 0; i < own.size(); ++i) {
        const int vertices = static_cast<int>(i) + 1;
        if (vertices == p.contribution.strategy.s) {
            sum += p.contribution.weights[power];
            continue;
        }
        // Both ends of the connecting edge have to scatter along it.
        bool makes = true;
        if (vertices > 1 && vertices <= p.edges()) makes &= camera.scatters[vertices - 1];
        if (vertices < p.edges()) makes &= light.scatters[vertices];
        if (makes) sum += own[i];
    }
    return sum;
}

// With each strategy's own pdfs the weights of a path sum to one but for rounding: what is missing
// is bias. Median 1e-6, 99.9 % of the paths 1e-3, energy-weighted mean 1e-5.
TEST_P(MisOracle, OwnPdfsSumToOne) {
    const Subject s = prepare(make_agreement_scene(GetParam()), {});
    std::vector<float> off;
    double energy = 0, bias = 0, worst = 0;
    std::string cause;
    const std::int64_t paths = draw(s, by_tier(20000, 400000), [&](const DrawnPath& p) {
        const double excess = sum_of_own_weights(s, p) - 1;
        const double carried = luminance(p.contribution.value) * p.contribution.weights[power];
        energy += carried;
        bias += carried * excess;
        off.push_back(float(std::abs(excess)));
        if (std::abs(excess) > worst) {
            worst = std::abs(excess);
            cause = fmt::format("sum - 1 = {:.3e}: {}", excess, in_words(s, p));
        }
    });
    const double median = quantile(off, 0.5), tail = quantile(off, 0.999);
    std::cout << fmt::format(
        "{}: {} paths, |sum - 1| median {:.1e}, 99.9 % {:.1e}, bias {:+.1e}\n"
        "  worst: {}\n",
        s.scene.name, paths, median, tail, bias / energy, cause);
    EXPECT_LE(median, 1e-6);
    EXPECT_LE(tail, 1e-3) << cause;
    EXPECT_LE(std::abs(bias / energy), 1e-5) << cause;
}

INSTANTIATE_TEST_SUITE_P(Scenes, MisOracle, testing::ValuesIn(oracle_scene_names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace midway::test
