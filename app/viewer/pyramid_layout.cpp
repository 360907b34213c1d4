#include "pyramid_layout.h"

#include <algorithm>
#include <cmath>

namespace midway {
namespace {

vec2 largest_thumbnail(const PyramidRoom& room, int rows, int columns) {
    const vec2 size = room.rect.size();
    const auto share = [](float length, int count, float gap) {
        return (length - gap * static_cast<float>(count - 1)) / static_cast<float>(count);
    };
    const float width = share(size.x - room.left - room.right, columns, room.gap);
    const float height = share(size.y, rows, room.gap) - room.caption;
    const float fitting = std::max(4.0f, std::min(width, height * room.aspect));
    return {std::floor(fitting), std::max(3.0f, std::floor(fitting / room.aspect))};
}

}  // namespace

PyramidLayout lay_out_pyramid(const PyramidRoom& room, int max_bounces) {
    const int longest = std::min(cell_edges, max_bounces + 1);
    const bool longer = max_bounces + 1 > cell_edges;
    const int rows = longest + (longer ? 1 : 0);
    PyramidLayout l;
    l.thumbnail = largest_thumbnail(room, std::max(rows, 3), std::max(longest, 3) + 1);
    const float centre = 0.5f * (room.rect.lower.x + room.left + room.rect.upper.x - room.right);
    const float step = l.thumbnail.x + room.gap;
    float top = room.rect.lower.y;
    for (int edges = 1; edges <= rows; ++edges, top += l.thumbnail.y + room.caption + room.gap) {
        l.rows.push_back({edges, std::round(top)});
        const int count = edges > cell_edges ? 1 : edges + 1;
        const float left = centre - 0.5f * (step * static_cast<float>(count) - room.gap);
        for (int t = 0; t < count; ++t) {
            const vec2 lower{std::round(left + step * static_cast<float>(t)), std::round(top)};
            const Strategy k = edges > cell_edges ? longer_paths : Strategy{edges + 1 - t, t};
            l.cells.push_back({k, {lower, lower + l.thumbnail}});
        }
    }
    return l;
}

std::string row_name(const PyramidRow& row) {
    const int bounces = row.edges - 1;
    if (row.edges > cell_edges) return std::to_string(bounces) + " and more";
    return std::to_string(bounces) + (bounces == 1 ? " bounce" : " bounces");
}

}  // namespace midway
