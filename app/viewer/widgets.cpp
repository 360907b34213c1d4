#include "viewer/widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

#include "viewer/theme.h"

namespace midway::ui {
namespace {

const char* window_of(Side side) { return side == Side::left ? "##left" : "##right"; }

// The slider's places: linear between these, so that the marks 0, 1 and 2 have room for their
// names.
struct Stop {
    double exponent;
    float place;
};
constexpr std::array<Stop, 4> stops = {{{0, 0}, {1, 0.33f}, {2, 0.62f}, {8, 1}}};

float place_of(double exponent) {
    for (size_t i = 0; i + 1 < stops.size(); ++i) {
        const Stop &a = stops[i], &b = stops[i + 1];
        if (exponent <= b.exponent)
            return a.place + (b.place - a.place) * static_cast<float>((exponent - a.exponent) /
                                                                      (b.exponent - a.exponent));
    }
    return 1;
}

double exponent_at(float place) {
    for (size_t i = 0; i + 1 < stops.size(); ++i) {
        const Stop &a = stops[i], &b = stops[i + 1];
        if (place <= b.place)
            return a.exponent + (b.exponent - a.exponent) * (place - a.place) / (b.place - a.place);
    }
    return stops.back().exponent;
}

double rounded_exponent(double b) {
    for (const double mark : {0.0, 1.0, 2.0})
        if (std::abs(place_of(b) - place_of(mark)) < 0.025f) return mark;
    return std::clamp(std::round(b * 20) / 20, 0.0, 8.0);
}

struct Mark {
    double exponent;
    const char* name;
};
constexpr std::array<Mark, 4> marks = {
    {{0, "naive 0"}, {1, "balance 1"}, {2, "power 2"}, {8, "8"}}};

// Text centred at x, kept within the item; true where it was clicked.
bool mark_label(const Mark& mark, float x, float y, float low, float high, bool chosen) {
    const ImVec2 size = ImGui::CalcTextSize(mark.name);
    const float left = std::clamp(x - size.x / 2, low, high - size.x);
    ImGui::SetCursorScreenPos({left, y});
    ImGui::PushID(mark.name);
    const bool clicked = ImGui::InvisibleButton("mark", size);
    const bool hovered = ImGui::IsItemHovered();
    ImGui::PopID();
    ImGui::GetWindowDrawList()->AddText(
        {left, y}, theme::color(chosen || hovered ? theme::text : theme::text_dim), mark.name);
    return clicked;
}

void draw_track(const ImVec2& at, float width, float height, double exponent, bool active) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float middle = at.y + height / 2, r = height * 0.32f;
    draw.AddRectFilled({at.x, middle - em(0.14f)}, {at.x + width, middle + em(0.14f)},
                       theme::color(theme::frame), em(0.14f));
    for (const Mark& m : marks) {
        const float x = at.x + place_of(m.exponent) * width;
        draw.AddLine({x, middle - r}, {x, middle + r}, theme::color(theme::text_dim),
                     std::max(1.0f, em(0.08f)));
    }
    const float x = at.x + place_of(exponent) * width;
    draw.AddCircleFilled({x, middle}, r,
                         theme::color(active ? theme::Color{1, 1, 1, 1} : theme::text));
}

}  // namespace

bool begin_section(App& app, Side side, const char* title, bool open_at_first) {
    if (!app.ui.panels) return false;
    Arrangement& arrangement = app.ui.panel.arrangement;
    if (!(side == Side::left ? arrangement.left : arrangement.right)) return false;
    if (!arrangement.right_fits) side = Side::left;
    const auto known = arrangement.sections.find(title);
    const bool open = known == arrangement.sections.end() ? open_at_first : known->second;

    ImGui::Begin(window_of(side));
    app.ui.panel.open_section = title;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    app.ui.panel.section_places[title] = {at.x, at.y, at.x + ImGui::GetContentRegionAvail().x,
                                          at.y + ImGui::GetFrameHeight()};
    ImGui::SetNextItemOpen(open);
    ImGui::PushFont(theme::heading_font());
    const bool now = ImGui::CollapsingHeader(title);
    ImGui::PopFont();
    if (now != open) arrangement.sections[title] = now;
    if (!now) {
        ImGui::End();
        return false;
    }
    ImGui::PushID(title);
    return true;
}

