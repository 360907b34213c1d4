#include "viewer/panels/edit_widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway::ui {
namespace {

// sRGB's transfer curve, IEC 61966-2-1, continued above one.
float to_srgb(float x) {
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}
float to_linear(float x) {
    return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

float way_back_width() { return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x; }

// An arrow that turns back.
bool way_back(const std::string& tooltip) {
    const float size = ImGui::GetFrameHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::Button("##back", {size, size});
    tip(tooltip.c_str());
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 m{at.x + size / 2, at.y + size / 2};
    const float r = size * 0.24f;
    draw.PathArcTo(m, r, -2.2f, 2.6f, 16);
    draw.PathStroke(theme::color(theme::light), 0, std::max(1.0f, em(0.1f)));
    const ImVec2 end{m.x + r * std::cos(-2.2f), m.y + r * std::sin(-2.2f)};
    draw.AddTriangleFilled({end.x - 0.7f * r, end.y + 0.1f * r},
                           {end.x + 0.35f * r, end.y - 0.8f * r},
                           {end.x + 0.3f * r, end.y + 0.7f * r}, theme::color(theme::light));
    return clicked;
}

void rays(ImDrawList& draw, const ImVec2& m, float from, float to, float first, float last, int n,
          ImU32 color, float width) {
    for (int i = 0; i < n; ++i) {
        const float a = first + (last - first) * static_cast<float>(i) / static_cast<float>(n - 1);
        const float x = std::cos(a), y = std::sin(a);
        draw.AddLine({m.x + from * x, m.y + from * y}, {m.x + to * x, m.y + to * y}, color, width);
    }
}

}  // namespace

LampSign sign_of(const App& app, const Lamp& lamp) {
    if (lamp.kind == LampKind::sky) return LampSign::sky;
    if (lamp.kind == LampKind::material) return LampSign::area;
    const auto& light = app.document.prepared->file->lights[static_cast<size_t>(lamp.index)];
    switch (light_edit(app, lamp.index).kind.value_or(light.kind)) {
        case PunctualKind::spot:
            return LampSign::spot;
        case PunctualKind::directional:
            return LampSign::directional;
        case PunctualKind::point:
            break;
    }
    return LampSign::point;
}

const char* word_of(LampSign sign) {
    switch (sign) {
        case LampSign::point:
            return "Point: shines from one point in all directions.";
        case LampSign::spot:
            return "Spot: shines from one point into a cone.";
        case LampSign::directional:
            return "Directional: parallel light from infinitely far, as from the sun.";
        case LampSign::area:
            return "Surface: everything of this material shines.";
        case LampSign::sky:
            break;
    }
    return "Sky: light from infinitely far around the scene.";
}

void draw_sign(ImDrawList& draw, const ImVec2& m, float r, LampSign sign, ImU32 color) {
    const float width = std::max(1.0f, r * 0.2f);
    constexpr float pi_f = 3.14159265f;
    switch (sign) {
        case LampSign::point:
            draw.AddCircleFilled(m, r * 0.38f, color, 12);
            rays(draw, m, 0.62f * r, r, 0, 2 * pi_f * 7 / 8, 8, color, width);
            break;
        case LampSign::spot:
            draw.AddTriangleFilled({m.x, m.y - 0.9f * r}, {m.x - 0.5f * r, m.y + 0.1f * r},
                                   {m.x + 0.5f * r, m.y + 0.1f * r}, color);
            rays(draw, {m.x, m.y - 0.6f * r}, 1.05f * r, 1.6f * r, 0.28f * pi_f, 0.72f * pi_f, 3,
                 color, width);
            break;
        case LampSign::directional:
            for (const float x : {-0.6f, 0.0f, 0.6f}) {
                draw.AddLine({m.x + (x + 0.25f) * r, m.y - 0.9f * r},
                             {m.x + (x - 0.15f) * r, m.y + 0.5f * r}, color, width);
                draw.AddCircleFilled({m.x + (x - 0.22f) * r, m.y + 0.75f * r}, r * 0.17f, color, 8);
            }
            break;
        case LampSign::area:
            draw.AddRectFilled({m.x - 0.85f * r, m.y - 0.75f * r},
                               {m.x + 0.85f * r, m.y - 0.1f * r}, color, r * 0.1f);
            rays(draw, {m.x, m.y - 0.5f * r}, 0.75f * r, 1.35f * r, 0.28f * pi_f, 0.72f * pi_f, 3,
                 color, width);
            break;
        case LampSign::sky:
            draw.PathArcTo({m.x, m.y + 0.55f * r}, 0.95f * r, pi_f, 2 * pi_f, 16);
            draw.PathStroke(color, 0, width);
            draw.AddLine({m.x - r, m.y + 0.6f * r}, {m.x + r, m.y + 0.6f * r}, color, width);
            draw.AddCircleFilled({m.x + 0.25f * r, m.y + 0.05f * r}, 0.2f * r, color, 10);
            break;
    }
}

bool linear_color(const char* id, vec3& linear, const char* tooltip) {
    vec3 shown(to_srgb(linear.x), to_srgb(linear.y), to_srgb(linear.z));
    const bool changed =
        ImGui::ColorEdit3(id, &shown.x,
                          ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoTooltip |
                              ImGuiColorEditFlags_NoOptions | ImGuiColorEditFlags_NoLabel |
                              ImGuiColorEditFlags_Float);
    tip(fmt::format("{}\nLinear: {:.4g}, {:.4g}, {:.4g}", tooltip, linear.x, linear.y, linear.z)
            .c_str());
    if (!changed || !is_finite(shown)) return false;
    const vec3 next =
        glm::max(vec3(to_linear(shown.x), to_linear(shown.y), to_linear(shown.z)), vec3(0));
    if (next == linear) return false;
    linear = next;
    return true;
}

void begin_edit_row(const char* label, const char* tooltip, bool changed) {
    ImGui::PushID(label);
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(changed ? theme::light : theme::text_dim, "%s", label);
    tip(tooltip);
    ImGui::SameLine(em(6.4f));
    ImGui::SetNextItemWidth(-way_back_width());
}

bool end_edit_row(const char* label, const std::string& of_file, bool changed) {
    bool back = false;
    if (changed) {
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::GetFrameHeight());
        back = way_back(fmt::format("{}: back to the file's {}", label, of_file));
    }
    ImGui::PopID();
    return back;
}

