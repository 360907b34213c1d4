// The panels of the table in panels.cpp, and what keys and panels share.
#pragma once

#include "viewer/state.h"

namespace midway {

// Arranges columns and status line, sets ui.view and ui.view_hovered. First in the table.
Change draw_layout(App& app);

Change draw_navigation(App& app);  // mouse and flight in the view
Change draw_keys(App& app);        // the keyboard, and the overlay that lists it

// Left column.
Change draw_technique(App& app);
Change draw_run(App& app);
Change draw_sampling(App& app);
Change draw_camera(App& app);

// Right column.
Change draw_display(App& app);
Change draw_scene(App& app);
Change draw_lights(App& app);
Change draw_material(App& app);
Change draw_compare(App& app);
Change draw_error_plot(App& app);
Change draw_files(App& app);
Change draw_messages(App& app);

// Over the image.
Change draw_status(App& app);
Change draw_selection(App& app);  // marks the object or lamp that is being edited
Change draw_overlays(App& app);   // loading, notices, default sky, legend
Change draw_inspector(App& app);  // the dock below, the lines' names, the pixel under the mouse
Change draw_pyramid(App& app);    // beside it: what each strategy finds
Change draw_shown_strategies(App& app);
Change draw_gallery(App& app);
Change draw_compare_view(App& app);  // line of the wipe, captions, scale of differences
Change draw_tour(App& app);

// What both a control and a key do.
Change choose_technique(App& app, Technique technique);
Change choose_exponent(App& app, double exponent);
Change choose_same_paths(App& app, bool on);
Change restart(App& app);
Change choose_compare(App& app, CompareView view);  // stays where there is no A
Change keep_as_a(App& app);
Change flip_to_a(App& app);  // and back
Change frame_whole_scene(App& app);
Change store_bookmark(App& app);
Change recall_bookmark(App& app, int index);
void choose_tool(App& app, ViewTool tool);  // again: puts it away
void inspect_pixel(App& app, ivec2 pixel);  // of the whole image: its first sample, or as before
bool inspect_nonfinite(App& app);           // the first sample that was; false where there is none

// Where the camera is, and where it shall be.
View current_view(const App& app);
Change move_to(App& app, const View& view);

// A name beside which no file exists yet, made of the scene's: "idol.exr", "idol-2.exr".
std::string free_name(const std::string& stem, const std::string& extension);

}  // namespace midway
