// The path inspector: a dock below the image that writes one sample out, the names of its vertices
// in the image, and the numbers of the pixel under the mouse.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/display_maths.h"
#include "viewer/panels/inspector_tables.h"
#include "viewer/panels/parts.h"
#include "viewer/theme.h"
#include "viewer/view.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

// The value and the error of a pixel of the whole image, as the snapshot has them.
struct PixelFacts {
    vec3 value{0};
    std::optional<float> error;  // of the luminance
};

std::optional<PixelFacts> facts_of(const App& app, ivec2 pixel) {
    if (!app.snapshot || app.snapshot->images.empty()) return {};
    const Snapshot& s = *app.snapshot;
    if (!s.crop.contains(pixel.x, pixel.y)) return {};
    const size_t exponent = std::min(shown_exponent(app), s.images.size() - 1);
    const Image& image = *s.images[exponent];
    const ImagePlacement& p = s.placement;
    const int x = static_cast<int>((pixel.x + 0.5 - p.x0) * image.width / (p.x1 - p.x0));
    const int y = static_cast<int>((pixel.y + 0.5 - p.y0) * image.height / (p.y1 - p.y0));
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) return {};
    PixelFacts f{image.at(x, y), {}};
    if (s.scale == 1 && exponent < s.variances.size() && s.variances[exponent])
        f.error = luminance_error(s.variances[exponent]->at(x, y));
    return f;
}

void draw_hover(const App& app) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (!app.ui.view_hovered) return;
    const auto pixel = pixel_at(app, {mouse.x, mouse.y});
    if (!pixel) return;
    const auto facts = facts_of(app, *pixel);
    if (!facts) return;
    ImGui::SetNextWindowPos({app.ui.view.upper.x - em(0.8f), app.ui.view.lower.y + em(0.8f)},
                            ImGuiCond_Always, {1, 0});
    ImGui::SetNextWindowBgAlpha(0.85f);
    ImGui::Begin("##pixel", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
    const vec3& v = facts->value;
    const float light = luminance(v);
    ImGui::TextColored(theme::text_dim, "pixel %d, %d", pixel->x, pixel->y);
    ImGui::Text("RGB  %s  %s  %s", short_value(v.x).c_str(), short_value(v.y).c_str(),
                short_value(v.z).c_str());
    ImGui::Text("luminance  %s", short_value(light).c_str());
    std::string error = "not known yet";
    if (facts->error)
        error = light > 0 ? fmt::format("± {} ({:.2g} %)", short_value(*facts->error),
                                        100 * *facts->error / light)
                          : fmt::format("± {}", short_value(*facts->error));
    ImGui::Text("estimated error  %s", error.c_str());
    const Snapshot& s = *app.snapshot;
    if (s.scale == 1)
        ImGui::TextColored(theme::text_dim, "%llu samples",
                           static_cast<unsigned long long>(s.passes));
    ImGui::End();
}

// Names that stand already: another one over them could not be read.
using Names = std::vector<Rect>;

void draw_name(const PathMark& mark, vec2 at, const theme::Color& color, Names& names) {
    const ImVec2 size = ImGui::CalcTextSize(mark.name.c_str());
    const float gap = em(0.15f);
    const Rect box{at - vec2(gap, 0), at + vec2(size.x + gap, size.y)};
    for (const Rect& r : names)
        if (box.lower.x < r.upper.x && r.lower.x < box.upper.x && box.lower.y < r.upper.y &&
            r.lower.y < box.upper.y)
            return;
    names.push_back(box);
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled({box.lower.x, box.lower.y}, {box.upper.x, box.upper.y},
                       theme::color(theme::rgb(0), 0.65f), em(0.2f));
    draw.AddText({at.x, at.y}, theme::color(color), mark.name.c_str());
}

void draw_mark(const App& app, const PathMark& mark, Names& names) {
    const InspectorState& s = app.ui.panel.inspector;
    const auto at = place_on_image(*s.camera, s.normalisation, mark.at);
    if (!at) return;
    const vec2 p = screen_position(app, *at);
    if (!app.ui.view.contains(p)) return;
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const theme::Color& color = mark.kind == LineKind::camera ? theme::camera : theme::light;
    const float r = em(mark.picked ? 0.26f : 0.18f), fade = mark.hidden ? 0.55f : 1;
    draw.AddCircleFilled({p.x, p.y}, r + 1.2f, theme::color(theme::rgb(0), 0.6f * fade));
    if (mark.hidden)
        draw.AddCircle({p.x, p.y}, r, theme::color(color, fade), 0, em(0.09f));
    else
        draw.AddCircleFilled({p.x, p.y}, r, theme::color(color));
    if (!mark.picked && mark.name != "L0") return;
    draw_name(mark, {p.x + r + em(0.25f), p.y - em(1.1f)}, color, names);
}

