// Lights and materials in the window: words and clicks make the same edits, what is selected is
// what is seen, and the lists hold what shines.
#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>

#include "viewer/edits.h"
#include "viewer/panels/panels.h"
#include "viewer/panels/parts.h"
#include "viewer/view.h"

namespace midway::test {
namespace {

class EditPanels : public testing::Test {
  protected:
    EditPanels() {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().DisplaySize = {1280, 1200};
        apply_theme(1);
    }
    ~EditPanels() override { ImGui::DestroyContext(); }

    void open(const std::string& asset) {
        app.document.path = app.document.options.path = MIDWAY_SOURCE_DIR "/assets/" + asset;
        app.document.prepared =
            std::make_shared<PreparedScene>(prepare_scene(app.document.options));
        app.undo = {.now = app.document.options};
        for (int i = 0; i < 3; ++i) frame();
    }
    Change frame() {
        ImGui::GetIO().DeltaTime = 1.0f / 60;
        ImGui::NewFrame();
        Change change;
        for (const Panel& p : panels()) change |= p.draw(app);
        note_wishes(app.undo, app.document.options, ImGui::IsAnyItemActive());
        ImGui::Render();
        return change;
    }
    Change hand(vec2 at, bool down) {
        ImGui::GetIO().MousePos = {at.x, at.y};
        ImGui::GetIO().MouseDown[0] = down;
        return frame();
    }
    Change click(vec2 at) {
        hand(at, false);
        Change change = hand(at, true);
        return change |= hand(at, false);
    }
    vec2 in_section(const char* title, vec2 shift) const {
        const auto& place = app.ui.panel.section_places.at(title);
        return vec2(place[0], place[1]) + shift;
    }
    SceneEdits& edits() { return app.document.options.edits; }

