// The strategy pyramid: every way to find light as a picture of its own, beside the image that
// they add up to.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "viewer/panels/parts.h"
#include "viewer/pyramid_layout.h"
#include "viewer/pyramid_words.h"
#include "viewer/strategy_view.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

constexpr ImGuiWindowFlags fixed =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse;

constexpr std::array<ui::Choice, 2> kinds = {{
    {"Weighted",
     "What each strategy gives to the image: its estimates times their MIS weights. "
     "All cells add up to the image."},
    {"Bare",
     "What each strategy would find alone, before its MIS weight: where it is bright and "
     "noisy, the weights have to hold it down."},
}};
constexpr std::array<ui::Choice, 3> bars = {{
    {"Light", "Bars and numbers: the strategy's share of the image's light."},
    {"Noise",
     "Bars and numbers: its share of the image's variance, from the second moment of its "
     "weighted contributions. A strategy with little light and much noise makes fireflies."},
    {"Rays",
     "Bars and numbers: its share of the shadow rays. Emitter hits need none: they come "
     "with the walk."},
}};

const char* name_of(PyramidShare share) {
    return share == PyramidShare::light   ? "light"
           : share == PyramidShare::noise ? "noise"
                                          : "shadow rays";
}

const StrategySnapshot* drawn(const App& app) { return app.ui.panel.pyramid.drawn.get(); }

void small_text(vec2 at, const theme::Color& color, const std::string& text) {
    ImGui::GetWindowDrawList()->AddText(ImGui::GetFont(), em(0.82f), {at.x, at.y},
                                        theme::color(color), text.c_str());
}

float small_width(const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x * 0.82f; }

std::string state_in_words(const App& app) {
    const auto s = app.snapshot ? app.snapshot->strategies : nullptr;
    if (s && s->passes > 0) return "from " + samples_in_words(s->passes);
    if (app.snapshot && app.snapshot->finished) return "the image is done: cells need new samples";
    if (app.render.paused) return "paused: fills when the render goes on (Space)";
    return "fills with the next pass";
}

Change draw_header(App& app) {
    Change change;
    PyramidChoices& p = app.display.pyramid;
    ImGui::PushFont(theme::heading_font());
    ImGui::TextUnformatted("Strategy pyramid");
    ImGui::PopFont();
    const float width = ImGui::GetWindowWidth();
    ImGui::SameLine();
    const std::string state =
        ui::fitted(state_in_words(app), width - ImGui::GetCursorPosX() - em(2.6f));
    ImGui::TextColored(theme::text_dim, "%s", state.c_str());
    ImGui::SameLine(width - em(2.1f));
    if (ImGui::SmallButton("x")) {
        open_pyramid(app, false);
        change.display = true;
    }
    ui::tip("Close the pyramid [Shift+P]. While it is closed it costs nothing.");

    int kind = p.bare, bar = static_cast<int>(p.share);
    ImGui::SetNextItemWidth(std::min(em(11), width * 0.3f));
    change.display |= ui::segmented("kind", kinds, kind);
    p.bare = kind != 0;
    ImGui::SameLine(0, em(0.8f));
    ImGui::SetNextItemWidth(std::min(em(12), width * 0.34f));
    change.display |= ui::segmented("bars", bars, bar);
    p.share = static_cast<PyramidShare>(bar);
    ImGui::SameLine(0, em(0.8f));
    change.display |= ImGui::Checkbox("Own exposure", &p.own_exposure);
    ui::tip(
        "Every cell at an exposure of its own, so that dim ones can be seen; else all as the "
        "image, so that they can be compared.");
    return change;
}

// Where a limit was met before the pyramid was opened, nothing would ever come: the way on.
Change draw_way_on(App& app) {
    const auto s = app.snapshot;
    if (!s || !s->finished || !s->strategies || s->strategies->passes > 0) return {};
    if (!ui::wide_button("Go on: as many samples again",
                         "Raises the limits under Run; the image goes on refining, and the cells "
                         "fill with the new samples."))
        return {};
    RenderLimits& limits = app.render.limits;
    if (limits.spp) limits.spp = std::max(*limits.spp, s->passes) + s->passes;
    if (limits.seconds) limits.seconds = std::max(*limits.seconds, s->seconds) + s->seconds;
    return {.settings = true};
}

