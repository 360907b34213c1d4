#include "viewer/undo.h"

#include <utility>

namespace midway {
namespace {

void drop_empty_steps(UndoStack& s) {
    while (!s.past.empty() && same_scene(s.past.back(), s.now)) s.past.pop_back();
}

std::optional<SceneOptions> step(UndoStack& s, std::vector<SceneOptions>& from,
                                 std::vector<SceneOptions>& to, const SceneOptions& wishes) {
    s.open = false;
    if (from.empty()) return {};
    to.push_back(std::exchange(s.now, std::move(from.back())));
    from.pop_back();
    return with_scene_of(s.now, wishes);
}

}  // namespace

void note_wishes(UndoStack& s, const SceneOptions& wishes, bool held) {
    if (!same_scene(s.now, wishes)) {
        if (!s.open) s.past.push_back(s.now);
        if (s.past.size() > most_undo_steps) s.past.erase(s.past.begin());
        s.future.clear();
        s.now = wishes;
        s.open = true;
    }
    if (held || !s.open) return;
    s.open = false;
    drop_empty_steps(s);
}

std::optional<SceneOptions> step_back(UndoStack& s, const SceneOptions& wishes) {
    return step(s, s.past, s.future, wishes);
}

std::optional<SceneOptions> step_forth(UndoStack& s, const SceneOptions& wishes) {
    return step(s, s.future, s.past, wishes);
}

void withdraw(UndoStack& s, const SceneOptions& wishes) {
    s.now = wishes;
    s.open = false;
    drop_empty_steps(s);
}

}  // namespace midway
