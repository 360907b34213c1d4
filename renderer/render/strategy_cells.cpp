#include "render/strategy_cells.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace midway {
namespace {

constexpr size_t bytes_per_pixel = 96;

bool exists(const Estimator& e, const Strategy& k) {
    if (k == Strategy{1, 1}) return false;
    return e.has(k) || (k == Strategy{2, 0} && e.direct_lamps);
}

int divided_up(int a, int b) { return (a + b - 1) / b; }

}  // namespace

StrategyCells make_cells(const Estimator& e, int unit, size_t exponent, std::uint64_t passes) {
    StrategyCells c;
    c.crop = e.crop;
    c.exponent = exponent;
    c.since = passes;
    c.box = std::max(1, divided_up(std::max(e.crop.width(), e.crop.height()), thumbnail_pixels));
    const int width = divided_up(e.crop.width(), c.box),
              height = divided_up(e.crop.height(), c.box);
    c.cell_of.fill(-1);
    const int longest = e.max_bounces + 1;
    for (int edges = 1; edges <= std::min(longest, cell_edges); ++edges)
        for (int s = edges + 1; s >= 1; --s) {
            const Strategy k{s, edges + 1 - s};
            if (!exists(e, k)) continue;
            c.cell_of[strategy_index(k)] = static_cast<std::int8_t>(c.cells.size());
            c.cells.push_back({k, Film(width, height, unit), nullptr, 0});
        }
    if (longest > cell_edges) {
        c.longer = static_cast<int>(c.cells.size());
        c.cells.push_back({longer_paths, Film(width, height, unit), nullptr, 0});
    }
    return c;
}

void keep_full_size(StrategyCells& c, const StrategyRequest& request, std::uint64_t passes) {
    const size_t bytes = static_cast<size_t>(c.crop.area()) * bytes_per_pixel;
    const size_t room = std::max<size_t>(1, full_size_bytes / std::max<size_t>(1, bytes));
    std::vector<int> wanted;
    for (const std::vector<Strategy>* list : {&request.selected, &request.kept})
        for (const Strategy& k : *list) {
            const int i = c.index_of(k);
            if (i >= 0 && wanted.size() < room && std::ranges::find(wanted, i) == wanted.end())
                wanted.push_back(i);
        }
    for (int i = 0; i < static_cast<int>(c.cells.size()); ++i) {
        StrategyCell& cell = c.cells[static_cast<size_t>(i)];
        if (std::ranges::find(wanted, i) == wanted.end()) cell.full.reset();
    }
    for (const int i : wanted) {
        StrategyCell& cell = c.cells[static_cast<size_t>(i)];
        if (cell.full) continue;
        cell.full =
            std::make_unique<Film>(c.crop.width(), c.crop.height(), cell.thumbnail.unit_exponent());
        cell.full_since = passes;
    }
}

PixelRect thumbnail_box(const StrategyCells& c, int x, int y) {
    const int x0 = c.crop.x0 + x * c.box, y0 = c.crop.y0 + y * c.box;
    return {x0, y0, std::min(x0 + c.box, c.crop.x1), std::min(y0 + c.box, c.crop.y1)};
}

void CellBuffer::flush(StrategyCells& c, std::uint64_t& lost) {
    for (; touched_ != 0; touched_ &= touched_ - 1) {
        const auto i = static_cast<size_t>(std::countr_zero(touched_));
        const Sums s = std::exchange(sums_[i], {});
        Film& film = c.cells[i].thumbnail;
        lost += !film.add(0, x_, y_, s.weighted);
        lost += !film.add(1, x_, y_, s.bare);
    }
}

void CellBuffer::change_box(StrategyCells& c, int x, int y, std::uint64_t& lost) {
    flush(c, lost);
    x_ = (x - c.crop.x0) / c.box;
    y_ = (y - c.crop.y0) / c.box;
    box_ = thumbnail_box(c, x_, y_);
}

}  // namespace midway
