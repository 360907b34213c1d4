// The strategy pyramid without a window: where its cells lie, what a click chooses, what its words
// say, and that the panel asks for nothing but a display.
#include <gtest/gtest.h>
#include <imgui.h>

#include <set>

#include "viewer/panels/panels.h"
#include "viewer/panels/parts.h"
#include "viewer/pyramid_layout.h"
#include "viewer/pyramid_words.h"
#include "viewer/script_set.h"
#include "viewer/strategy_view.h"

namespace midway::test {
namespace {

PyramidRoom room(float width, float height, float aspect) {
    return {{{100, 50}, {100 + width, 50 + height}}, 70, 40, 18, 5, aspect};
}

TEST(PyramidLayout, HasEveryStrategyOnceAndKeepsToItsRoom) {
    for (const int bounces : {0, 1, 3, 7, 8, 16, 1000})
        for (const float aspect : {0.5f, 1.0f, 1.78f})
            for (const vec2 size : {vec2(560, 600), vec2(1400, 900), vec2(350, 300)}) {
                const PyramidRoom r = room(size.x, size.y, aspect);
                const PyramidLayout l = lay_out_pyramid(r, bounces);
                std::set<std::pair<int, int>> seen;
                for (const PyramidCell& c : l.cells) {
                    EXPECT_TRUE(seen.insert({c.strategy.s, c.strategy.t}).second);
                    EXPECT_GE(c.thumbnail.lower.x, r.rect.lower.x + r.left - 1);
                    EXPECT_LE(c.thumbnail.upper.x, r.rect.upper.x - r.right + 1);
                    EXPECT_LE(c.thumbnail.upper.y + r.caption, r.rect.upper.y + 1);
                    EXPECT_NEAR(c.thumbnail.size().x / c.thumbnail.size().y, aspect, 0.2f * aspect);
                }
                const int longest = std::min(bounces + 1, cell_edges);
                const size_t expected = strategy_count(longest) + (bounces + 1 > cell_edges);
                EXPECT_EQ(l.cells.size(), expected);
                EXPECT_EQ(seen.count({0, 0}), bounces + 1 > cell_edges ? 1u : 0u);
            }
}

TEST(PyramidLayout, StepsDownAddAVertexAtTheirSide) {
    const PyramidLayout l = lay_out_pyramid(room(800, 700, 1), 16);
    const auto middle = [&](int s, int t) {
        for (const PyramidCell& c : l.cells)
            if (c.strategy == Strategy{s, t})
                return 0.5f * (c.thumbnail.lower.x + c.thumbnail.upper.x);
        return -1.0f;
    };
    for (int s = 1; s < 8; ++s) {
        EXPECT_LT(middle(s + 1, 1), middle(s, 1));
        EXPECT_GT(middle(s, 2), middle(s, 1));
    }
    EXPECT_EQ(row_name({1}), "0 bounces");
    EXPECT_EQ(row_name({2}), "1 bounce");
    EXPECT_EQ(row_name({9}), "8 and more");
}

TEST(PyramidChoice, ClicksChooseAddAndComeBack) {
    App app;
    const PyramidChoices& p = app.display.pyramid;
    open_pyramid(app, true);
    app.display.channel = Channel::error;
    choose_strategy(app, {2, 1}, false);
    EXPECT_TRUE(shows_strategies(app)) << "whatever channel was shown";
    choose_strategy(app, {1, 3}, false);
    EXPECT_EQ(p.selected, (std::vector<Strategy>{{1, 3}}));
    EXPECT_EQ(p.seen, (std::vector<Strategy>{{2, 1}})) << "its samples are kept";
    choose_strategy(app, {2, 1}, true);
    choose_strategy(app, longer_paths, true);
    EXPECT_EQ(p.selected, (std::vector<Strategy>{{1, 3}, {2, 1}, longer_paths}));
    EXPECT_TRUE(p.seen.empty());
    choose_strategy(app, {1, 3}, true);
    EXPECT_EQ(p.selected, (std::vector<Strategy>{{2, 1}, longer_paths}));
    choose_strategy(app, {2, 1}, false);
    choose_strategy(app, {2, 1}, false);
    EXPECT_FALSE(shows_strategies(app)) << "a second click is the way back";
    const StrategyRequest request = strategy_request(app);
    EXPECT_TRUE(request.open);
    EXPECT_EQ(request.kept.size(), 3u);
    open_pyramid(app, false);
    EXPECT_EQ(strategy_request(app), StrategyRequest{})
        << "nothing is asked for while it is closed";
}

TEST(PyramidChoice, WordsOfScriptsAreChecked) {
    App app;
    for (const char* wrong : {"2", "0,3", "1,9", "2,1;", "", "2.5,1", "a,b", "99,99", "1,-5"})
        EXPECT_THROW(set_value(app, "strategies", wrong), std::invalid_argument) << wrong;
    EXPECT_FALSE(set_value(app, "strategies", "2,1;longer").restarts());
    EXPECT_TRUE(app.display.pyramid.open);
    EXPECT_EQ(window_values(app).at("strategies"), "2,1;longer");
    set_value(app, "strategies", "none");
    EXPECT_TRUE(app.display.pyramid.selected.empty());
}

TEST(PyramidWords, SharesAreOfAllCells) {
    StrategySnapshot s;
    s.cells = {{.found = {{2, 1}, 10, 30, 0.75, 1}, .variance = 0.2},
               {.found = {{1, 2}, 10, 10, 0.25, 9}, .variance = 0.6}};
    EXPECT_DOUBLE_EQ(shares_of(s, {2, 1}).light, 0.75);
    EXPECT_DOUBLE_EQ(shares_of(s, {1, 2}).noise, 0.75);
    EXPECT_DOUBLE_EQ(shares_of(s, {1, 2}).rays, 0.25);
    EXPECT_EQ(shares_of(s, {3, 2}).light, 0);
    EXPECT_EQ(percent(0.1234), "12 %");
    EXPECT_EQ(percent(0.034), "3.4 %");
    EXPECT_EQ(percent(1e-5), "< 0.1 %");
    EXPECT_EQ(percent(0), "-");
}

// ImGui with a window of this size that nobody sees.
class PyramidPanels : public testing::Test {
  protected:
    PyramidPanels() {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        apply_theme(1);
        auto strategies = std::make_shared<StrategySnapshot>();
        for (int s = 1; s <= 8; ++s)
            strategies->cells.push_back({.found = {{s, 1}, 5, 7, 0.5, 1}, .variance = 0.1});
        strategies->passes = 3;
        auto snapshot = std::make_shared<Snapshot>();
        snapshot->width = snapshot->height = 100;
        snapshot->crop = {0, 0, 100, 100};
        snapshot->strategies = strategies;
        app.snapshot = snapshot;
        app.ui.panel.pyramid.drawn = strategies;
        app.display.pyramid.open = true;
    }
    ~PyramidPanels() override { ImGui::DestroyContext(); }
    Change frame(vec2 mouse = {-1, -1}, bool pressed = false) {
        ImGuiIO& io = ImGui::GetIO();
        io.DeltaTime = 1.0f / 60;
        io.MousePos = {mouse.x, mouse.y};
        io.MouseDown[0] = pressed;
        ImGui::NewFrame();
        Change change;
        for (const Panel& p : panels()) change |= p.draw(app);
        ImGui::Render();
        return change;
    }
    App app;
};

TEST_F(PyramidPanels, StandBesideTheImageAtEverySize) {
    for (const ImVec2 size : {ImVec2(1280, 720), ImVec2(1920, 1080), ImVec2(3840, 2160),
                              ImVec2(900, 600), ImVec2(640, 480), ImVec2(320, 240)})
        for (const bool columns : {true, false}) {
            ImGui::GetIO().DisplaySize = size;
            app.ui.panels = columns;
            for (int i = 0; i < 3; ++i) EXPECT_FALSE(frame().any());
            if (size.x < 900) continue;
            EXPECT_GT(app.ui.view.size().x, 140) << size.x;
            EXPECT_GE(app.ui.panel.pyramid.place[0], app.ui.view.upper.x);
            EXPECT_EQ(app.ui.panel.pyramid.cells.size(), 45u);
            for (const PyramidPanel::Cell& c : app.ui.panel.pyramid.cells) {
                EXPECT_GT(c.x, app.ui.panel.pyramid.place[0]);
                EXPECT_LT(c.y, app.ui.panel.pyramid.place[3]);
            }
        }
}

TEST_F(PyramidPanels, AClickOnACellShowsIt) {
    ImGui::GetIO().DisplaySize = {1280, 720};
    for (int i = 0; i < 3; ++i) frame();
    vec2 at(0);
    for (const PyramidPanel::Cell& c : app.ui.panel.pyramid.cells)
        if (c.s == 3 && c.t == 1) at = {c.x, c.y};
    Change change = frame(at);
    change |= frame(at, true);
    change |= frame(at);
    EXPECT_TRUE(change.display);
    EXPECT_FALSE(change.restarts());
    EXPECT_EQ(app.display.pyramid.selected, (std::vector<Strategy>{{3, 1}}));
    EXPECT_FALSE(app.camera.moving) << "the camera has no part in it";
}

}  // namespace
}  // namespace midway::test
