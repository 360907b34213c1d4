// Steps back and forth through what a person changed about a scene: its sky, lamps and materials;
// not the camera and not how it is rendered, which are looked at and not made. Pure data: a step is
// all the wishes as they were, so every one of them comes back to the bit.
#pragma once

#include <optional>
#include <vector>

#include "render/prepare.h"

namespace midway {

inline constexpr size_t most_undo_steps = 200;

struct UndoStack {
    SceneOptions now;                        // as noted last
    std::vector<SceneOptions> past, future;  // the nearest last
    bool open = false;  // the nearest step back still grows: the hand has not let go
};

// Once a frame. While `held` (a slider is being dragged), all changes are one step.
void note_wishes(UndoStack& stack, const SceneOptions& wishes, bool held);

// `wishes` with the scene of one step back, or forth; empty where there is none.
std::optional<SceneOptions> step_back(UndoStack& stack, const SceneOptions& wishes);
std::optional<SceneOptions> step_forth(UndoStack& stack, const SceneOptions& wishes);

// The newest wishes could not be carried out and were taken back: they are no step.
void withdraw(UndoStack& stack, const SceneOptions& wishes);

}  // namespace midway