// The pixel that was asked about, while the camera is where it was.
void draw_pixel_frame(const App& app, ivec2 pixel) {
    const vec2 a = screen_position(app, vec2(pixel)), b = screen_position(app, vec2(pixel + 1));
    const vec2 middle = 0.5f * (a + b);
    const float half = std::max(0.5f * (b.x - a.x), em(0.45f));
    const ImVec2 low{middle.x - half, middle.y - half}, high{middle.x + half, middle.y + half};
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRect(low, high, theme::color(theme::rgb(0)), 0, 0, em(0.2f));
    draw.AddRect(low, high, theme::color(theme::rgb(0xffffff)), 0, 0, em(0.08f));
}

void draw_over_image(const App& app) {
    const InspectorState& s = app.ui.panel.inspector;
    if (!s.shown || !s.camera) return;
    const Rect& view = app.ui.view;
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.PushClipRect({view.lower.x, view.lower.y}, {view.upper.x, view.upper.y});
    if (!s.camera_moved) draw_pixel_frame(app, s.shown->watched);
    if (s.drawing) {
        Names names;
        for (const bool picked : {true, false})
            for (const PathMark& mark : s.drawing->marks)
                if (mark.picked == picked) draw_mark(app, mark, names);
    }
    draw.PopClipRect();
}

void choose_sample(InspectorState& s, std::uint64_t pass) {
    const ivec2 pixel = s.shown ? s.shown->watched : s.wish.pixel;
    wish_for(s, Find::sample, pixel, pass);
}

void draw_sample_field(InspectorState& s) {
    const std::uint64_t now = s.shown ? s.shown->sample.pass : s.wish.pass;
    ImGui::SameLine();
    ImGui::TextColored(theme::text_dim, "sample");
    ImGui::SameLine();
    ImGui::BeginDisabled(now == 0);
    if (ImGui::ArrowButton("##previous", ImGuiDir_Left)) choose_sample(s, now - 1);
    ui::tip("The sample before");
    ImGui::EndDisabled();
    ImGui::SameLine(0, em(0.2f));
    ImGui::SetNextItemWidth(em(5));
    auto typed = now;
    if (ImGui::InputScalar("##sample", ImGuiDataType_U64, &typed, nullptr, nullptr, nullptr,
                           ImGuiInputTextFlags_EnterReturnsTrue))
        choose_sample(s, std::min(typed, std::max<std::uint64_t>(s.passes, 1) - 1));
    ui::tip("Number of the sample, from 0 on; Enter replays it.");
    ImGui::SameLine(0, em(0.2f));
    ImGui::BeginDisabled(now + 1 >= s.passes);
    if (ImGui::ArrowButton("##next", ImGuiDir_Right)) choose_sample(s, now + 1);
    ui::tip("The next sample");
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (s.passes > 0)
        ImGui::TextColored(theme::text_dim, "of %llu", static_cast<unsigned long long>(s.passes));
    else
        ImGui::TextColored(theme::text_dim, "of a coarse image");
}

void draw_search(App& app) {
    InspectorState& s = app.ui.panel.inspector;
    ImGui::SameLine(0, em(1));
    if (s.progress) {
        ImGui::ProgressBar(*s.progress, {em(9), 0},
                           fmt::format("looking, {:.0f} %", 100 * *s.progress).c_str());
        ui::tip(
            "Replays the samples of the whole image and watches this pixel: splats of light "
            "tracing come from the samples of others.");
        ImGui::SameLine();
        if (ui::wide_button("Stop", "Keeps the brightest of those looked at")) s.stop_search = true;
        return;
    }
    ImGui::BeginDisabled(!s.shown);
    if (ui::wide_button("Brightest of this pixel",
                        "Finds the sample that gave most to this pixel, whosever it was"))
        wish_for(s, Find::brightest, s.shown->watched, 0);
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ui::wide_button("Brightest of the image",
                        "Goes to the pixel that stands out most from its neighbours and finds the "
                        "sample that made it so: the firefly"))
        wish_for(s, Find::brightest_pixel, s.wish.pixel, 0);
    if (!app.snapshot || app.snapshot->statistics.nonfinite.count == 0) return;
    ImGui::SameLine();
    ImGui::PushStyleColor(ImGuiCol_Text, theme::error);
    if (ui::wide_button("Not finite", "Goes to the first sample whose value was not a number"))
        inspect_nonfinite(app);
    ImGui::PopStyleColor();
}

