#include "viewer/panels/inspector_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "viewer/theme.h"
#include "viewer/widgets.h"

namespace midway {
namespace {

using ui::em;

constexpr ImGuiTableFlags table_flags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                                        ImGuiTableFlags_SizingFixedFit |
                                        ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_PadOuterX;

struct Column {
    const char* title;
    const char* tooltip;
    float width;  // in font sizes; 0: what is left
};

bool begin_table(const char* id, std::span<const Column> columns) {
    if (!ImGui::BeginTable(id, static_cast<int>(columns.size()), table_flags)) return false;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const Column& c : columns)
        ImGui::TableSetupColumn(
            c.title,
            c.width > 0 ? ImGuiTableColumnFlags_WidthFixed : ImGuiTableColumnFlags_WidthStretch,
            c.width > 0 ? em(c.width) : 1);
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (int i = 0; i < static_cast<int>(columns.size()); ++i) {
        ImGui::TableSetColumnIndex(i);
        ImGui::TextColored(theme::text_dim, "%s", columns[static_cast<size_t>(i)].title);
        ui::tip(columns[static_cast<size_t>(i)].tooltip);
    }
    return true;
}

void cell(const theme::Color& color, const std::string& text) {
    ImGui::TableNextColumn();
    ImGui::TextColored(color, "%s", text.c_str());
}

// A bar behind a number, both over the whole cell.
void bar_cell(float share, const theme::Color& color, const std::string& text) {
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = ImGui::GetTextLineHeight();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled({at.x, at.y + 1}, {at.x + width, at.y + height}, theme::color(theme::frame));
    if (share > 0)
        draw.AddRectFilled({at.x, at.y + 1}, {at.x + width * std::min(share, 1.0f), at.y + height},
                           theme::color(color, 0.55f));
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + em(0.25f));
    ImGui::TextUnformatted(text.c_str());
}

const char* measure_of(const Density& d, bool light_end) {
    switch (d.measure) {
        case Measure::per_area:
            return "per area";
        case Measure::per_solid_angle:
            return "per solid angle";
        case Measure::probability:
            return light_end ? "probability of this light" : "probability of this lobe";
        case Measure::none:
            return "";
    }
    return "";
}

std::string in_words(const Density& d, bool light_end) {
    if (d.measure == Measure::none) return "-";
    return fmt::format("{:.6g} {}", d.value, measure_of(d, light_end));
}

std::string short_density(const Density& d) {
    return d.measure == Measure::none ? "-" : short_value(d.value);
}

std::string what_is_at(const InspectedVertex& v) {
    std::string text = v.kind == VertexKind::surface ? v.object_name : to_string(v.kind);
    if (v.kind == VertexKind::area_light && !v.object_name.empty()) text += ": " + v.object_name;
    if (text.empty()) text = fmt::format("object {}", v.object);
    if (v.kind == VertexKind::surface && !v.material_name.empty()) text += " · " + v.material_name;
    return text;
}

std::string scattering_of(const InspectedVertex& v) {
    if (v.kind != VertexKind::surface) return "";
    if (v.black) return v.shines ? "only shines" : "black";
    if (v.delta || !v.connectible) return "smooth";
    if (v.roughness >= 1) return "diffuse";
    return fmt::format("rough {:.2g}", v.roughness);
}

void vertex_tip(const InspectedVertex& v, bool light_side, const std::string& name) {
    if (!ImGui::IsItemHovered()) return;
    const bool end = v.kind != VertexKind::surface;
    const vec3& t = v.throughput;
    std::string text = fmt::format("{}: {}\n", name, what_is_at(v));
    text += fmt::format("{} {:.6g}, {:.6g}, {:.6g}\n", v.infinite ? "direction" : "position",
                        v.position.x, v.position.y, v.position.z);
    if (v.object >= 0)
        text += fmt::format("normal {:.3f}, {:.3f}, {:.3f}\n", v.normal.x, v.normal.y, v.normal.z);
    text += fmt::format("made by the vertex before it: {}\n", in_words(v.fwd, end && light_side));
    text += fmt::format("by the one after it: {}\n", in_words(v.rev, end && light_side));
    text += fmt::format("goes on: {}; back: {}\n", in_words(v.scatter_fwd, false),
                        in_words(v.scatter_rev, false));
    text += fmt::format("throughput {:.6g}, {:.6g}, {:.6g}", t.x, t.y, t.z);
    ui::tip(text.c_str());
}

bool is_on(const InspectedPath* path, const InspectedVertex& v) {
    if (!path || v.infinite) return false;
    return std::find(path->points.begin(), path->points.end(), v.position) != path->points.end();
}

