// The extreme suite of `midway check`, group by group: its cheap cases in the quick tier, all of it
// in the full one. Each case states its own false-alarm rate; together they stay below 1e-3.
// MIDWAY_TEST_SEED=K shifts the seeds.
#include <gtest/gtest.h>

#include <set>

#include "report/extreme_measure.h"
#include "support/tier.h"
#include "support/worker_mode.h"

namespace midway::test {
namespace {

void run_group(const std::string& group) {
    CaseContext context;
    context.threads = 1;
    context.assets = MIDWAY_SOURCE_DIR "/assets";
    context.seed = test_seed(0);
    context.effort = by_tier(0.25, 1.0);
    int ran = 0;
    for (const ExtremeCase& c : extreme_cases()) {
        if (c.group != group || !(c.cheap || full_tier())) continue;
        const CaseResult r = run_case(c, context);
        EXPECT_FALSE(r.skipped) << c.name << ": " << r.detail;
        EXPECT_TRUE(r.passed) << c.group << "/" << c.name << ": " << c.sentence << "\n  measured "
                              << r.measured << ", bar " << r.bar << "\n  " << r.detail;
        std::printf("%-28s %6.2f s  %s (%s) %s\n", c.name.c_str(), r.seconds, r.measured.c_str(),
                    r.bar.c_str(), r.detail.c_str());
        ++ran;
    }
    EXPECT_GT(ran, 0);
}

TEST(Extreme, Size) { run_group("size"); }
TEST(Extreme, Roughness) { run_group("roughness"); }
TEST(Extreme, Intensity) { run_group("intensity"); }
TEST(Extreme, Scale) { run_group("scale"); }
TEST(Extreme, Geometry) { run_group("geometry"); }
TEST(Extreme, Depth) { run_group("depth"); }
TEST(Extreme, Lights) { run_group("lights"); }
TEST(Extreme, RandomNumbers) { run_group("random numbers"); }
TEST(Extreme, Exponent) { run_group("exponent"); }
TEST(Extreme, Film) { run_group("film"); }

// The whole suite raises a false alarm at most once in a thousand changes of its random numbers.
TEST(Extreme, EveryGroupIsRunAndTheFalseAlarmsAreFew) {
    const std::set<std::string> known{"scale", "intensity", "size",   "roughness",      "geometry",
                                      "depth", "exponent",  "lights", "random numbers", "film"};
    std::set<std::string> found, names;
    for (const ExtremeCase& c : extreme_cases()) {
        found.insert(c.group);
        EXPECT_TRUE(names.insert(c.group + "/" + c.name).second) << c.name;
        EXPECT_FALSE(c.sentence.empty());
    }
    EXPECT_EQ(found, known);
    EXPECT_LE(extreme::case_alarm * double(names.size()), 1e-3);
}

}  // namespace
}  // namespace midway::test