void end_section(App& app) {
    PanelState& panel = app.ui.panel;
    panel.section_places[panel.open_section][3] = ImGui::GetCursorScreenPos().y;
    ImGui::Dummy({0, em(0.15f)});
    ImGui::PopID();
    ImGui::End();
}

void tip(const char* text) {
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(em(26));
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void row(const char* label, const char* tooltip) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(theme::text_dim, "%s", label);
    tip(tooltip);
    ImGui::SameLine(em(6.4f));
    ImGui::SetNextItemWidth(-FLT_MIN);
}

float share_of_width(int count) {
    const float gaps = ImGui::GetStyle().ItemSpacing.x * static_cast<float>(count - 1);
    return std::floor((ImGui::GetContentRegionAvail().x - gaps) / static_cast<float>(count));
}

void heading(const char* text) {
    ImGui::Dummy({0, em(0.1f)});
    ImGui::TextColored(theme::text_dim, "%s", text);
}

void wrapped(const theme::Color& color, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str(), text.c_str() + text.size());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

void note(const theme::Color& color, const std::string& text) {
    const ImVec2 start = ImGui::GetCursorScreenPos();
    ImGui::Indent(em(0.6f));
    wrapped(color, text);
    ImGui::Unindent(em(0.6f));
    const float bottom = ImGui::GetItemRectMax().y;
    ImGui::GetWindowDrawList()->AddRectFilled(start, {start.x + em(0.18f), bottom},
                                              theme::color(color));
}

bool segmented(const char* id, std::span<const Choice> choices, int& chosen) {
    ImGui::PushID(id);
    const float gap = std::max(1.0f, em(0.1f));
    const float n = static_cast<float>(choices.size());
    const float width = std::floor((ImGui::CalcItemWidth() - gap * (n - 1)) / n);
    bool changed = false;
    for (int i = 0; i < static_cast<int>(choices.size()); ++i) {
        const Choice& c = choices[static_cast<size_t>(i)];
        if (i > 0) ImGui::SameLine(0, gap);
        const bool on = i == chosen;
        ImGui::PushStyleColor(ImGuiCol_Button, on ? theme::rgb(0x525252) : theme::rgb(0x333333));
        ImGui::PushStyleColor(ImGuiCol_Text, on ? theme::rgb(0xffffff) : theme::text);
        ImGui::BeginDisabled(!c.enabled);
        if (ImGui::Button(c.label, {width, 0}) && !on) {
            chosen = i;
            changed = true;
        }
        ImGui::EndDisabled();
        ImGui::PopStyleColor(2);
        const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
        if (on) {
            const float top = b.y - em(0.16f), middle = (a.x + b.x) / 2;
            const theme::Color& right = c.accent_right.w > 0 ? c.accent_right : c.accent;
            ImGui::GetWindowDrawList()->AddRectFilled({a.x, top}, {middle, b.y},
                                                      theme::color(c.accent));
            ImGui::GetWindowDrawList()->AddRectFilled({middle, top}, b, theme::color(right));
        }
        tip(c.tooltip);
    }
    ImGui::PopID();
    return changed;
}