void vertex_rows(const std::vector<InspectedVertex>& vertices, bool light_side,
                 const InspectedPath* picked) {
    for (size_t i = 0; i < vertices.size(); ++i) {
        const InspectedVertex& v = vertices[i];
        const theme::Color& side = light_side ? theme::light : theme::camera;
        const std::string name = fmt::format("{}{}", light_side ? "L" : "C", i);
        ImGui::TableNextRow();
        if (is_on(picked, v))
            ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg0, theme::color(side, 0.16f));
        cell(side, v.kind == VertexKind::nothing ? "" : name);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(ui::fitted(what_is_at(v), ImGui::GetContentRegionAvail().x).c_str());
        vertex_tip(v, light_side, name);
        cell(theme::text_dim, scattering_of(v));
        cell(theme::text, short_density(v.fwd));
        vertex_tip(v, light_side, name);
        cell(theme::text, short_density(v.rev));
        vertex_tip(v, light_side, name);
        cell(theme::text, short_value(luminance(v.throughput)));
        vertex_tip(v, light_side, name);
    }
}

theme::Color color_of(Family f) {
    switch (f) {
        case Family::emitter_hit:
        case Family::next_event:
            return theme::camera;
        case Family::light_tracing:
            return theme::light;
        case Family::connection:
            break;
    }
    return theme::rgb(0xb8b0a0);
}

void strategy_row(const InspectedStrategy& s, const InspectedPath& path, size_t exponent,
                  float pdf_share) {
    const bool found = s.strategy == path.contribution.strategy;
    ImGui::TableNextRow();
    if (found) ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg0, theme::color(theme::text, 0.14f));
    cell(found ? theme::rgb(0xffffff) : theme::text, describe(s.strategy));
    if (found) ui::tip("This strategy found the path.");
    const theme::Color bar = color_of(family_of(s.strategy));
    bar_cell(pdf_share, bar, short_value(std::pow(10.0, s.log10_pdf)));
    ui::tip(fmt::format("10^{:.4f}", s.log10_pdf).c_str());
    const double weight = s.weights[exponent], direct = s.direct[exponent];
    bar_cell(static_cast<float>(weight), bar, fmt::format("{:.4f}", weight));
    ui::tip(fmt::format(
                "{:.12g}\n{}", weight,
                found ? "the weight that the render used" : "by the recursion that the render uses")
                .c_str());
    cell(theme::text_dim, fmt::format("{:.4f}", direct));
    ui::tip(fmt::format("{:.12g}, from the product of all densities", direct).c_str());
    cell(theme::text, short_value(luminance(s.value) * weight));
    ui::tip(fmt::format("bare estimate {:.6g}, weighted {:.6g}", luminance(s.value),
                        luminance(s.value) * weight)
                .c_str());
}

// Those that cannot make the path, in one row where they are many.
void infeasible_rows(const InspectedPath& path) {
    constexpr int few = 3;
    std::vector<Strategy> list;
    for (auto s = path.strategies.rbegin(); s != path.strategies.rend(); ++s)
        if (!s->feasible && !(s->strategy == Strategy{1, 1})) list.push_back(s->strategy);
    const auto row = [](const std::string& text) {
        ImGui::TableNextRow();
        cell(theme::text_dim, text);
        ui::tip(
            "They would have to join a smooth vertex, to hit a point light or a sun, or their "
            "family is taken out.");
        cell(theme::text_dim, "cannot");
    };
    if (list.size() > few)
        row(fmt::format("the other {} ways", list.size()));
    else
        for (const Strategy& k : list) row(describe(k));
}

void sum_row(const InspectedPath& path, size_t exponent) {
    double weights = 0, direct = 0;
    for (const InspectedStrategy& s : path.strategies) {
        weights += s.weights[exponent];
        direct += s.direct[exponent];
    }
    ImGui::TableNextRow();
    cell(theme::text_dim, "sum of the weights");
    cell(theme::text_dim, "");
    cell(theme::text, fmt::format(" {:.4f}", weights));
    ui::tip(fmt::format("{:.12g}: the weights of all strategies that can make a path sum to one",
                        weights)
                .c_str());
    cell(theme::text_dim, fmt::format("{:.4f}", direct));
    ui::tip(fmt::format("{:.12g}", direct).c_str());
}

}  // namespace

std::string short_value(double v) {
    if (v == 0) return "0";
    const double a = std::abs(v);
    if (!std::isfinite(v)) return std::isnan(v) ? "nan" : v > 0 ? "inf" : "-inf";
    if (a >= 1e2 && a < 1e5) return fmt::format("{:.0f}", v);
    if (a >= 1e-3 && a < 1e5) return fmt::format("{:.3g}", v);
    return fmt::format("{:.1e}", v);
}

