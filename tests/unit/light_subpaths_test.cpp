// Who shares light subpaths with whom.
#include <gtest/gtest.h>

#include <set>

#include "report/drawn_path.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace midway::test {
namespace {

// Every pixel is in one group, at one place, and those that share stand apart where there is room.
TEST(LightSubpaths, GroupsCoverTheCrop) {
    for (const int width : {1, 7, 8, 9, 31, 32, 33, 75, 96}) {
        const PixelRect crop{5, 2, 5 + width, 4};
        std::vector<int> seen(static_cast<size_t>(width), 0);
        for (int n = 0; n < group_count(crop); ++n) {
            const PixelGroup g = group_at(crop, n, 3);
            EXPECT_EQ(3, g.y);
            EXPECT_EQ(std::min(group_pixels, width - n * group_pixels), g.size());
            EXPECT_EQ((n / 4 + 1) * 32 <= width ? 4 : 1, g.step);
            for (int k = 0; k < g.size(); ++k) {
                ++seen.at(static_cast<size_t>(g.x(k) - crop.x0));
                const PixelGroup own = group_of(crop, g.x(k), 3);
                EXPECT_EQ(g.x0, own.x0);
                EXPECT_EQ(g.size(), own.size());
                EXPECT_EQ(k, own.place_of(g.x(k)));
                EXPECT_EQ(n, group_number(crop, g.x(k)));
            }
        }
        EXPECT_EQ(std::vector<int>(seen.size(), 1), seen) << width;
    }
}

TEST(LightSubpaths, EachVertexIsMetOnceForEveryCameraVertex) {
    for (int count = 1; count <= group_pixels; ++count)
        for (int i = 1; i <= 20; ++i)
            for (int j = 1; j <= 20; ++j) {
                std::set<int> met;
                for (int place = 0; place < count; ++place) {
                    const int from = partner(place, i, j, count);
                    EXPECT_TRUE(from >= 0 && from < count);
                    met.insert(from);
                }
                EXPECT_EQ(static_cast<size_t>(count), met.size());
            }
    for (int place = 0; place < group_pixels; ++place) {
        EXPECT_EQ(place, partner(place, 1, 1, group_pixels));
        std::set<int> along_light, along_camera;
        for (int k = 1; k <= group_pixels; ++k) {
            along_light.insert(partner(place, 1, k, group_pixels));
            along_camera.insert(partner(place, k, 1, group_pixels));
        }
        EXPECT_EQ(static_cast<size_t>(group_pixels), along_light.size());
        EXPECT_EQ(static_cast<size_t>(group_pixels), along_camera.size());
    }
}

// Each light vertex that a camera vertex may meet is in one of its choices.
TEST(LightSubpaths, ChoicesShareTheLightVertices) {
    for (const bool first : {true, false})
        for (int last = 0; last <= 12; ++last) {
            std::vector<int> met;
            int choices = 0;
            for_each_choice(first, last, [&](int j, int end) {
                ++choices;
                EXPECT_LE(j, end);
                for (; j <= end; ++j) met.push_back(j);
            });
            ASSERT_EQ(static_cast<size_t>(last), met.size());
            for (int j = 1; j <= last; ++j) EXPECT_EQ(j, met[static_cast<size_t>(j) - 1]);
            EXPECT_EQ(last == 0 ? 0 : first && last > 1 ? 2 : 1, choices);
        }
}

TEST(LightSubpaths, TheFirstRoughSurfaceMeetsThoseOfAllNeighbours) {
    PathVertex v;
    v.index = 3;
    for (int count = 1; count <= group_pixels; ++count)
        for (const int rough : {0, 1, 2}) {
            v.rough = rough;
            std::vector<int> met;
            for_each_partner(v, 0, 2, count, [&](int from) { met.push_back(from); });
            if (rough > 0) {
                EXPECT_EQ(std::vector<int>{partner(0, 3, 2, count)}, met);
                continue;
            }
            ASSERT_EQ(static_cast<size_t>(count), met.size());
            for (int from = 0; from < count; ++from)
                EXPECT_EQ(from, met[static_cast<size_t>(from)]);
        }
}

TEST(LightSubpaths, VerticesAreFoundByTheirNumber) {
    LightSubpath light;
    for (const int index : {1, 2, 5, 6, 9}) light.emplace_back().index = index;
    for (int j = 1; j <= 12; ++j) {
        const PathVertex* found = vertex_at(light, j);
        const bool there = j == 1 || j == 2 || j == 5 || j == 6 || j == 9;
        ASSERT_EQ(there, found != nullptr) << j;
        if (there) {
            EXPECT_EQ(j, found->index);
        }
    }
    EXPECT_EQ(nullptr, vertex_at({}, 1));
}

SceneDescription floor_and_lamp() {
    SceneDescription d;
    add(d, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 4), lambert(vec3(0.8f)));
    add(d, make_quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    return d;
}

CameraDescription eye() { return camera_at({0, 1, 4}, {0, 0.5f, 0}, 0.8); }

Estimator estimator_of_crop(const Scene& scene, int width, int height) {
    RenderSettings s = settings(Technique::bdpt, 64, 4);
    s.crop = PixelRect{2, 3, 2 + width, 3 + height};
    return make_estimator(scene, eye(), s);
}

TEST(LightSubpaths, EveryPixelHasOneAndNeighboursHaveNeighbours) {
    const auto scene = build(floor_and_lamp());
    for (const auto& [width, height] :
         {std::pair{16, 16}, {32, 8}, {21, 5}, {5, 3}, {8, 1}, {1, 1}}) {
        const Estimator e = estimator_of_crop(*scene, width, height);
        for (std::uint64_t pass = 0; pass < 20; ++pass) {
            std::vector<std::uint64_t> first;  // in the order of the groups
            for (int y = 3; y < 3 + height; ++y)
                for (int n = 0; n < group_count(e.crop); ++n) {
                    const PixelGroup g = group_at(e.crop, n, y);
                    const auto paired = paired_subpaths(e, g, pass);
                    for (int k = 0; k < g.size(); ++k) {
                        EXPECT_EQ(paired[static_cast<size_t>(k)],
                                  paired_subpath(e, g.x(k), y, pass));
                        first.push_back(paired[static_cast<size_t>(k)]);
                    }
                }
            for (size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i] / 8, first[i - i % 8] / 8);
            const std::set<std::uint64_t> all(first.begin(), first.end());
            ASSERT_EQ(static_cast<size_t>(width * height), first.size());
            EXPECT_EQ(first.size(), all.size());
            EXPECT_EQ(first.size() - 1, *all.rbegin());
        }
    }
}

