// Where the cells of the strategy pyramid lie (E. Veach, "Robust Monte Carlo methods for light
// transport simulation" (1997), figure 10.2): one row for each length of paths, one cell for each
// way to share a path's vertices between camera and light, from all at the camera (left) to all at
// the light (right). Rows are centred, so that a step to the lower left adds a vertex at the
// camera, to the lower right one at the light. No window is needed here.
#pragma once

#include <string>
#include <vector>

#include "render/strategy_cells.h"
#include "state.h"

namespace midway {

struct PyramidRow {
    int edges = 1;  // of its paths; above cell_edges: of all longer ones
    float top = 0;  // of its thumbnails
};

struct PyramidCell {
    Strategy strategy;
    Rect thumbnail;  // its bar and its number stand below
};

struct PyramidRoom {
    Rect rect;
    float left = 0, right = 0;  // margins: the rows' names, their sums
    float caption = 0;          // height below each thumbnail
    float gap = 0;
    float aspect = 1;  // width by height of a thumbnail
};

struct PyramidLayout {
    std::vector<PyramidRow> rows;
    std::vector<PyramidCell> cells;
    vec2 thumbnail{0};  // size
};

// For paths of at most `max_bounces` bounces; at least three rows are made room for.
PyramidLayout lay_out_pyramid(const PyramidRoom& room, int max_bounces);

// "0 bounces", "1 bounce", "2 bounces" ... "8 and more".
std::string row_name(const PyramidRow& row);

}  // namespace midway