// The part of the texture that holds a cell; half a texel inwards, so that no neighbour shows.
void draw_thumbnail(const App& app, const Strategy& k, const Rect& r) {
    const StrategySnapshot* s = drawn(app);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 a{r.lower.x, r.lower.y}, b{r.upper.x, r.upper.y};
    draw.AddRectFilled(a, b, theme::color(theme::rgb(0)));
    if (!s || app.ui.panel.pyramid.picture == 0) return;
    for (size_t i = 0; i < s->cells.size(); ++i) {
        if (!(s->cells[i].found.strategy == k)) continue;
        const vec2 size(s->weighted->width, s->weighted->height);
        const vec2 tile(s->tile_width, s->tile_height);
        const int column = static_cast<int>(i) % s->columns, row = static_cast<int>(i) / s->columns;
        const vec2 low = (vec2(column, row) * tile + 0.5f) / size;
        const vec2 high = (vec2(column + 1, row + 1) * tile - 0.5f) / size;
        const auto id = static_cast<std::intptr_t>(app.ui.panel.pyramid.picture);
        draw.AddImage(reinterpret_cast<ImTextureID>(id), a, b, {low.x, low.y}, {high.x, high.y});
    }
}

void draw_struck(const Rect& r, bool hovered) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 a{r.lower.x, r.lower.y}, b{r.upper.x, r.upper.y};
    draw.AddRectFilled(a, b, theme::color(theme::rgb(0x1b1b1b)));
    const ImU32 ink = theme::color(hovered ? theme::text_dim : theme::rgb(0x4a4a4a));
    draw.AddRect(a, b, ink);
    draw.AddLine({a.x, b.y}, {b.x, a.y}, ink, std::max(1.0f, em(0.08f)));
}

void tooltip(const App& app, const Strategy& k, const std::string& left_out) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(em(25));
    ImGui::PushFont(theme::heading_font());
    const std::string name = strategy_name(k);
    ImGui::TextUnformatted(k == Strategy{1, 1} ? "camera 1 · light 1" : name.c_str());
    ImGui::PopFont();
    ImGui::TextUnformatted(what_it_does(k).c_str());
    const StrategySnapshot* s = drawn(app);
    const CellSnapshot* cell = s ? s->find(k) : nullptr;
    if (!left_out.empty()) {
        ImGui::TextColored(theme::light, "%s", ("Left out: " + left_out + ".").c_str());
    } else if (cell) {
        const CellShares shares = shares_of(*s, k);
        ImGui::TextColored(theme::text_dim, "light %s    noise %s    shadow rays %s",
                           percent(shares.light).c_str(), percent(shares.noise).c_str(),
                           percent(shares.rays).c_str());
        const std::string found = ui::short_number(double(cell->found.samples));
        const double samples = double(s->passes) * double(app.snapshot->crop.area());
        const std::string all =
            ui::short_number(samples / (app.snapshot->scale * app.snapshot->scale));
        ImGui::TextColored(theme::text_dim, "%s contributions from %s samples of pixels",
                           found.c_str(), all.c_str());
        ImGui::TextColored(theme::text_dim, "Click: show it large. Ctrl or Shift: add it.");
    }
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

// The share as a bar and a number, below the thumbnail; the largest share has the longest bar.
void draw_share(const App& app, const Strategy& k, const Rect& r, double largest) {
    const StrategySnapshot* s = drawn(app);
    if (!s) return;
    const double share = shares_of(*s, k).of(app.display.pyramid.share);
    const theme::Color color = k == longer_paths ? theme::text_dim : family_color(family_of(k));
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float top = r.upper.y + em(0.12f), thick = std::max(2.0f, em(0.2f));
    const float width = r.size().x;
    draw.AddRectFilled({r.lower.x, top}, {r.upper.x, top + thick}, theme::color(theme::frame));
    const float length =
        std::max(share > 0 ? 1.0f : 0.0f, width * static_cast<float>(share / largest));
    draw.AddRectFilled({r.lower.x, top}, {r.lower.x + length, top + thick}, theme::color(color));
    const std::string text = percent(share);
    if (small_width(text) > width) return;
    small_text({r.lower.x, top + thick}, share >= 0.01 ? theme::text : theme::text_dim, text);
}

