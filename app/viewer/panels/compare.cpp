// A and B: which images are kept, which of them is A, and how the live image, B, is held against
// it.
#include <fmt/format.h>
#include <imgui.h>
// After imgui.h.
#include <imgui_stdlib.h>

#include <array>

#include "viewer/comparing.h"
#include "viewer/comparison.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

constexpr theme::Color no_color{0, 0, 0, 0};

// One line of the list; true where it was chosen.
bool entry(const std::string& name, bool chosen, bool enabled, const char* tooltip, bool& removed) {
    const float cross = ImGui::GetFrameHeight();
    const float width = ImGui::GetContentRegionAvail().x - cross;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::BeginDisabled(!enabled);
    const bool clicked = ImGui::Selectable("##entry", chosen, 0, {width, 0});
    ImGui::EndDisabled();
    ui::tip(tooltip);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (chosen) draw.AddText({at.x + em(0.2f), at.y}, theme::color(theme::text), "A");
    draw.AddText({at.x + em(1.2f), at.y},
                 theme::color(chosen ? theme::text : theme::text_dim, enabled ? 1.0f : 0.6f),
                 ui::fitted(name, width - em(1.4f)).c_str());
    ImGui::SameLine(0, 0);
    removed = ImGui::SmallButton("x");
    ui::tip("Forgets this image");
    return clicked;
}

void draw_list(App& app) {
    CompareState& c = app.compare;
    std::optional<std::uint64_t> gone;
    for (const KeptImage& k : c.kept) {
        ImGui::PushID(static_cast<int>(k.id));
        bool removed = false;
        const std::string tip = fmt::format("{}\n{} x {} pixels. Click to make it A.", k.caption,
                                            k.image->width, k.image->height);
        if (entry(k.name, c.chosen == k.id, true, tip.c_str(), removed)) c.chosen = k.id;
        if (removed) gone = k.id;
        ImGui::PopID();
    }
    if (gone) forget_image(c, *gone);
    if (c.reference && c.reference->shown) {
        bool removed = false;
        const std::string name = "reference " + c.reference->shown->name;
        if (entry(name, c.chosen == reference_id, true,
                  "The reference that errors are measured against. Click to make it A.", removed))
            c.chosen = reference_id;
        if (removed) ask(app, ActionKind::load_reference);
    }
    if (!c.kept.empty())
        ui::wrapped(theme::text_dim,
                    fmt::format("{} of {} kept, {:.1f} MB, until the window closes", c.kept.size(),
                                most_kept, static_cast<double>(kept_bytes(c)) / 1e6));
}

void draw_name(App& app) {
    CompareState& c = app.compare;
    for (KeptImage& k : c.kept) {
        if (k.id != c.chosen) continue;
        ui::row("Name of A", "What this image is called in the list.");
        ImGui::InputText("##name", &k.name);
    }
}

Change draw_view(App& app) {
    Change change;
    CompareState& c = app.compare;
    const bool possible = image_a(app) != nullptr;
    const bool laid_over = possible && view_refusal(app).empty();
    const std::array<ui::Choice, 4> views = {{
        {"B", "The live image alone."},
        {"A", "The kept image alone. [Y] flips to it and back; held, it shows A while it is down."},
        {"Wipe", "A left of a line, B right of it; drag the line.", theme::rgb(0xa8a8a8), no_color,
         laid_over},
        {"B - A", "What B has more (orange) or less (blue) of than A.", theme::rgb(0x6fa8ff),
         theme::light, laid_over},
    }};
    ImGui::BeginDisabled(!possible);
    int view = static_cast<int>(c.view);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    if (ui::segmented("view", views, view)) {
        change = choose_compare(app, static_cast<CompareView>(view));
    }
    ImGui::EndDisabled();
    if (view_in_use(app) != CompareView::difference) return change;
    ui::row("Difference", "As it is, or as a share of A's brightness.");
    constexpr std::array<ui::Choice, 2> kinds = {{
        {"Absolute", "Luminance of B less that of A, after exposure; white is 1."},
        {"Relative",
         "The same as a share of A's luminance; a tenth of A's mean is added below, "
         "as relMSE has it, so that black pixels do not blow it up."},
    }};
    int kind = c.relative ? 1 : 0;
    if (ui::segmented("kind", kinds, kind)) {
        c.relative = kind == 1;
        change.display = true;
    }
    ui::row("Scale ends at", "The difference that has the brightest colour, either way.");
    float& range = c.relative ? c.relative_range : c.range;
    float shown = c.relative ? 100 * range : range;
    if (ImGui::DragFloat("##range", &shown, shown * 0.01f, 1e-4f, 1e4f,
                         c.relative ? "+- %.3g %%" : "+- %.3g",
                         ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic)) {
        range = c.relative ? shown / 100 : shown;
        change.display = true;
    }
    return change;
}

void draw_notes(const App& app) {
    if (!image_a(app)) {
        ui::wrapped(theme::text_dim,
                    "Keep an image, then change the technique, the exponent or a setting: the live "
                    "image is B.");
        return;
    }
    if (const std::string why = view_refusal(app); !why.empty())
        ui::note(theme::light, "A is of another view: " + why +
                                   ". It can be looked at, but neither wiped nor subtracted.");
    else if (const std::string remark = a_remark(app); !remark.empty())
        ui::note(theme::light, "A is of before: " + remark + ".");
    if (app.display.channel != Channel::image)
        ui::note(theme::text_dim, "Only the channel \"Image\" is compared.");
}

}  // namespace

Change choose_compare(App& app, CompareView view) {
    if (view != CompareView::live && !image_a(app)) return {.display = true};
    app.compare.view = view;
    if (view != CompareView::live) app.display.channel = Channel::image;
    return {.display = true};
}

Change keep_as_a(App& app) {
    if (!app.document.prepared) return {};
    ask(app, ActionKind::keep_image);
    app.ui.panel.arrangement.sections["Compare"] = true;
    return {.display = true};
}

Change draw_compare(App& app) {
    if (!ui::begin_section(app, ui::Side::right, "Compare", false)) return {};
    CompareState& c = app.compare;
    Change change;
    ImGui::BeginDisabled(!app.document.prepared || c.kept.size() >= most_kept);
    if (ui::wide_button("Keep this image as A",
                        "Keeps what is shown now, to hold it against what comes. [Shift+Y]", -1))
        change |= keep_as_a(app);
    ImGui::EndDisabled();
    draw_list(app);
    draw_name(app);
    change |= draw_view(app);
    draw_notes(app);
    if (view_in_use(app) != CompareView::live &&
        ui::wide_button("Save this picture", "As it is seen, as PNG. [Ctrl+P]", -1))
        ask(app, ActionKind::save_image,
            free_name(app.ui.panel.files.save_name + "-compared", ".png"));
    ui::end_section(app);
    return change;
}

}  // namespace midway
