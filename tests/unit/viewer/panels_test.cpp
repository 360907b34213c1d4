// The panels without a window: ImGui runs with no painter behind it. What they promise to the loop
// (display controls never restart a render, Tab leaves the whole window to the image), the table of
// keys, and the gallery's files.
#include "viewer/panels/panels.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <tuple>

#include "image/picture.h"
#include "render/session.h"
#include "viewer/gallery.h"
#include "viewer/keys.h"
#include "viewer/panels/parts.h"
#include "viewer/script_set.h"

namespace midway::test {
namespace {

// ImGui with a window of this size that nobody sees.
class Panels : public testing::Test {
  protected:
    Panels() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {1280, 720};
        apply_theme(1);
    }
    ~Panels() override { ImGui::DestroyContext(); }

    Change frame() {
        ImGui::GetIO().DeltaTime = 1.0f / 60;
        ImGui::NewFrame();
        Change change;
        for (const Panel& p : panels()) change |= p.draw(app);
        ImGui::Render();
        return change;
    }
    void open_scene() {
        app.document.path = app.document.options.path = MIDWAY_SOURCE_DIR "/assets/cornell.glb";
        app.document.prepared =
            std::make_shared<PreparedScene>(prepare_scene(app.document.options));
    }
    // One frame with the mouse there and these buttons and wheel.
    Change hand(vec2 at, int button = -1, float wheel = 0) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = {at.x, at.y};
        for (int b = 0; b < 3; ++b) io.MouseDown[b] = b == button;
        io.MouseWheel = wheel;
        return frame();
    }
    vec2 middle() const { return 0.5f * (app.ui.view.lower + app.ui.view.upper); }

    App app;
};

TEST_F(Panels, AnIdleWindowChangesNothing) {
    for (const ImVec2 size : {ImVec2(1280, 720), ImVec2(3840, 2160), ImVec2(320, 240)}) {
        ImGui::GetIO().DisplaySize = size;
        for (int i = 0; i < 5; ++i) EXPECT_FALSE(frame().any());
    }
    open_scene();
    ImGui::GetIO().DisplaySize = {1280, 720};
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(frame().any());
    EXPECT_FALSE(app.camera.moving);
    EXPECT_FALSE(app.camera.animating);
    EXPECT_TRUE(app.actions.empty());
}

TEST_F(Panels, LeaveTheMiddleToTheImageAndAllOfItWhenHidden) {
    frame();
    EXPECT_GT(app.ui.view.size().x, 1280 * 0.5f);
    EXPECT_GT(app.ui.view.size().y, 720 * 0.9f);
    app.ui.panels = false;
    frame();
    EXPECT_EQ(app.ui.view.size(), vec2(1280, 720));
}

TEST_F(Panels, ASmallWindowKeepsAnImage) {
    ImGui::GetIO().DisplaySize = {640, 480};
    frame();
    EXPECT_GT(app.ui.view.size().x, 200);
}

TEST_F(Panels, AClickBesideASheetClosesIt) {
    open_scene();
    for (bool Ui::*sheet : {&Ui::keys, &Ui::gallery}) {
        app.ui.*sheet = true;
        for (int i = 0; i < 3; ++i) EXPECT_FALSE(hand({640, 300}).any());
        EXPECT_FALSE(app.ui.view_hovered);
        hand({2, 2}, 0);
        hand({2, 2});
        EXPECT_FALSE(app.ui.*sheet);
    }
}

TEST_F(Panels, TheTourCanBeLeftAtEveryStep) {
    open_scene();
    app.ui.first_visit = true;
    frame();
    EXPECT_EQ(app.ui.tour_step, 0);
    for (int step = 0; step < 9 && app.ui.tour_step >= 0; ++step) {
        frame();
        app.ui.tour_step = step;
    }
    frame();
    EXPECT_EQ(app.ui.tour_step, -1) << "the tour ends after its last step";
    EXPECT_FALSE(app.ui.first_visit);
}

TEST_F(Panels, ADragOrbitsAndRestartsByTheCameraAlone) {
    open_scene();
    for (int i = 0; i < 3; ++i) hand(middle());
    const View before = current_view(app);
    const dvec3 pivot = app.camera.pivot;
    hand(middle(), 0);
    EXPECT_TRUE(app.camera.moving);
    const Change change = hand(middle() + vec2(60, 20), 0);
    EXPECT_TRUE(change.camera);
    EXPECT_FALSE(change.settings || change.scene);
    hand(middle() + vec2(60, 20));
    EXPECT_FALSE(app.camera.moving);
    const View after = current_view(app);
    EXPECT_GT(glm::length(after.eye - before.eye), 0.01);
    EXPECT_NEAR(glm::length(after.eye - pivot), glm::length(before.eye - pivot), 1e-6);
}