    App app;
};

TEST_F(EditPanels, ListWhatShines) {
    open("five-lights.glb");
    std::vector<std::string> names;
    for (const Lamp& lamp : lamps(app)) names.push_back(lamp_name(app, lamp));
    EXPECT_EQ(names,
              (std::vector<std::string>{"point lamp", "spot lamp", "directional lamp", "panel"}));
    const int clay = 1;
    ASSERT_EQ(app.document.prepared->file->materials[clay].name, "clay");
    EXPECT_TRUE(edit_by_name(app, {"material", "clay", "emission_strength", "2"}).scene);
    const Lamp lamp{LampKind::material, clay};
    std::vector<Lamp> list = lamps(app);
    EXPECT_EQ(list.size(), 5u);
    EXPECT_NE(std::find(list.begin(), list.end(), lamp), list.end());
    // Off is not gone.
    switch_lamp(app, lamp, false);
    EXPECT_EQ(lamps(app).size(), 5u);
    EXPECT_FALSE(lamp_is_on(app, lamp));
    edit_by_name(app, {"material", "clay", "emission_strength", "file"});
    EXPECT_EQ(lamps(app).size(), 4u);
}

TEST_F(EditPanels, TheSwitchOfAListRowSwitchesTheLamp) {
    open("five-lights.glb");
    const vec2 first = in_section("Lights", {20, 1.7f * ImGui::GetFrameHeight()});
    EXPECT_TRUE(click(first).scene);
    ASSERT_EQ(edits().lights.size(), 1u);
    EXPECT_EQ(edits().lights[0], (LightEdit{.name = "point lamp", .index = 0, .on = false}));
    frame();
    EXPECT_EQ(app.undo.past.size(), 1u);
    EXPECT_TRUE(click(first).scene);
    EXPECT_TRUE(edits().empty());
    frame();
    EXPECT_TRUE(undo_edit(app).scene);
    EXPECT_FALSE(lamp_is_on(app, {LampKind::light, 0}));
    EXPECT_TRUE(undo_edit(app).scene);
    EXPECT_TRUE(lamp_is_on(app, {LampKind::light, 0}));
    EXPECT_FALSE(undo_edit(app).any());
}

TEST_F(EditPanels, DraggingAStrengthIsOneStep) {
    open("five-lights.glb");
    const auto& place = app.ui.panel.section_places.at("Lights");
    const vec2 number(place[2] - 30, place[1] + 1.7f * ImGui::GetFrameHeight());
    hand(number, false);
    hand(number, true);
    int changes = 0;
    for (int i = 1; i <= 20; ++i)
        changes += hand(number + vec2(4.0f * static_cast<float>(i), 0), true).scene;
    hand(number + vec2(80, 0), false);
    frame();
    EXPECT_GT(changes, 10);
    ASSERT_EQ(edits().lights.size(), 1u);
    EXPECT_GT(edits().lights[0].strength.value_or(0), 0.65f);
    EXPECT_EQ(app.undo.past.size(), 1u);
    undo_edit(app);
    EXPECT_TRUE(edits().empty());
}

TEST_F(EditPanels, AClickWithTheToolSelectsWhatIsSeenAndADragOrbits) {
    open("cornell.glb");
    choose_tool(app, ViewTool::select);
    const vec2 middle = 0.5f * (app.ui.view.lower + app.ui.view.upper);
    EXPECT_FALSE(click(middle).camera);
    const Selection& s = app.ui.panel.selection;
    ASSERT_GE(s.instance, 0);
    const auto& instance =
        app.document.prepared->description.instances[static_cast<size_t>(s.instance)];
    EXPECT_EQ(instance.material, s.material);
    // The point that was clicked is where the mouse is.
    const Viewport port{double(app.render.settings.width), double(app.render.settings.height)};
    const auto at = project(current_view(app), port, s.point);
    ASSERT_TRUE(at);
    const vec2 back = screen_position(app, vec2(*at));
    EXPECT_NEAR(back.x, middle.x, 0.1f);
    EXPECT_NEAR(back.y, middle.y, 0.1f);

    app.ui.panel.selection.material = -1;
    hand(middle, true);
    EXPECT_TRUE(hand(middle + vec2(40, 0), true).camera);
    hand(middle + vec2(40, 0), false);
    EXPECT_EQ(s.material, -1);
    EXPECT_EQ(app.ui.panel.navigation.tool, ViewTool::select) << "the tool stays in hand";
}

TEST_F(EditPanels, WhatAFileNoLongerHoldsIsNotSelected) {
    open("cornell.glb");
    select_material(app, 1);
    EXPECT_EQ(selected_material(app), 1);
    app.ui.panel.selection.material_name = "another";
    EXPECT_EQ(selected_material(app), -1);
    select_material(app, 1);
    app.ui.panel.selection.material = 1000;
    frame();
    EXPECT_EQ(selected_material(app), -1);
}

TEST_F(EditPanels, WordsThatMakeNoSenseAreRefused) {
    EXPECT_THROW(edit_by_name(app, {"sky", "on", "off"}), std::invalid_argument);
    open("five-lights.glb");
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"material", "clay", "roughness", "2"},
          {"material", "clay", "roughness", "smooth"},
          {"material", "clay", "colour", "1"},
          {"material", "no such", "roughness", "1"},
          {"material", "99", "roughness", "1"},
          {"material", "clay", "base_color", "1,2"},
          {"material", "clay", "base_color", "0.1,0.2,3"},
          {"light", "point lamp", "kind", "area"},
          {"light", "point lamp", "on", "perhaps"},
          {"lamp", "point lamp", "on", "off"},
          {"sky", "on"},
          {"light", "point lamp"}})
        EXPECT_THROW(edit_by_name(app, words), std::invalid_argument) << words.back();
    EXPECT_TRUE(edits().empty());
}

TEST_F(EditPanels, ResettingAllComesBackByUndo) {
    open("five-lights.glb");
    edit_by_name(app, {"light", "1", "kind", "point"});
    edit_by_name(app, {"sky", "on", "off"});
    app.document.options.sky = "0.1,0.1,0.1";
    app.document.options.look_at = {1, 2, 3, 0, 0, 0};
    frame();
    const SceneOptions before = app.document.options;
    EXPECT_TRUE(reset_scene(app).scene);
    EXPECT_FALSE(is_edited(app));
    EXPECT_EQ(app.document.options.look_at, before.look_at);
    EXPECT_EQ(app.document.options.path, before.path);
    frame();
    undo_edit(app);
    EXPECT_TRUE(same_scene(app.document.options, before));
}

}  // namespace
}  // namespace midway::test