bool optional_int(const char* label, const char* tooltip, std::optional<std::uint64_t>& value,
                  int when_on, const char* unit) {
    ImGui::PushID(label);
    bool on = value.has_value();
    bool changed = ImGui::Checkbox(label, &on);
    tip(tooltip);
    if (changed) value = on ? std::optional<std::uint64_t>(when_on) : std::nullopt;
    if (value) {
        ImGui::SameLine(em(6.4f));
        ImGui::SetNextItemWidth(-FLT_MIN);
        int typed = static_cast<int>(std::min<std::uint64_t>(*value, 1'000'000'000));
        if (ImGui::InputInt("##value", &typed, 0, 0, ImGuiInputTextFlags_EnterReturnsTrue)) {
            value = static_cast<std::uint64_t>(std::max(1, typed));
            changed = true;
        }
        tip(unit);
    }
    ImGui::PopID();
    return changed;
}

bool optional_number(const char* label, const char* tooltip, std::optional<double>& value,
                     double when_on, const char* format) {
    ImGui::PushID(label);
    bool on = value.has_value();
    bool changed = ImGui::Checkbox(label, &on);
    tip(tooltip);
    if (changed) value = on ? std::optional<double>(when_on) : std::nullopt;
    if (value) {
        ImGui::SameLine(em(6.4f));
        ImGui::SetNextItemWidth(-FLT_MIN);
        double typed = *value;
        if (ImGui::InputDouble("##value", &typed, 0, 0, format,
                               ImGuiInputTextFlags_EnterReturnsTrue) &&
            typed > 0 && std::isfinite(typed)) {
            value = typed;
            changed = true;
        }
        tip(tooltip);
    }
    ImGui::PopID();
    return changed;
}

bool drag_number(const char* id, double& value, double low, double high, const char* format) {
    const auto speed = static_cast<float>(std::max(std::abs(value) * 0.005, 1e-4));
    double next = value;
    if (!ImGui::DragScalar(id, ImGuiDataType_Double, &next, speed, &low, &high, format,
                           ImGuiSliderFlags_NoRoundToFormat))
        return false;
    if (!std::isfinite(next)) return false;
    next = std::clamp(next, low, high);
    const bool changed = next != value;
    value = next;
    return changed;
}

bool exponent_slider(double& exponent) {
    ImGui::PushID("exponent");
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight(), radius = height * 0.32f;
    const float width = ImGui::GetContentRegionAvail().x;
    const ImVec2 track{at.x + radius, at.y};
    const float length = width - 2 * radius;
    ImGui::InvisibleButton("track", {width, height});
    tip("Exponent b of the MIS weights, w = p^b / sum of p^b. 0: uniform (naive BDPT), 1: balance "
        "heuristic, 2: power heuristic; larger ones come close to picking the best strategy alone. "
        "Every exponent converges to the same image; they differ in noise.");
    double next = exponent;
    const bool active = ImGui::IsItemActive();
    if (active)
        next = rounded_exponent(
            exponent_at(std::clamp((ImGui::GetIO().MousePos.x - track.x) / length, 0.0f, 1.0f)));
    draw_track(track, length, height, next, active || ImGui::IsItemHovered());
    for (const Mark& m : marks)
        if (mark_label(m, track.x + place_of(m.exponent) * length, at.y + height, at.x,
                       at.x + width, next == m.exponent))
            next = m.exponent;
    ImGui::PopID();
    const bool changed = next != exponent;
    exponent = next;
    return changed;
}

bool wide_button(const char* label, const char* tooltip, float width) {
    const bool clicked = ImGui::Button(label, {width, 0});
    tip(tooltip);
    return clicked;
}

void begin_sheet(const char* name, bool& open) {
    constexpr ImGuiWindowFlags still = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                       ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, theme::rgb(0, 0.55f));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::Begin("##dim", nullptr, still);
    ImGui::PopStyleVar();
    ImGui::PopStyleColor();
    if (ImGui::InvisibleButton("beside", ImGui::GetContentRegionAvail())) open = false;
    ImGui::End();

    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({em(10), em(6)}, {size.x - em(2), size.y - em(2)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {em(1.4f), em(1.1f)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, em(0.4f));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
    ImGui::Begin(name, nullptr, still | ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PopStyleVar(3);
    if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
}

void end_sheet() { ImGui::End(); }

std::string short_number(double n) {
    if (n < 1000) return fmt::format("{:.0f}", n);
    if (n < 1e6) return fmt::format("{:.1f} k", n / 1e3);
    if (n < 1e9) return fmt::format("{:.2f} M", n / 1e6);
    return fmt::format("{:.2f} G", n / 1e9);
}

std::string fitted(const std::string& text, float width) {
    const auto width_of = [](const std::string& s) { return ImGui::CalcTextSize(s.c_str()).x; };
    if (width_of(text) <= width) return text;
    // Cuts between characters, never inside one of UTF-8.
    const auto whole = [&](size_t i) {
        while (i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80) ++i;
        return i;
    };
    std::string best = "...";
    for (size_t keep = text.size() / 2; keep > 0; keep -= std::max<size_t>(1, keep / 12)) {
        best = text.substr(0, whole(keep)) + "..." + text.substr(whole(text.size() - keep));
        if (width_of(best) <= width) break;
    }
    return best;
}

}  // namespace midway::ui
