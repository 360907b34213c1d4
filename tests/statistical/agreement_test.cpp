// Every technique, every exponent and every subset of families that covers a scene makes the same
// image. Two statements per comparison: the means of the images differ by less than 3.5 standard
// errors, and no block of pixels differs by a z-test at a level shared by all blocks and
// comparisons of the case (Sidak, 1e-4 in all). What fails is measured once more, with an
// independent seed and four times the samples, and is a failure if it fails again: a fault grows,
// chance does not. False alarm of a case: at most 40 comparisons x (4.7e-4)^2 + (1e-4)^2 < 1e-5.
#include "support/agreement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <iostream>

#include "support/tier.h"

namespace midway::test {
namespace {

struct Variant {
    std::string name;
    RenderSettings settings;
    double relative_error = 0.001;  // to be reached by the full tier
    int rounds = 2;                 // at most, in the full tier
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

// Exponents that a scene bears: where surfaces meet, naive weights have no finite variance.
std::vector<double> exponents_of(const AgreementScene& scene, const std::vector<double>& all) {
    return scene.naive ? all : std::vector<double>(all.begin() + 1, all.end());
}

// bdpt of five exponents, path, light, and subsets of families, where they cover the scene. The
// quick tier takes path, single families, and all but one.
std::vector<Variant> variants(const AgreementScene& scene) {
    std::vector<Variant> result;
    Variant all{"bdpt", base_settings(scene), 0.001, 8};
    all.settings.exponents = exponents_of(scene, {0, 0.5, 1, 2, 8});
    result.push_back(all);
    for (int bits = 1; bits < 15; ++bits) {
        const Families f{(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0};
        const int families = std::popcount(unsigned(bits));
        const bool technique =
            f == families_of(Technique::path) || f == families_of(Technique::light);
        if (!families_cover(scene, f) || (!full_tier() && families == 2 && !technique)) continue;
        // Narrow gloss and weak lamps: without both emitter hits and next event an asset's estimate
        // lives on events too rare for any z-test.
        const bool heavy_tailed = !(f.emitter_hit && f.next_event) && !technique;
        if (!scene.naive && heavy_tailed) continue;
        Variant v{to_string(f), base_settings(scene)};
        v.settings.families = f;
        v.settings.exponents = families == 1 ? std::vector<double>{2} : exponents_of(scene, {0, 2});
        v.relative_error = !technique ? 0.002 : scene.caustic ? 0.01 : 0.001;
        if (technique) v.rounds = 8;
        result.push_back(v);
    }
    return result;
}

Effort effort_for(const AgreementScene& scene, const Variant& v) {
    Effort e;
    if (!scene.naive) {
        const bool technique = v.rounds != 2;
        e.passes = 4;
        e.batches = 128;
        e.rounds = technique ? 24 : 4;
        e.relative_error = technique ? v.relative_error : 0.003;
        return e;
    }
    e.passes = by_tier<std::uint64_t>(4, 32);
    e.batches = by_tier(64, 128);
    e.rounds = by_tier(4, v.rounds);
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
    const Measured expected = reference(scene, 1, effort_for(scene, all.front()));
    ASSERT_GT(expected.image.mean, 0) << scene.name << " is black";
    std::uint64_t seed = 100;
    for (Variant v : all) {
        v.settings.seed = seed++;
        std::vector<Measured> found = measure(scene, v.settings, effort_for(scene, v));
        for (size_t i = 0; i < found.size(); ++i) {
            Verdict j = judge(found[i], expected, comparisons);
            const std::string name =
                fmt::format("{}: {} b={}", scene.name, v.name, v.settings.exponents[i]);
            std::cout << name << ": " << j.text() << std::endl;
            if (j.agrees()) continue;
            Effort more = effort_for(scene, v);
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

// The scenes of assets/: shared by the long tier alone, since they are slow and noisy.
struct Asset {
    std::string file, sky;
    bool caustic = false;
};

void PrintTo(const Asset& asset, std::ostream* out) { *out << asset.file; }

class AgreementOfAssets : public testing::TestWithParam<Asset> {};

TEST_P(AgreementOfAssets, OfTechniquesExponentsAndFamilies) {
    if (!full_tier()) GTEST_SKIP() << "assets are compared by the full tier (MIDWAY_FULL=1)";
    const std::filesystem::path folder = std::filesystem::path(MIDWAY_SOURCE_DIR) / "assets";
    AgreementScene scene =
        load_agreement_scene((folder / (GetParam().file + ".glb")).string(), GetParam().sky);
    scene.caustic = GetParam().caustic;
    scene.naive = false;
    expect_agreement(scene);
}

INSTANTIATE_TEST_SUITE_P(
    Assets, AgreementOfAssets,
    testing::Values(Asset{"cornell"}, Asset{"plates"}, Asset{"five-lights", "0.1,0.16,0.28"},
                    Asset{"idol", "", true}, Asset{"ajar", "", true}, Asset{"ring", "", true},
                    Asset{"lanterns"},
                    Asset{"terrace", std::string(MIDWAY_SOURCE_DIR) + "/assets/terrace_sky.hdr"}),
    [](const auto& info) {
        std::string name = info.param.file;
        std::replace(name.begin(), name.end(), '-', '_');
        return name;
    });

}  // namespace
}  // namespace midway::test