Change draw_cell(App& app, const PyramidCell& cell, double largest) {
    const PyramidChoices& p = app.display.pyramid;
    const Rect& r = cell.thumbnail;
    const Strategy& k = cell.strategy;
    const std::string left_out = left_out_reason(app, k);
    ImGui::PushID(k.s * 100 + k.t);
    ImGui::SetCursorScreenPos({r.lower.x, r.lower.y});
    const bool clicked = ImGui::InvisibleButton("cell", {r.size().x, r.size().y});
    const bool hovered = ImGui::IsItemHovered();
    ImGui::PopID();
    const vec2 middle = 0.5f * (r.lower + r.upper);
    app.ui.panel.pyramid.cells.push_back({k.s, k.t, middle.x, middle.y, !left_out.empty()});
    if (hovered) tooltip(app, k, left_out);
    if (!left_out.empty()) {
        draw_struck(r, hovered);
        return {};
    }
    draw_thumbnail(app, k, r);
    draw_share(app, k, r, largest);
    const bool chosen = std::ranges::find(p.selected, k) != p.selected.end();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (chosen || hovered)
        draw.AddRect({r.lower.x - 2, r.lower.y - 2}, {r.upper.x + 2, r.upper.y + 2},
                     theme::color(chosen ? theme::rgb(0xffffff) : theme::text_dim), 0, 0,
                     chosen ? 2.0f : 1.0f);
    else
        draw.AddRect({r.lower.x, r.lower.y}, {r.upper.x, r.upper.y}, theme::color(theme::line));
    if (!clicked) return {};
    const ImGuiIO& io = ImGui::GetIO();
    choose_strategy(app, k, io.KeyCtrl || io.KeyShift);
    return {.display = true};
}

// Each row's name at the left, and what its cells add up to at the right.
void draw_row(const App& app, const PyramidRow& row, const PyramidRoom& room, float height) {
    const float y = row.top + 0.5f * height - em(0.41f);
    small_text({room.rect.lower.x, y}, theme::text, row_name(row));
    const StrategySnapshot* s = drawn(app);
    if (!s) return;
    double sum = 0;
    for (const CellSnapshot& c : s->cells) {
        const Strategy& k = c.found.strategy;
        const int edges = k == longer_paths ? cell_edges + 1 : k.edges();
        if (edges == row.edges) sum += shares_of(*s, k).of(app.display.pyramid.share);
    }
    const std::string text = percent(sum);
    small_text({room.rect.upper.x - small_width(text), y}, theme::text_dim, text);
}

void draw_key(const App& app, vec2 at) {
    struct Entry {
        Family family;
        const char* name;
    };
    constexpr std::array<Entry, 4> entries = {{{Family::emitter_hit, "emitter hit"},
                                               {Family::next_event, "next event"},
                                               {Family::connection, "connection"},
                                               {Family::light_tracing, "light tracing"}}};
    small_text(
        at, theme::text_dim,
        app.display.pyramid.bare
            ? "Each cell: what one way of sharing a path's vertices would find alone."
            : "Each cell: the light that one strategy gives. All cells add up to the image.");
    at.y += em(1.15f);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (const Entry& e : entries) {
        const float side = em(0.6f);
        draw.AddRectFilled({at.x, at.y + em(0.12f)}, {at.x + side, at.y + em(0.12f) + side},
                           theme::color(family_color(e.family)));
        small_text({at.x + side + em(0.3f), at.y}, theme::text_dim, e.name);
        at.x += side + em(0.9f) + small_width(e.name);
    }
    const std::string what =
        fmt::format("bars: share of the {}", name_of(app.display.pyramid.share));
    const float right = app.ui.panel.pyramid.place[2] - em(1.1f);
    if (at.x + small_width(what) < right)
        small_text({right - small_width(what), at.y}, theme::text_dim, what);
}

