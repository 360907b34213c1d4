// Undo: every change of the scene can be taken back and made again to the bit, a drag is one step,
// and the camera is left where it is.
#include "viewer/undo.h"

#include <gtest/gtest.h>

#include <random>

namespace midway::test {
namespace {

SceneOptions wishes(float lamps) {
    SceneOptions o;
    o.path = "a.glb";
    o.lamp_strength = lamps;
    return o;
}

UndoStack stack_at(const SceneOptions& o) { return {.now = o}; }

TEST(Undo, StepsBackAndForth) {
    UndoStack s = stack_at(wishes(1));
    SceneOptions o = wishes(1);
    for (const float x : {2.0f, 3.0f, 4.0f}) {
        o.lamp_strength = x;
        note_wishes(s, o, false);
    }
    for (const float x : {3.0f, 2.0f, 1.0f}) EXPECT_EQ(step_back(s, o)->lamp_strength, x);
    EXPECT_FALSE(step_back(s, o));
    for (const float x : {2.0f, 3.0f, 4.0f}) EXPECT_EQ(step_forth(s, o)->lamp_strength, x);
    EXPECT_FALSE(step_forth(s, o));
}

TEST(Undo, ADragIsOneStep) {
    UndoStack s = stack_at(wishes(1));
    for (int i = 0; i < 50; ++i) note_wishes(s, wishes(2 + 0.1f * static_cast<float>(i)), true);
    note_wishes(s, s.now, false);
    // Another one right after it.
    for (int i = 0; i < 50; ++i) note_wishes(s, wishes(9 + 0.1f * static_cast<float>(i)), true);
    note_wishes(s, s.now, false);
    EXPECT_EQ(s.past.size(), 2u);
    EXPECT_EQ(step_back(s, wishes(0))->lamp_strength, 2 + 0.1f * 49);
    EXPECT_EQ(step_back(s, wishes(0))->lamp_strength, 1);
}

TEST(Undo, ADragBackToWhereItBeganIsNone) {
    UndoStack s = stack_at(wishes(1));
    for (const float x : {2.0f, 3.0f, 1.0f}) note_wishes(s, wishes(x), true);
    note_wishes(s, wishes(1), false);
    EXPECT_TRUE(s.past.empty());
}

TEST(Undo, ANewChangeEndsRedo) {
    UndoStack s = stack_at(wishes(1));
    note_wishes(s, wishes(2), false);
    note_wishes(s, *step_back(s, wishes(2)), false);
    EXPECT_EQ(s.future.size(), 1u);
    note_wishes(s, wishes(3), false);
    EXPECT_FALSE(step_forth(s, wishes(3)));
    EXPECT_EQ(step_back(s, wishes(3))->lamp_strength, 1);
}

TEST(Undo, TheCameraStays) {
    UndoStack s = stack_at(wishes(1));
    SceneOptions o = wishes(2);
    note_wishes(s, o, false);
    o.look_at = {1, 2, 3, 4, 5, 6};
    o.fov_degrees = 20;
    note_wishes(s, o, false);
    EXPECT_EQ(s.past.size(), 1u) << "moving the camera is no step";
    const SceneOptions back = step_back(s, o).value();
    EXPECT_EQ(back.lamp_strength, 1);
    EXPECT_EQ(back.look_at, o.look_at);
    EXPECT_EQ(back.fov_degrees, o.fov_degrees);
    EXPECT_EQ(back.path, "a.glb");
}

TEST(Undo, WhatFailedIsNoStep) {
    UndoStack s = stack_at(wishes(1));
    note_wishes(s, wishes(2), false);
    withdraw(s, wishes(1));
    EXPECT_TRUE(s.past.empty());
    EXPECT_EQ(s.now.lamp_strength, 1);
}

TEST(Undo, IsBounded) {
    UndoStack s = stack_at(wishes(0));
    for (int i = 1; i < 1000; ++i) note_wishes(s, wishes(static_cast<float>(i)), false);
    EXPECT_EQ(s.past.size(), most_undo_steps);
    EXPECT_EQ(step_back(s, s.now)->lamp_strength, 998);
}

// Any walk through the history leads to states that were there before.
TEST(Undo, EveryStateComesBack) {
    std::mt19937 random(3);
    UndoStack s = stack_at(wishes(1));
    std::vector<SceneOptions> history{wishes(1)};
    size_t at = 0;
    for (int i = 0; i < 5000; ++i) {
        const int what = static_cast<int>(random() % 3);
        if (what == 0) {
            SceneOptions o = history[at];
            o.edits.materials.resize(random() % 4);
            for (MaterialEdit& e : o.edits.materials) e.roughness = float(random() % 100) / 100;
            o.sky_rotation_degrees = double(random() % 1000) + 1;
            if (same_scene(o, history[at])) continue;
            note_wishes(s, o, false);
            history.resize(at + 1);
            history.push_back(o);
            ++at;
        } else {
            const auto o = what == 1 ? step_back(s, history[at]) : step_forth(s, history[at]);
            if (!o) continue;
            at += what == 1 ? size_t(-1) : 1;
            ASSERT_LT(at, history.size());
            EXPECT_TRUE(same_scene(*o, history[at]));
            note_wishes(s, *o, false);
        }
    }
}

}  // namespace
}  // namespace midway::test
