#include "render/live_strategies.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "image/tonemap.h"
#include "render/worker_priority.h"

namespace midway {
namespace {

constexpr int atlas_columns = 8;

// Calls work(i) for all i below `count`, on all threads.
template <class Work>
void share(int threads, int count, const Work& work) {
    std::atomic<int> next{0};
    std::vector<std::jthread> workers;
    for (int k = 0; k < std::min(threads, count); ++k)
        workers.emplace_back([&] {
            lower_priority();
            for (int i = next++; i < count; i = next++) work(i);
        });
}

vec3 mean(const FixedRgb& sum, double unit_over_samples) {
    vec3 v;
    for (int c = 0; c < 3; ++c)
        v[c] = static_cast<float>(static_cast<double>(sum[c]) * unit_over_samples);
    return v;
}

struct Atlas {
    const StrategyCells& cells;
    StrategySnapshot& snapshot;
    Image &weighted, &bare;
};

// Draws thumbnail i into the pictures; black where there is no such cell. Sums by one thread in the
// order of the pixels, so the variance does not depend on how tiles are shared.
void draw_tile(const Atlas& a, int i) {
    StrategySnapshot& s = a.snapshot;
    const int left = i % s.columns * s.tile_width, top = i / s.columns * s.tile_height;
    const bool exists = i < static_cast<int>(a.cells.cells.size());
    double squares = 0;  // of the means, over all pixels
    for (int y = 0; y < s.tile_height; ++y)
        for (int x = 0; x < s.tile_width; ++x) {
            vec3 weighted(0), bare(0);
            if (exists) {
                const Film& film = a.cells.cells[static_cast<size_t>(i)].thumbnail;
                const double pixels = double(thumbnail_box(a.cells, x, y).area());
                const double samples = pixels * double(s.passes);
                const double unit = std::ldexp(1.0, film.unit_exponent()) / samples;
                weighted = mean(film.sum(0, x, y), unit);
                bare = mean(film.sum(1, x, y), unit);
                squares += pixels * sqr(double(luminance(weighted)));
            }
            a.weighted.at(left + x, top + y) = weighted;
            a.bare.at(left + x, top + y) = bare;
        }
    if (!exists) return;
    CellSnapshot& cell = s.cells[static_cast<size_t>(i)];
    cell.variance = cell.found.second_moment;
    if (cell.found.strategy.s >= 2)
        cell.variance = std::max(0.0, cell.variance - squares / double(a.cells.crop.area()));
    cell.weighted_ev = auto_exposure(thumbnail(s, static_cast<size_t>(i), false));
    cell.bare_ev = auto_exposure(thumbnail(s, static_cast<size_t>(i), true));
}

void draw_atlas(const ProgressiveRenderer& r, ImagePool& pool, StrategySnapshot& s) {
    const int tiles = static_cast<int>(s.cells.size());
    const int rows = (tiles + s.columns - 1) / s.columns;
    const auto weighted = pool.take(s.columns * s.tile_width, rows * s.tile_height);
    const auto bare = pool.take(s.columns * s.tile_width, rows * s.tile_height);
    s.weighted = weighted;
    s.bare = bare;
    const Atlas atlas{*r.cells(), s, *weighted, *bare};
    share(r.threads(), rows * s.columns, [&](int i) { draw_tile(atlas, i); });
}

// The cells chosen, each with the passes that its film holds; empty where one cannot be shown.
struct Chosen {
    const Film* film = nullptr;
    std::uint64_t passes = 0;
};
std::vector<Chosen> chosen_films(const ProgressiveRenderer& r, const StrategyRequest& request) {
    std::vector<Chosen> films;
    for (const Strategy& k : request.selected) {
        const int i = r.cells()->index_of(k);
        if (i < 0) continue;
        const StrategyCell& cell = r.cells()->cells[static_cast<size_t>(i)];
        if (!cell.full || r.passes() == cell.full_since) return {};
        films.push_back({cell.full.get(), r.passes() - cell.full_since});
    }
    return films;
}

void draw_selection(const ProgressiveRenderer& r, const StrategyRequest& request, ImagePool& pool,
                    StrategySnapshot& s) {
    const std::vector<Chosen> films = chosen_films(r, request);
    if (films.empty()) return;
    const int width = films[0].film->width(), height = films[0].film->height();
    const auto weighted = pool.take(width, height), bare = pool.take(width, height);
    share(r.threads(), height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            vec3 w(0), b(0);
            for (const Chosen& c : films) {
                const double unit = std::ldexp(1.0, c.film->unit_exponent()) / double(c.passes);
                w += mean(c.film->sum(0, x, y), unit);
                b += mean(c.film->sum(1, x, y), unit);
            }
            weighted->at(x, y) = w;
            bare->at(x, y) = b;
        }
    });
    s.selected_weighted = weighted;
    s.selected_bare = bare;
    s.selected_passes = films.back().passes;
}

}  // namespace

const CellSnapshot* StrategySnapshot::find(const Strategy& k) const {
    const auto at =
        std::ranges::find_if(cells, [&](const CellSnapshot& c) { return c.found.strategy == k; });
    return at == cells.end() ? nullptr : &*at;
}

Image thumbnail(const StrategySnapshot& s, size_t cell, bool bare) {
    const Image& all = bare ? *s.bare : *s.weighted;
    const int i = static_cast<int>(cell);
    const int left = i % s.columns * s.tile_width, top = i / s.columns * s.tile_height;
    Image image(s.tile_width, s.tile_height);
    for (int y = 0; y < s.tile_height; ++y)
        for (int x = 0; x < s.tile_width; ++x) image.at(x, y) = all.at(left + x, top + y);
    return image;
}

std::shared_ptr<const StrategySnapshot> resolve_strategies(const ProgressiveRenderer& r,
                                                           const StrategyRequest& request,
                                                           const StrategyView& view,
                                                           ImagePool& pool) {
    const StrategyCells* cells = r.cells();
    if (!cells || cells->cells.empty()) return {};
    auto s = std::make_shared<StrategySnapshot>();
    s->exponent = r.estimator().exponents[cells->exponent];
    s->passes = r.passes() - cells->since;
    for (const StrategyStatistics& found : r.cell_statistics()) s->cells.push_back({found});
    s->columns = std::min<int>(atlas_columns, static_cast<int>(cells->cells.size()));
    s->tile_width = cells->cells.front().thumbnail.width();
    s->tile_height = cells->cells.front().thumbnail.height();
    s->box = cells->box * view.scale;
    s->placement = view.placement;
    s->placement.x1 = s->placement.x0 + double(s->tile_width) * s->box;
    s->placement.y1 = s->placement.y0 + double(s->tile_height) * s->box;
    s->selected = request.selected;
    s->lost = r.cells_lost();
    if (s->passes > 0) draw_atlas(r, pool, *s);
    draw_selection(r, request, pool, *s);
    return s;
}

}  // namespace midway
