// The scenes of assets/, compared by the full tier alone: path, light, bdpt and further subsets of
// families, where they cover the scene, make the same image (support/agreement_assets.h says which,
// and how finely). Each is rendered with sixteen seeds, every one well stratified by itself, and
// the spread of the seeds' means is the standard error: ten times cheaper than independent samples.
// What is seen of lamps directly, (2,0), is left out everywhere: it is the same in all.
//
// Three statements per scene: the standard error of every mean is as small as asked for; all pairs
// of means differ by less than 3.5 standard errors (exponents from the same paths: of their
// difference, seed by seed); and no block of 6 x 6 pixels of any pair differs at a level shared by
// all (Sidak, 1e-4 in all; not where a caustic is found by chance alone). What fails is measured
// once more with other seeds and twice the samples, and is a failure if it fails again. False alarm
// of a case: at most 465 pairs x (4.65e-4)^2 + (1e-4)^2, which is 1e-4.
//
// Not compared here: exponent 0 where connections take part (where two surfaces meet, the square of
// a connection has no finite mean), and on glossy scenes most subsets without both emitter hits and
// next event (a lamp of 12 mm seen in water of roughness 0.05 by next event alone: what matters is
// too rare to show in the spread). No standard error could be trusted there. The small scenes of
// agreement_test.cpp, whose objects float apart, compare these.
#include "support/agreement_assets.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "support/agreement.h"
#include "support/tier.h"

namespace midway::test {

void PrintTo(const AssetPlan& plan, std::ostream* out) { *out << plan.file; }

namespace {

// One image: a row of the plan with one of its exponents.
struct Entry {
    size_t row = 0, exponent = 0;
    std::string name;
    Measured measured;
};

std::vector<Entry> measure_row(const AgreementScene& scene, const AssetPlan& plan, size_t row,
                               bool again) {
    const AssetRow& r = plan.rows[row];
    RenderSettings s;
    s.width = s.height = 24;
    s.max_bounces = scene.max_bounces;
    s.only = all_but_direct_lamps(scene.max_bounces);
    s.families = r.families;
    s.exponents = r.exponents;
    s.seed = 1000 * (row + 1) + (again ? 500 : 0);
    SeedsEffort effort;
    effort.passes = again ? 2 * r.passes : r.passes;
    effort.seeds = r.seeds;
    effort.most_seeds = r.seeds + r.seeds / 2;
    effort.relative_error = r.relative_error;
    std::vector<Entry> entries;
    for (Measured& m : measure_seeds(scene, s, effort)) {
        const size_t i = entries.size();
        const Estimate e = m.image.estimate();
        const std::string name = fmt::format("{} b={}", to_string(r.families), r.exponents[i]);
        std::cout << fmt::format("{}: {}: mean {:.6f} +- {:.3f} % ({} spp x {} seeds)", plan.file,
                                 name, e.mean, 100 * e.standard_error / e.mean, effort.passes,
                                 m.image.count)
                  << std::endl;
        entries.push_back({row, i, name, std::move(m)});
    }
    return entries;
}

Difference compare(const Entry& a, const Entry& b) {
    return a.row == b.row ? paired_difference(a.measured, b.measured)
                          : difference(a.measured, b.measured);
}

// Compares two entries, and once more with other seeds where they disagree.
void expect_agreement(const AgreementScene& scene, const AssetPlan& plan, const Entry& a,
                      const Entry& b, double block_limit) {
    const bool blocks = plan.rows[a.row].blocks && plan.rows[b.row].blocks;
    Verdict v{compare(a, b), blocks ? block_limit : HUGE_VAL};
    const std::string name = fmt::format("{}: {} against {}: ", plan.file, a.name, b.name);
    std::cout << name << v.text() << std::endl;
    if (v.agrees()) return;
    const std::vector<Entry> x = measure_row(scene, plan, a.row, true);
    const std::vector<Entry> y = a.row == b.row ? x : measure_row(scene, plan, b.row, true);
    v.difference = compare(x[a.exponent], y[b.exponent]);
    std::cout << "  again: " << v.text() << std::endl;
    EXPECT_TRUE(v.agrees()) << name << v.text();
}

class AgreementOfAssets : public testing::TestWithParam<AssetPlan> {};

TEST_P(AgreementOfAssets, OfTechniquesExponentsAndFamilies) {
    if (!full_tier()) GTEST_SKIP() << "assets are compared by the full tier (MIDWAY_FULL=1)";
    const AssetPlan& plan = GetParam();
    const std::filesystem::path folder = std::filesystem::path(MIDWAY_SOURCE_DIR) / "assets";
    const AgreementScene scene =
        load_agreement_scene((folder / (plan.file + ".glb")).string(), plan.sky);
    std::vector<Entry> entries;
    for (size_t row = 0; row < plan.rows.size(); ++row) {
        ASSERT_TRUE(families_cover(scene, plan.rows[row].families)) << plan.file << " row " << row;
        for (Entry& e : measure_row(scene, plan, row, false)) {
            const Estimate m = e.measured.image.estimate();
            EXPECT_GT(m.mean, 0) << e.name << " is black";
            EXPECT_LE(m.standard_error, plan.rows[row].relative_error * m.mean) << e.name;
            entries.push_back(std::move(e));
        }
    }
    const std::int64_t pairs = std::int64_t(entries.size() * (entries.size() - 1) / 2);
    const double level =
        sidak_level(1e-4, pairs * std::int64_t(entries.front().measured.blocks.size()));
    for (size_t i = 0; i < entries.size(); ++i)
        for (size_t j = i + 1; j < entries.size(); ++j)
            expect_agreement(scene, plan, entries[j], entries[i], -normal_quantile(level / 2));
}

INSTANTIATE_TEST_SUITE_P(Assets, AgreementOfAssets, testing::ValuesIn(asset_plans()),
                         [](const auto& info) {
                             std::string name = info.param.file;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace midway::test