// Over the passes a pixel has every subpath equally often, or it would meet the same strata of the
// lights each time; those that are no whole group, every one of theirs. Chi-square over 45 pixels;
// false alarm 1e-4 for all of them.
TEST(LightSubpaths, APixelHasEachOfThemAsOften) {
    const auto scene = build(floor_and_lamp());
    for (const int width : {24, 21}) {
        const Estimator e = estimator_of_crop(*scene, width, 1);
        for (int x = 0; x < width; ++x) {
            const int whole = width / 8 * 8;
            const int first = x < whole ? 0 : whole, end = x < whole ? whole : width;
            std::vector<double> counts(end - first), expected(end - first, 200);
            for (int pass = 0; pass < 200 * (end - first); ++pass)
                ++counts.at(paired_subpath(e, 2 + x, 3, pass) - first);
            EXPECT_GT(chi_square_test(counts, expected).p_value, sidak_level(1e-4, 45)) << x;
        }
    }
}

// In a box with one lamp. A camera vertex's connections are those of its choices; from the first
// surface they go to every neighbour's light subpath, from others to the one whose turn it is.
TEST(LightSubpaths, ASampleConnectsToThoseItMayChoose) {
    SceneDescription d = floor_and_lamp();
    add(d, make_quad({-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, 4), lambert(vec3(0.8f)));
    add(d, make_quad({-2, 0, 2}, {0, 0, -4}, {0, 3, 0}, 4), lambert(vec3(0.8f)));
    add(d, make_quad({2, 0, -2}, {0, 0, 4}, {0, 3, 0}, 4), lambert(vec3(0.8f)));
    const auto scene = build(d);
    const Estimator e = make_estimator(*scene, eye(), settings(Technique::bdpt, 16, 4));
    std::array<int, 8> from_first{};  // by how far the neighbour is
    int behind = 0;
    for (int i = 0; i < 1024; ++i) {
        const int x = i % 16, y = i / 16 % 16;
        std::set<std::pair<int, bool>> made;
        draw_paths(e, x, y, static_cast<std::uint64_t>(i / 256), [&](const DrawnPath& p) {
            const Strategy k = p.contribution.strategy;
            if (family_of(k) != Family::connection) return;
            EXPECT_TRUE(made.emplace(k.s, k.s == 2 && k.t > 2).second) << k.s << ", " << k.t;
            if (k.s == 2) return void(++from_first.at(static_cast<size_t>((p.met - x) & 7)));
            ++behind;
            EXPECT_EQ((x + (k.s - 2) + 3 * (k.t - 2)) % 8, p.met);
        });
    }
    for (const int count : from_first) EXPECT_GT(count, 50);
    EXPECT_GT(behind, 50);
}

}  // namespace
}  // namespace midway::test