void draw_vertex_table(const Inspection& inspection, const InspectedPath* picked) {
    const Column columns[] = {
        {"",
         "C: vertices of the camera's walk, L: of the light's; as named in the image. A path that "
         "connects to the light's walk of a neighbouring pixel brings that one with it.",
         1.6f},
        {"Vertex", "The object and its material, or what the walk starts or ends on.", 0},
        {"Scatters",
         "smooth: a mirror or clear glass, which no connection can join; rough: the roughness of "
         "its lobe; diffuse: all directions",
         4.8f},
        {"pdf fwd",
         "Density with which the vertex before it made this one: per unit of area (per solid angle "
         "at the sky, a probability at a point light or sun).",
         4.2f},
        {"pdf rev",
         "Density with which the vertex after it would have made this one, walking the other way. "
         "-: there is none.",
         4.2f},
        {"carries",
         "Throughput of the walk up to here, as luminance; for the light's walk in units of power.",
         4.2f}};
    if (!begin_table("vertices", columns)) return;
    vertex_rows(inspection.sample.camera, false, picked);
    vertex_rows(light_subpath_of(inspection.sample, picked), true, picked);
    ImGui::EndTable();
}

void draw_path_list(const Inspection& inspection, int& picked) {
    const Column columns[] = {
        {"Full paths found",
         "Every path that the sample joined to a light, by what it gave to this pixel. Click one "
         "to see it in the image and in the table beside.",
         0},
        {"gave", "Weighted contribution, as luminance: what the image got.", 4.4f}};
    if (!begin_table("paths", columns)) return;
    float most = 0;
    for (const InspectedPath& p : inspection.sample.paths)
        most = std::max(most, luminance(given(inspection, p)));
    for (const int k : inspection.order) {
        const InspectedPath& p = inspection.sample.paths[static_cast<size_t>(k)];
        const bool elsewhere = p.x != inspection.watched.x || p.y != inspection.watched.y;
        ImGui::TableNextRow();
        if (picked == k)
            ImGui::TableSetBgColor(ImGuiTableBgTarget_RowBg0, theme::color(theme::text, 0.14f));
        ImGui::TableNextColumn();
        ImGui::PushID(k);
        if (ImGui::Selectable("##pick", picked == k, ImGuiSelectableFlags_SpanAllColumns))
            picked = k;
        const std::string words = describe(p.contribution.strategy);
        ui::tip(!p.usable ? "Not finite: it was counted and left out of the image."
                : elsewhere
                    ? fmt::format("Light tracing: it landed in pixel {}, {}.", p.x, p.y).c_str()
                    : "It went to this pixel.");
        ImGui::PopID();
        ImGui::SameLine(0, 0);
        ImGui::TextColored(
            !p.usable   ? theme::error
            : elsewhere ? theme::text_dim
                        : theme::text,
            "%s",
            elsewhere ? fmt::format("{} \u2192 {}, {}", words, p.x, p.y).c_str() : words.c_str());
        const float light = luminance(given(inspection, p));
        bar_cell(most > 0 ? light / most : 0, color_of(family_of(p.contribution.strategy)),
                 p.usable ? short_value(light) : "not finite");
    }
    ImGui::EndTable();
}

void draw_strategy_table(const Inspection& inspection, const InspectedPath& path) {
    const Column columns[] = {
        {"Ways to find the picked path",
         "Every strategy that makes paths of this length; the bright row found this one.", 0},
        {"pdf",
         "Density of the path by this strategy, times its number of samples; the bars are "
         "logarithmic.",
         5},
        {"weight", "By the render's recursion, with the exponent that is shown.", 4.2f},
        {"direct",
         "The same weight by the direct form (eq. 4-10): powers of the whole products of "
         "densities. It shares no code with the recursion.",
         3.6f},
        {"would give", "What this strategy would have given, had it found this path, as luminance.",
         4.8f}};
    if (!begin_table("strategies", columns)) return;
    double low = 1e300, high = -1e300;
    for (const InspectedStrategy& s : path.strategies)
        if (s.feasible && std::isfinite(s.log10_pdf)) {
            low = std::min(low, s.log10_pdf);
            high = std::max(high, s.log10_pdf);
        }
    // The smallest still shows a bar, and small differences are not blown up.
    const double range = 1.25 * std::max(2.0, high - low);
    for (auto s = path.strategies.rbegin(); s != path.strategies.rend(); ++s) {
        if (!s->feasible) continue;
        const double share = 1 - (high - s->log10_pdf) / range;
        strategy_row(*s, path, inspection.exponent,
                     std::isfinite(share) ? static_cast<float>(std::max(share, 0.0)) : 0);
    }
    sum_row(path, inspection.exponent);
    infeasible_rows(path);
    ImGui::EndTable();
}

}  // namespace midway