TEST_F(Panels, TheWheelGlidesTowardsThePointAndEnds) {
    open_scene();
    for (int i = 0; i < 3; ++i) hand(middle());
    const View before = current_view(app);
    hand(middle(), -1, 2);
    EXPECT_TRUE(app.camera.animating);
    for (int i = 0; i < 60; ++i) hand(middle());
    EXPECT_FALSE(app.camera.animating);
    const double way = glm::length(before.eye - app.camera.pivot);
    EXPECT_NEAR(glm::length(current_view(app).eye - app.camera.pivot) / way, std::exp(-0.36), 0.02);
}

TEST_F(Panels, FliesWhileTheRightButtonIsHeldAndComesToRest) {
    open_scene();
    for (int i = 0; i < 3; ++i) hand(middle());
    const View before = current_view(app);
    hand(middle(), 1);
    ImGui::GetIO().KeysDown[GLFW_KEY_W] = true;
    for (int i = 0; i < 30; ++i) hand(middle(), 1);
    EXPECT_TRUE(app.camera.moving);
    ImGui::GetIO().KeysDown[GLFW_KEY_W] = false;
    for (int i = 0; i < 60; ++i) hand(middle());
    EXPECT_FALSE(app.camera.moving);
    EXPECT_FALSE(app.camera.animating);
    const dvec3 way = current_view(app).eye - before.eye;
    EXPECT_NEAR(glm::dot(way, view_basis(before).forward), glm::length(way), 1e-9);
    // Half the scene's radius a second, for half a second.
    EXPECT_NEAR(glm::length(way) / scene_radius(*app.document.prepared->scene), 0.25, 0.03);
}

TEST_F(Panels, CtrlMovesThePixelsAndNotTheCamera) {
    open_scene();
    for (int i = 0; i < 3; ++i) hand(middle());
    ImGui::GetIO().KeyCtrl = true;
    Change change = hand(middle(), -1, 3);
    EXPECT_GT(app.display.zoom, 0);
    change |= hand(middle(), 0);
    change |= hand(middle() + vec2(40, 10), 0);
    change |= hand(middle() + vec2(40, 10));
    EXPECT_NEAR(app.display.pan.x, 40, 1);
    EXPECT_TRUE(change.display);
    EXPECT_FALSE(change.restarts());
}

TEST_F(Panels, DoubleClickSetsThePivotAndMovesNothing) {
    open_scene();
    for (int i = 0; i < 3; ++i) hand(middle());
    const dvec3 before = app.camera.pivot;
    const vec2 at = middle() + vec2(-150, 120);
    Change change;
    for (const int button : {0, -1, 0, -1}) change |= hand(at, button);
    EXPECT_FALSE(change.camera);
    EXPECT_GT(glm::length(app.camera.pivot - before), 0.01);
}

TEST_F(Panels, AClickFocusesWithTheToolInHand) {
    open_scene();
    for (int i = 0; i < 3; ++i) hand(middle());
    choose_tool(app, ViewTool::focus);
    Change change = hand(middle(), 0);
    change |= hand(middle());
    EXPECT_TRUE(change.camera);
    const SceneOptions& o = app.document.options;
    ASSERT_TRUE(o.focus_distance);
    EXPECT_NEAR(*o.focus_distance, depth_of(current_view(app), app.camera.pivot), 1e-3);
    EXPECT_GT(o.aperture_radius.value_or(0), 0) << "a pinhole is opened";
    EXPECT_EQ(app.ui.panel.navigation.tool, ViewTool::orbit);
}

TEST_F(Panels, ADragWithTheRegionToolCropsTheImage) {
    open_scene();
    for (int i = 0; i < 3; ++i) hand(middle());
    choose_tool(app, ViewTool::region);
    hand(middle(), 0);
    hand(middle() + vec2(80, 60), 0);
    EXPECT_TRUE(hand(middle() + vec2(80, 60)).settings);
    ASSERT_TRUE(app.render.settings.crop);
    EXPECT_GT(app.render.settings.crop->width(), 10);
}

TEST_F(Panels, FramingEndsWithTheWholeSceneInView) {
    open_scene();
    frame();
    frame_whole_scene(app);
    for (int i = 0; i < 60; ++i) frame();
    EXPECT_FALSE(app.camera.animating);
    const Bounds b = scene_bounds(app.document.prepared->description).value();
    const auto& s = app.render.settings;
    const Viewport port{double(s.width), double(s.height)};
    for (const dvec3& p : {b.lower, b.upper}) {
        const dvec2 at = project(current_view(app), port, p).value();
        EXPECT_TRUE(at.x >= 0 && at.y >= 0 && at.x <= port.width && at.y <= port.height);
    }
}

