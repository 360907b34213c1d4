// The cells of the strategy pyramid: what each strategy (s, t) finds, gathered beside the image
// while somebody looks. A cell holds sums like the film's (image/film.h), exact and order-free, in
// which half 0 is weighted and half 1 is bare: what the film got for the strategy, clamped where
// the film's share was, and the estimate before its weight, never clamped. So the weighted cells of
// all strategies add up to the film, integer by integer, over the passes that the cells have seen.
//
// Paths of up to eight edges have a cell for each strategy; all longer ones share one. Every cell
// has a thumbnail of at most 160 pixels in either direction; one of its pixels is the sum of a box
// of the image's pixels. A cell that somebody chose has a film of full size besides.
//
// Memory: some 96 bytes for a pixel of a cell. Thumbnails: 44 cells, at most 108 MB (62 MB at
// 16:9). Films of full size: as many as 1 GiB holds (12 at 1280 x 720), but always one.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "image/film.h"
#include "integrator/walk.h"

namespace midway {

inline constexpr int cell_edges = 8;
inline constexpr Strategy longer_paths{0, 0};  // the shared cell
inline constexpr int thumbnail_pixels = 160;
inline constexpr size_t full_size_bytes = size_t{1} << 30;

// What somebody wants to see of the strategies.
struct StrategyRequest {
    bool open = false;               // else nothing is gathered
    double exponent = 2;             // whose weights; the first one where there is no such
    std::vector<Strategy> selected;  // shown large, as one sum
    std::vector<Strategy> kept;      // chosen before, the latest first: kept while there is room
    bool operator==(const StrategyRequest&) const = default;
};

struct StrategyCell {
    Strategy strategy;
    Film thumbnail;
    std::unique_ptr<Film> full;
    std::uint64_t full_since = 0;  // passes that were done when `full` was begun
};

struct StrategyCells {
    PixelRect crop;
    int box = 1;              // pixels of the image along one of a thumbnail
    size_t exponent = 0;      // index of the weights' exponent
    std::uint64_t since = 0;  // passes that were done when the cells were begun
    std::vector<StrategyCell> cells;
    std::array<std::int8_t, strategy_count(cell_edges)> cell_of{};  // by strategy_index; -1: none
    int longer = -1;                                                // the shared cell, if any

    int index_of(const Strategy& k) const {
        const size_t i = k == longer_paths ? cell_of.size() : strategy_index(k);
        return i < cell_of.size() ? cell_of[i] : longer;
    }
};

// Where a strategy's statistics stand: all longer paths share the last of these slots.
inline constexpr size_t statistics_slots = strategy_count(cell_edges) + 1;

// Empty cells for the strategies that these settings have; `passes` are done.
StrategyCells make_cells(const Estimator& e, int unit_exponent, size_t exponent,
                         std::uint64_t passes);

// Begins and ends films of full size: those selected, then those kept, until the memory is full.
void keep_full_size(StrategyCells& cells, const StrategyRequest& request, std::uint64_t passes);

// The pixels of the image in one of a thumbnail, cut off at the crop's edge.
PixelRect thumbnail_box(const StrategyCells& cells, int x, int y);

// What one worker found in the box that it works in. Neighbouring samples share their box, so that
// their sums reach the thumbnails, which all workers share, in one addition.
class CellBuffer {
  public:
    // The pixel of the samples that follow. `lost` counts what left 128 bits.
    void move_to(StrategyCells& cells, int x, int y, std::uint64_t& lost) {
        if (!box_.contains(x, y)) change_box(cells, x, y, lost);
    }
    void add(int cell, const FixedRgb& weighted, const FixedRgb& bare, std::uint64_t& lost) {
        touched_ |= std::uint64_t{1} << cell;
        Sums& s = sums_[static_cast<size_t>(cell)];
        for (int c = 0; c < 3; ++c) {
            lost += __builtin_add_overflow(s.weighted[c], weighted[c], &s.weighted[c]);
            lost += __builtin_add_overflow(s.bare[c], bare[c], &s.bare[c]);
        }
    }
    // Gives the sums to the thumbnails.
    void flush(StrategyCells& cells, std::uint64_t& lost);

  private:
    struct Sums {
        FixedRgb weighted{}, bare{};
    };
    void change_box(StrategyCells& cells, int x, int y, std::uint64_t& lost);

    PixelRect box_;
    int x_ = 0, y_ = 0;  // of the thumbnails' pixel
    std::uint64_t touched_ = 0;
    std::array<Sums, strategy_count(cell_edges) + 1> sums_;
};

}  // namespace midway
