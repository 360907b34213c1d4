// What each thing left out saves: every one that can be turned on is measured, and the image stays.
#include "report/cost.h"

#include <gtest/gtest.h>

#include <map>

#include "render/pilot.h"
#include "support/rooms.h"

namespace midway::test {
namespace {

PreparedScene prepare(const SceneDescription& d) {
    PreparedScene p;
    p.description = d;
    p.camera = eye();
    p.scene = build(d);
    return p;
}

TEST(Cost, MeasuresEveryThingThatCanBeTurnedOn) {
    SceneDescription d = room_with_a_sign();
    d.lights = {point_light({0, 1.7f, 1}, 0)};
    const PreparedScene p = prepare(d);
    RenderSettings s = settings(Technique::automatic, 8, 4);
    s.plan = Plan{{true, true, true, false}, 2};
    const auto rows = measure_cost(p, s, {.threads = 1, .rounds = 2, .seconds = 0});
    std::map<std::string, LeaveOutCost> by_name;
    for (const LeaveOutCost& row : rows) by_name[row.what] = row;
    for (const char* what : {"textures", "texture coordinates", "transparency",
                             "lights at infinity", "code for other passes", "strategy images"}) {
        ASSERT_TRUE(by_name.contains(what)) << what;
        EXPECT_TRUE(by_name[what].same_bits) << what;
        EXPECT_EQ(1, by_name[what].mean_ratio) << what;
    }
    for (const char* what :
         {"connections", "light subpaths", "all that auto leaves out", "lights", "black lights"}) {
        ASSERT_TRUE(by_name.contains(what)) << what;
        EXPECT_FALSE(by_name[what].same_bits) << what;
        EXPECT_GT(by_name[what].mean_ratio, 0.3) << what;
        EXPECT_LT(by_name[what].mean_ratio, 3) << what;
    }
    for (const char* what : {"normal maps", "transparency"}) {
        ASSERT_TRUE(by_name.contains(what)) << what;
        EXPECT_NEAR(by_name[what].mean_ratio, 1, 0.05) << what;
    }
    EXPECT_FALSE(by_name.contains("light tracing"));
    EXPECT_EQ(12u, rows.size());
    for (const LeaveOutCost& row : rows) {
        EXPECT_GT(row.left_out.median, 0) << row.what;
        EXPECT_GT(row.done.median, 0) << row.what;
        EXPECT_LE(row.saving.low, row.saving.median) << row.what;
        EXPECT_FALSE(row.why.empty()) << row.what;
    }
}

TEST(Cost, MeasuresAPlanPieceByPiece) {
    const PreparedScene p = prepare(plain_room());
    RenderSettings s = settings(Technique::automatic, 8, 4);
    s.plan = Plan{{true, true, false, false}, 0};
    std::vector<std::string> names;
    for (const LeaveOutCost& row : measure_cost(p, s, {.threads = 1, .rounds = 1, .seconds = 0}))
        if (row.why.starts_with("the plan of auto is path tracing")) names.push_back(row.what);
    EXPECT_EQ(
        (std::vector<std::string>{"connections", "light tracing", "all that auto leaves out"}),
        names);
    s.plan = Plan{{}, 1};
    for (const LeaveOutCost& row : measure_cost(p, s, {.threads = 1, .rounds = 1, .seconds = 0}))
        EXPECT_EQ(row.why.starts_with("the plan"), row.what == "light subpaths") << row.what;
    s.plan = Plan{{}, 8};
    for (const LeaveOutCost& row : measure_cost(p, s, {.threads = 1, .rounds = 1, .seconds = 0}))
        EXPECT_FALSE(row.why.starts_with("the plan")) << row.what << ": two subpaths are no saving";
}

TEST(Cost, MeasuresFamiliesThatNothingHereNeeds) {
    const PreparedScene p = prepare(mirror_room());
    RenderSettings s = settings(Technique::automatic, 8, 4);
    choose_plan(*p.scene, p.camera, s, 1);
    const auto rows = measure_cost(p, s, {.threads = 1, .rounds = 1, .seconds = 0});
    size_t families = 0;
    for (const LeaveOutCost& row : rows) {
        const bool family =
            row.what == "next-event" || row.what == "light" || row.what == "connect";
        families += family;
        EXPECT_TRUE(row.same_bits || row.what == "normal maps" || row.what == "transparency")
            << row.what;
    }
    EXPECT_EQ(3u, families);
}

}  // namespace
}  // namespace midway::test
