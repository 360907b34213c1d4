// The strategy pyramid as a window sees it: thumbnails of all cells in one picture, weighted and
// bare, each cell's shares, and the sum of the cells that somebody chose, at full size.
#pragma once

#include "render/live_images.h"
#include "render/live_job.h"

namespace midway {

// A cell of the pyramid. Energy and second moment are means per pixel and pass of the weighted
// contributions. The variance of a pixel's sample is what of the second moment is not its mean's
// square (a lamp that is seen has a large second moment and no noise); the mean is taken over a
// thumbnail's pixel. Splats come by chance in any number: theirs is the second moment itself
// (Campbell's theorem). What contributions of one sample have in common is left out.
struct CellSnapshot {
    StrategyStatistics found;  // strategy longer_paths: the cell that longer paths share
    double variance = 0;
    float weighted_ev = 0, bare_ev = 0;  // the exposure that suits its thumbnail alone
};

struct StrategySnapshot {
    double exponent = 2;       // whose weights
    std::uint64_t passes = 0;  // in thumbnails and shares
    std::vector<CellSnapshot> cells;

    // Tile i of the pictures, in reading order, is the thumbnail of cell i.
    int tile_width = 0, tile_height = 0, columns = 1;
    int box = 1;               // pixels of the whole image along one of a thumbnail
    ImagePlacement placement;  // of a thumbnail in the whole image
    std::shared_ptr<const Image> weighted, bare;  // null before the first pass

    // The sum of these cells at full size; null where one of them has no whole pass yet, or no
    // room.
    std::vector<Strategy> selected;
    std::uint64_t selected_passes = 0;  // in the cell chosen last
    std::shared_ptr<const Image> selected_weighted, selected_bare;

    std::uint64_t lost = 0;  // contributions that did not fit into a cell

    const CellSnapshot* find(const Strategy& k) const;
};

// How a renderer's pixels lie in the whole image (scaled_view).
struct StrategyView {
    ImagePlacement placement;
    int scale = 1;
};

// What the renderer observes, resolved on all its threads; null where it does not observe. The
// renderer is at rest.
std::shared_ptr<const StrategySnapshot> resolve_strategies(const ProgressiveRenderer& renderer,
                                                           const StrategyRequest& request,
                                                           const StrategyView& view,
                                                           ImagePool& pool);

// One thumbnail, cut out of the picture.
Image thumbnail(const StrategySnapshot& s, size_t cell, bool bare);

}  // namespace midway