bool edit_share(const char* label, const char* tooltip, std::optional<float>& value, float of_file,
                float low, float high) {
    begin_edit_row(label, tooltip, value.has_value());
    float next = value.value_or(of_file);
    const bool changed =
        ImGui::SliderFloat("##value", &next, low, high, "%.3f", ImGuiSliderFlags_NoRoundToFormat) &&
        std::isfinite(next);
    const bool marked = value.has_value();
    if (changed) value = std::clamp(next, low, high);
    const bool back = end_edit_row(label, fmt::format("{:.4g}", of_file), marked);
    if (back) value.reset();
    return changed || back;
}

bool edit_number(const char* label, const char* tooltip, std::optional<float>& value, float of_file,
                 float low, float high) {
    begin_edit_row(label, tooltip, value.has_value());
    double next = value.value_or(of_file);
    const bool changed = drag_number("##value", next, low, high, "%.4g");
    const bool marked = value.has_value();
    if (changed) value = static_cast<float>(next);
    const bool back = end_edit_row(label, fmt::format("{:.4g}", of_file), marked);
    if (back) value.reset();
    return changed || back;
}

bool edit_color(const char* label, const char* tooltip, std::optional<vec3>& value,
                const vec3& of_file) {
    begin_edit_row(label, tooltip, value.has_value());
    vec3 next = value.value_or(of_file);
    const bool changed = linear_color("##value", next, tooltip);
    ImGui::SameLine();
    ImGui::TextColored(theme::text_dim, "%.3g, %.3g, %.3g", next.x, next.y, next.z);
    const bool marked = value.has_value();
    if (changed) value = next;
    const bool back = end_edit_row(
        label, fmt::format("{:.4g}, {:.4g}, {:.4g}", of_file.x, of_file.y, of_file.z), marked);
    if (back) value.reset();
    return changed || back;
}

}  // namespace midway::ui
