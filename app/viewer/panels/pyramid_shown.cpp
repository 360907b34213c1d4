// Over the view, while strategies are shown there: which ones, and the way back to the image.
#include <algorithm>

#include "viewer/panels/parts.h"
#include "viewer/pyramid_words.h"
#include "viewer/strategy_view.h"
#include "viewer/widgets.h"

namespace midway {

using ui::em;

Change draw_shown_strategies(App& app) {
    if (!shows_strategies(app)) return {};
    const PyramidChoices& p = app.display.pyramid;
    const Rect& v = app.ui.view;
    ImGui::SetNextWindowPos({v.upper.x - em(0.8f), v.lower.y + em(0.8f)}, ImGuiCond_Always, {1, 0});
    ImGui::SetNextWindowBgAlpha(0.9f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, em(0.3f));
    ImGui::Begin("##shown strategies", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
    ImGui::PopStyleVar();
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + std::max(em(10), v.size().x - em(3)));
    const size_t listed = std::min<size_t>(p.selected.size(), 4);
    for (size_t i = 0; i < listed; ++i) {
        const std::string sign = i > 0 ? "+ " : "";
        ImGui::TextUnformatted((sign + strategy_name(p.selected[i])).c_str());
    }
    if (p.selected.size() > listed) ImGui::Text("+ %zu more", p.selected.size() - listed);
    const bool full = strategies_at_full_size(app);
    std::string how = p.bare ? "bare estimates" : "weighted";
    how += full ? ", " + samples_in_words(app.snapshot->strategies->selected_passes)
           : app.snapshot && app.snapshot->finished
               ? ", enlarged: the image was done before it was chosen"
               : ", enlarged until its first pass is done";
    ImGui::TextColored(theme::text_dim, "%s", how.c_str());
    ImGui::PopTextWrapPos();
    Change change;
    if (ui::wide_button("Back to the image", "Show the whole image again [Esc]")) {
        show_whole_image(app);
        change.display = true;
    }
    ImGui::End();
    return change;
}

}  // namespace midway
