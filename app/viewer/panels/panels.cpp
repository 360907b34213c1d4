#include "viewer/panels/panels.h"

#include <array>

#include "viewer/panels/parts.h"

namespace midway {
namespace {

constexpr std::array<Panel, 24> table = {{
    {"layout", draw_layout},
    {"navigation", draw_navigation},
    {"technique", draw_technique},
    {"run", draw_run},
    {"camera", draw_camera},
    {"sampling", draw_sampling},
    {"inspector", draw_inspector},
    {"display", draw_display},
    {"compare", draw_compare},
    {"error plot", draw_error_plot},
    {"scene", draw_scene},
    {"lights", draw_lights},
    {"material", draw_material},
    {"files", draw_files},
    {"messages", draw_messages},
    {"status", draw_status},
    {"pyramid", draw_pyramid},
    {"shown strategies", draw_shown_strategies},
    {"compare view", draw_compare_view},
    {"selection", draw_selection},
    {"overlays", draw_overlays},
    {"gallery", draw_gallery},
    {"keys", draw_keys},
    {"tour", draw_tour},
}};

}  // namespace

std::span<const Panel> panels() { return table; }

}  // namespace midway