// In words: whose sample it is and what it gave.
void draw_summary(const Inspection& i, const InspectorState& s) {
    const vec3 gave = recorded_in(i.sample, i.watched.x, i.watched.y)[i.exponent];
    ImGui::Text("It gave this pixel %s  (RGB %s, %s, %s) by %d of %d paths.",
                short_value(luminance(gave)).c_str(), short_value(gave.x).c_str(),
                short_value(gave.y).c_str(), short_value(gave.z).c_str(),
                static_cast<int>(std::count_if(i.sample.paths.begin(), i.sample.paths.end(),
                                               [&](const InspectedPath& p) {
                                                   return p.x == i.watched.x && p.y == i.watched.y;
                                               })),
                static_cast<int>(i.sample.paths.size()));
    const bool other = i.sample.x != i.watched.x || i.sample.y != i.watched.y;
    if (other) {
        ImGui::SameLine();
        ImGui::TextColored(theme::light,
                           "It is a sample of pixel %d, %d: its light walk landed here.",
                           i.sample.x, i.sample.y);
    }
    if (s.camera_moved) {
        ImGui::SameLine();
        ImGui::TextColored(theme::text_dim, "The camera has moved since; the path stays in space.");
    }
}

void draw_tables(InspectorState& s) {
    const Inspection& i = *s.shown;
    const InspectedPath* picked =
        s.picked >= 0 && static_cast<size_t>(s.picked) < i.sample.paths.size()
            ? &i.sample.paths[static_cast<size_t>(s.picked)]
            : nullptr;
    const float all = ImGui::GetContentRegionAvail().x;
    const auto child = [&](const char* id, float share) {
        ImGui::BeginChild(id, {share > 0 ? std::floor(all * share) : 0, 0});
    };
    child("##walked", 0.35f);
    draw_vertex_table(i, picked);
    ImGui::EndChild();
    ImGui::SameLine();
    child("##found", 0.255f);
    if (i.sample.paths.empty())
        ui::wrapped(theme::text_dim, "This sample found no light: it gave the image nothing.");
    else
        draw_path_list(i, s.picked);
    ImGui::EndChild();
    ImGui::SameLine();
    child("##ways", 0);
    if (picked) draw_strategy_table(i, *picked);
    ImGui::EndChild();
}

void draw_dock(App& app) {
    InspectorState& s = app.ui.panel.inspector;
    const auto& [x0, y0, x1, y1] = app.ui.panel.dock;
    ImGui::SetNextWindowPos({x0, y0});
    ImGui::SetNextWindowSize({x1 - x0, y1 - y0});
    ImGui::Begin("##inspector", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::AlignTextToFramePadding();
    ImGui::PushFont(theme::heading_font());
    ImGui::TextUnformatted("Path inspector");
    ImGui::PopFont();
    if (s.wish.number > 0) {
        const ivec2 pixel = s.shown ? s.shown->watched : s.wish.pixel;
        ImGui::SameLine(0, em(1));
        ImGui::Text("pixel %d, %d", pixel.x, pixel.y);
        draw_sample_field(s);
    }
    draw_search(app);
    const float close = ImGui::CalcTextSize("Close").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SameLine(ImGui::GetWindowWidth() - close - ImGui::GetStyle().WindowPadding.x);
    if (ui::wide_button("Close", "Puts the inspector away [I]"))
        choose_tool(app, ViewTool::inspect);
    if (s.shown) {
        draw_summary(*s.shown, s);
        draw_tables(s);
    } else {
        ui::wrapped(theme::text_dim,
                    !s.note.empty() ? s.note
                    : s.wish.number > s.answered
                        ? "One moment."
                        : "Click a pixel: one of its samples is computed again and written out "
                          "here, its walks from the camera and from a light, every full path that "
                          "they make, and how all strategies share in each. Dragging still turns "
                          "the camera.");
    }
    ImGui::End();
}

void draw_button(App& app) {
    if (!ui::begin_section(app, ui::Side::right, "Path inspector", true)) return;
    const bool on = app.ui.panel.navigation.tool == ViewTool::inspect;
    if (ui::wide_button(on ? "Click a pixel in the image" : "Inspect a pixel",
                        "Computes one sample of a pixel again and shows all of its paths. [I]",
                        ui::share_of_width(1)))
        choose_tool(app, ViewTool::inspect);
    ui::end_section(app);
}

}  // namespace

void inspect_pixel(App& app, ivec2 pixel) {
    InspectorState& s = app.ui.panel.inspector;
    wish_for(s, Find::sample, pixel, s.shown && !s.shown->searched ? s.shown->sample.pass : 0);
}

bool inspect_nonfinite(App& app) {
    // Places in a coarse image are none of the image's own.
    if (!app.snapshot || app.snapshot->scale != 1) return false;
    const NonFinite& n = app.snapshot->statistics.nonfinite;
    if (n.count == 0) return false;
    app.ui.panel.navigation.tool = ViewTool::inspect;
    wish_for(app.ui.panel.inspector, Find::sample, {n.x, n.y}, n.pass);
    return true;
}

Change draw_inspector(App& app) {
    draw_button(app);
    if (app.ui.panel.navigation.tool != ViewTool::inspect) return {};
    draw_hover(app);
    draw_over_image(app);
    if (app.ui.panels) draw_dock(app);
    return {};
}

}  // namespace midway
