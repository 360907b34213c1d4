// The three tables of the path inspector: what the sample walked, what it found, and how all
// strategies stand to the full path that is picked.
#pragma once

#include "viewer/state.h"

namespace midway {

void draw_vertex_table(const Inspection& inspection, const InspectedPath* picked);
// Changes `picked` where another one was clicked.
void draw_path_list(const Inspection& inspection, int& picked);
void draw_strategy_table(const Inspection& inspection, const InspectedPath& path);

// Three digits that say the most, and powers of ten where they must be.
std::string short_value(double v);

}  // namespace midway