// In the corners that the triangle leaves: which side is whose.
void draw_sides(const PyramidRoom& room, const PyramidLayout& layout) {
    if (layout.cells.size() < 2) return;
    const float y = layout.rows.front().top;
    const float left = layout.cells[0].thumbnail.lower.x, right = layout.cells[1].thumbnail.upper.x;
    const std::string camera = "from the camera", light = "from the light";
    const float need = small_width(camera) + em(1);
    if (left - room.rect.lower.x - room.left < need) return;
    small_text({left - need, y}, theme::camera, camera);
    small_text({right + em(1), y}, theme::light, light);
}

double largest_share(const App& app) {
    double largest = 1e-6;
    if (const StrategySnapshot* s = drawn(app))
        for (const CellSnapshot& c : s->cells)
            largest =
                std::max(largest, shares_of(*s, c.found.strategy).of(app.display.pyramid.share));
    return largest;
}

Change draw_cells(App& app) {
    PyramidPanel& panel = app.ui.panel.pyramid;
    const auto s = app.snapshot;
    const double width = s ? s->crop.width() : app.render.settings.width;
    const double height = s ? s->crop.height() : app.render.settings.height;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float below = em(2.7f);
    PyramidRoom room;
    room.rect = {{at.x, at.y + em(0.3f)}, {panel.place[2] - em(1.1f), panel.place[3] - below}};
    room.left = small_width("8 and more") + em(0.7f);
    room.right = small_width("100 %") + em(0.5f);
    room.caption = em(0.12f) + std::max(2.0f, em(0.2f)) + em(0.9f);
    room.gap = em(0.3f);
    room.aspect = static_cast<float>(std::clamp(width / std::max(1.0, height), 0.2, 5.0));
    const PyramidLayout layout = lay_out_pyramid(room, app.render.settings.max_bounces);
    for (const PyramidRow& row : layout.rows) draw_row(app, row, room, layout.thumbnail.y);
    draw_sides(room, layout);
    draw_key(app, {at.x, panel.place[3] - below + em(0.2f)});
    Change change;
    panel.cells.clear();
    const double largest = largest_share(app);
    for (const PyramidCell& cell : layout.cells) change |= draw_cell(app, cell, largest);
    return change;
}

// The edge between image and pyramid can be dragged.
void draw_edge(App& app) {
    PyramidPanel& panel = app.ui.panel.pyramid;
    const float width = em(0.4f), height = panel.place[3] - panel.place[1];
    ImGui::SetCursorScreenPos({panel.place[0], panel.place[1]});
    ImGui::InvisibleButton("edge", {width, height});
    const bool held = ImGui::IsItemActive();
    if (held || ImGui::IsItemHovered()) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
        ImGui::GetWindowDrawList()->AddRectFilled({panel.place[0], panel.place[1]},
                                                  {panel.place[0] + width / 2, panel.place[3]},
                                                  theme::color(theme::rgb(0x5a5a5a)));
    }
    const float room = panel.place[2] - app.ui.view.lower.x;
    if (held && room > 1)
        panel.share = std::clamp((panel.place[2] - ImGui::GetIO().MousePos.x) / room, 0.25f, 0.85f);
}

}  // namespace

Change draw_pyramid(App& app) {
    if (!app.display.pyramid.open) return {};
    update_left_out(app);
    const std::array<float, 4>& place = app.ui.panel.pyramid.place;
    ImGui::SetNextWindowPos({place[0], place[1]});
    ImGui::SetNextWindowSize({place[2] - place[0], place[3] - place[1]});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, theme::rgb(0x262626));
    ImGui::Begin("##pyramid", nullptr, fixed);
    ImGui::PopStyleColor();
    Change change = draw_header(app);
    change |= draw_way_on(app);
    change |= draw_cells(app);
    draw_edge(app);
    ImGui::End();
    return change;
}

}  // namespace midway
