// Every technique, every exponent and every subset of families that covers a small scene makes the
// same image (agreement_assets_test.cpp: those of assets/). Two statements per comparison: the
// means of the images differ by less than 3.5 standard errors, and no block of pixels differs by a
// z-test at a level shared by all blocks and comparisons of the case (Sidak, 1e-4 in all). What
// fails is measured once more, with an independent seed and four times the samples, and is a
// failure if it fails again: a fault grows, chance does not. False alarm of a case: at most 40
// comparisons x (4.7e-4)^2 + (1e-4)^2 < 1e-5.
#include "support/agreement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <iostream>

#include "support/tier.h"

namespace midway::test {
namespace {

struct Variant {
    std::string name;
    RenderSettings settings;
    double relative_error = 0.001;  // reached by the full tier
};

RenderSettings base_settings(const AgreementScene& scene) {
    RenderSettings s;
    s.width = 24;
    s.height = 24;
    s.sampler = SamplerKind::independent;
    s.max_bounces = scene.max_bounces;
    s.only = all_but_direct_lamps(scene.max_bounces);
    return s;
}

// bdpt of five exponents, path, light, and subsets of families, where they cover the scene. The
// quick tier takes path, single families, and all but one.
std::vector<Variant> variants(const AgreementScene& scene) {
    std::vector<Variant> result;
    Variant all{"bdpt", base_settings(scene)};
    all.settings.exponents = {0, 0.5, 1, 2, 8};
    result.push_back(all);
    for (int bits = 1; bits < 15; ++bits) {
        const Families f{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0};
        const int families = std::popcount(unsigned(bits));
        const bool technique =
            f == families_of(Technique::path) || f == families_of(Technique::light);
        if (!families_cover(scene, f) || (!full_tier() && families == 2 && !technique)) continue;
        Variant v{to_string(f), base_settings(scene)};
        v.settings.families = f;
        v.settings.exponents = families == 1 ? std::vector<double>{2} : std::vector<double>{0, 2};
        v.relative_error = !technique ? 0.002 : scene.caustic ? 0.01 : 0.001;
        result.push_back(v);
    }
    return result;
}

Effort effort_for(const Variant& v) {
    Effort e;
    e.passes = by_tier<std::uint64_t>(4, 32);
    e.batches = by_tier(64, 128);
    // Light tracing into a camera that sits in rough glass takes the most.
    e.rounds = by_tier(4, 128);
    e.relative_error = by_tier(0.002, v.relative_error);
    return e;
}

// Measured against bdpt with the balance heuristic.
Measured reference(const AgreementScene& scene, std::uint64_t seed, const Effort& effort) {
    RenderSettings s = base_settings(scene);
    s.exponents = {1};
    s.seed = seed;
    return measure(scene, s, effort).front();
}

void expect_agreement(const AgreementScene& scene) {
    const std::vector<Variant> all = variants(scene);
    int comparisons = 0;
    for (const Variant& v : all) comparisons += static_cast<int>(v.settings.exponents.size());
    const Measured expected = reference(scene, 1, effort_for(all.front()));
    ASSERT_GT(expected.image.mean, 0) << scene.name << " is black";
    std::uint64_t seed = 100;
    for (Variant v : all) {
        v.settings.seed = seed++;
        std::vector<Measured> found = measure(scene, v.settings, effort_for(v));
        for (size_t i = 0; i < found.size(); ++i) {
            Verdict j = judge(found[i], expected, comparisons);
            const std::string name =
                fmt::format("{}: {} b={}", scene.name, v.name, v.settings.exponents[i]);
            std::cout << name << ": " << j.text() << std::endl;
            if (full_tier()) {
                const Estimate mean = found[i].image.estimate();
                EXPECT_LE(mean.standard_error, v.relative_error * mean.mean) << name;
            }
            if (j.agrees()) continue;
            Effort more = effort_for(v);
            more.rounds *= 4;
            more.relative_error /= 2;
            RenderSettings again = v.settings;
            again.seed += 1000;
            j = judge(measure(scene, again, more)[i], reference(scene, 2, more), comparisons);
            std::cout << "  again: " << j.text() << std::endl;
            EXPECT_TRUE(j.agrees()) << name << ": " << j.text();
        }
    }
}

class Agreement : public testing::TestWithParam<std::string> {};

TEST_P(Agreement, OfTechniquesExponentsAndFamilies) {
    expect_agreement(make_agreement_scene(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, testing::ValuesIn(agreement_scene_names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace midway::test