TEST_F(Panels, StoredViewsGoThroughASessionToTheBit) {
    open_scene();
    frame();
    for (const double x : {0.1, 1.0 / 3}) {
        move_to(app, {{x, 0.2, 3e-7}, {1, x * 7, -2}, 0.7});
        store_bookmark(app);
    }
    App other;
    set_value(other, "views", window_values(app).at("views"));
    ASSERT_EQ(other.camera.bookmarks.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
        const View &a = app.camera.bookmarks[i].view, &b = other.camera.bookmarks[i].view;
        EXPECT_EQ(a.eye, b.eye);
        EXPECT_EQ(a.target, b.target);
        EXPECT_EQ(a.yfov, b.yfov);
    }
    EXPECT_THROW(set_value(other, "views", "1,2,3"), std::invalid_argument);
    EXPECT_THROW(set_value(other, "views", "1,2,3,1,2,3,0.5"), std::invalid_argument);
    recall_bookmark(other, 1);
    EXPECT_FALSE(other.camera.animating) << "there is no scene";
}

TEST_F(Panels, SwitchingBetweenExponentsOfTheSamePathsIsDisplayAlone) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->exponents = {0, 1, 2, 4};
    app.snapshot = snapshot;
    app.render.same_paths = true;
    for (const double b : {0.0, 1.0, 4.0, 2.0}) {
        const Change change = choose_exponent(app, b);
        EXPECT_TRUE(change.display) << b;
        EXPECT_FALSE(change.restarts()) << b;
    }
    EXPECT_TRUE(choose_exponent(app, 3).settings);
    EXPECT_EQ(app.render.free_exponent, 3);
    app.render.same_paths = false;
    EXPECT_TRUE(choose_exponent(app, 1).settings);
    EXPECT_EQ(app.render.free_exponent, 3);
}

TEST_F(Panels, KeysOfTheDisplayNeverRestartARender) {
    open_scene();
    frame();
    int found = 0;
    for (const KeyBinding& b : key_bindings()) {
        if (std::string_view(b.group) != "How it is shown") continue;
        ++found;
        const Change change = b.act(app);
        EXPECT_TRUE(change.display) << b.key;
        EXPECT_FALSE(change.restarts()) << b.key;
    }
    EXPECT_GT(found, 8);
}

TEST_F(Panels, EveryKeyWorksWithoutAScene) {
    frame();
    for (const KeyBinding& b : key_bindings()) {
        b.act(app);
        frame();
    }
}

TEST(Keys, AreBoundOnceAndLeaveFlightItsOwn) {
    std::set<std::tuple<int, int>> bound;
    for (const KeyBinding& b : key_bindings()) {
        EXPECT_TRUE(bound.insert({b.key, b.modifiers}).second) << b.shown << " " << b.key;
        EXPECT_EQ(std::string_view(b.shown).empty(), std::string_view(b.what).empty());
    }
    for (const int key : {GLFW_KEY_W, GLFW_KEY_A, GLFW_KEY_S, GLFW_KEY_D, GLFW_KEY_Q, GLFW_KEY_E})
        EXPECT_FALSE(bound.count({key, no_modifiers})) << key;
}

TEST(Gallery, ShowsEveryAssetWithASentenceAndAPicture) {
    const std::filesystem::path assets = MIDWAY_SOURCE_DIR "/assets";
    std::set<std::string> shown;
    for (const GalleryEntry& e : read_gallery(assets)) {
        EXPECT_FALSE(e.title.empty());
        EXPECT_EQ(e.what_to_try.back(), '.') << e.title;
        EXPECT_LT(e.what_to_try.size(), 120u) << e.title;
        const Picture p = read_picture(e.thumbnail.string());
        EXPECT_EQ(p.width, thumbnail_width) << e.thumbnail;
        EXPECT_EQ(p.height, thumbnail_height) << e.thumbnail;
        std::string scene = e.scene.string();
        if (is_session_path(scene)) {
            const LoadedSession session = read_session(scene);
            EXPECT_TRUE(session.warnings.empty()) << scene;
            scene = session.session.scene.path;
        }
        EXPECT_TRUE(std::filesystem::exists(scene)) << scene;
        shown.insert(std::filesystem::path(scene).filename().string());
    }
    for (const auto& file : std::filesystem::directory_iterator(assets))
        if (file.path().extension() == ".glb")
            EXPECT_TRUE(shown.count(file.path().filename().string())) << file.path();
}

TEST(Gallery, IsEmptyWhereThereIsNone) { EXPECT_TRUE(read_gallery("/nowhere/at/all").empty()); }

}  // namespace
}  // namespace midway::test
