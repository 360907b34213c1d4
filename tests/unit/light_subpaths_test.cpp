// Who shares light subpaths with whom.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "report/drawn_path.h"
#include "support/scenes.h"
#include "support/statistics.h"

namespace midway::test {
namespace {

TEST(LightSubpaths, GroupsCoverTheCrop) {
    for (const int width : {1, 7, 8, 9, 21}) {
        const PixelRect crop{5, 2, 5 + width, 4};
        for (int x = crop.x0; x < crop.x1; ++x) {
            const PixelGroup g = group_of(crop, x, 3);
            EXPECT_TRUE(g.x0 <= x && x < g.x1 && g.x1 <= crop.x1 && g.y == 3);
            EXPECT_EQ(0, (g.x0 - crop.x0) % group_pixels);
            EXPECT_EQ(std::min(group_pixels, crop.x1 - g.x0), g.size());
        }
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
    for (const auto& [width, height] : {std::pair{16, 16}, {21, 5}, {5, 3}, {8, 1}, {1, 1}}) {
        const Estimator e = estimator_of_crop(*scene, width, height);
        for (std::uint64_t pass = 0; pass < 20; ++pass) {
            std::vector<std::uint64_t> first(static_cast<size_t>(width * height));
            std::set<std::uint64_t> all;
            for (int i = 0; i < width * height; ++i) {
                first[i] = paired_subpath(e, 2 + i % width, 3 + i / width, pass);
                all.insert(first[i]);
                EXPECT_EQ(first[i] / 8, first[i - i % 8] / 8);
            }
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

// In a box with one lamp every light subpath starts at a point of its own, so that the points tell
// which connections of a sample hang on the same one.
TEST(LightSubpaths, ConnectionsOfASampleDoNotHangOnOne) {
    SceneDescription d = floor_and_lamp();
    add(d, make_quad({-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, 4), lambert(vec3(0.8f)));
    add(d, make_quad({-2, 0, 2}, {0, 0, -4}, {0, 3, 0}, 4), lambert(vec3(0.8f)));
    add(d, make_quad({2, 0, -2}, {0, 0, 4}, {0, 3, 0}, 4), lambert(vec3(0.8f)));
    const auto scene = build(d);
    const Estimator e = make_estimator(*scene, eye(), settings(Technique::bdpt, 16, 4));
    int pairs = 0, connections = 0;
    for (int i = 0; i < 1024; ++i) {
        const int x = i % 16, y = i / 16 % 16;
        std::map<int, vec3> start;  // by place
        std::map<std::pair<int, int>, int> met;
        draw_paths(e, x, y, static_cast<std::uint64_t>(i / 256), [&](const DrawnPath& p) {
            const Strategy k = p.contribution.strategy;
            if (family_of(k) != Family::connection) return;
            ++connections;
            const int place = (x + (k.s - 2) + 3 * (k.t - 2)) % 8;
            const auto [found, first] = start.emplace(place, p.light);
            EXPECT_EQ(found->second, p.light);
            EXPECT_TRUE(met.emplace(std::pair{k.s, k.t}, place).second) << "met twice";
        });
        for (auto a = start.begin(); a != start.end(); ++a)
            for (auto b = start.begin(); b != a; ++b, ++pairs) EXPECT_NE(a->second, b->second);
    }
    EXPECT_GT(connections, 200);
    EXPECT_GT(pairs, 40);
}

}  // namespace
}  // namespace midway::test
