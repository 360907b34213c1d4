#include "render/renderer.h"

#include <time.h>

#include <condition_variable>
#include <mutex>
#include <thread>

#include "integrator/estimator_lanes.h"
#include "math/float_mode.h"
#include "render/pass_gate.h"
#include "render/worker_priority.h"

namespace midway {
namespace {

struct Tiles {
    PixelRect crop;
    int size = 32;
    int columns() const { return (crop.width() + size - 1) / size; }
    int rows() const { return (crop.height() + size - 1) / size; }
    std::uint64_t count() const { return std::uint64_t(columns()) * rows(); }
    PixelRect at(std::uint64_t i) const {
        const int x = crop.x0 + static_cast<int>(i % columns()) * size;
        const int y = crop.y0 + static_cast<int>(i / columns()) * size;
        return {x, y, std::min(x + size, crop.x1), std::min(y + size, crop.y1)};
    }
};

// Enough tiles for the threads to end together, also in a small image.
Tiles make_tiles(const PixelRect& crop, std::uint64_t passes, int threads) {
    Tiles tiles{crop};
    while (tiles.size > group_pixels && tiles.count() * passes < 16 * std::uint64_t(threads))
        tiles.size /= 2;
    return tiles;
}

// Where the block that holds v ends; blocks count from `origin`.
int block_end(int v, int origin, int size) { return origin + ((v - origin) / size + 1) * size; }

double thread_cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// Strategies (s, t) whose films are kept: those that exist for the estimator's families.
void make_layers(const Estimator& e, int edges, int unit,
                 std::vector<std::unique_ptr<StrategyFilms>>& layers) {
    const int longest = std::min(edges, e.max_bounces + 1);
    layers.resize(strategy_count(longest));
    for (int length = 1; length <= longest; ++length)
        for (int s = 1; s <= length + 1; ++s) {
            const Strategy k{s, length + 1 - s};
            if (k == Strategy{1, 1}) continue;
            if (!e.has(k) && !(k == Strategy{2, 0} && e.direct_lamps)) continue;
            layers[strategy_index(k)] = std::make_unique<StrategyFilms>(
                StrategyFilms{Film(e.crop.width(), e.crop.height(), unit),
                              Film(e.crop.width(), e.crop.height(), unit)});
        }
}

}  // namespace

ProgressiveRenderer::ProgressiveRenderer(std::shared_ptr<const Scene> scene,
                                         const CameraDescription& camera,
                                         const RenderSettings& settings,
                                         const RendererOptions& options)
    : scene_(std::move(scene)),
      estimator_(make_estimator(*scene_, camera, settings)),
      first_pass_(options.first_pass),
      background_(options.background),
      general_(options.general) {
    const int processors = std::max(1u, std::thread::hardware_concurrency());
    threads_ = options.threads > 0 ? options.threads : processors;
    const int unit = film_unit_exponent(scene_->total_power);
    for (int i = 0; i < estimator_.exponent_count; ++i)
        films_.emplace_back(estimator_.crop.width(), estimator_.crop.height(), unit);
    if (options.layer_edges > 0) make_layers(estimator_, options.layer_edges, unit, layers_);
    targets_.films = &films_;
    targets_.layers = layers_.empty() ? nullptr : &layers_;
    targets_.statistics = options.statistics;
    targets_.crop = estimator_.crop;
    targets_.recording = make_recording(settings);
    estimator_.watch = options.watch;
    if (options.statistics) begin_statistics(true, strategy_count(settings.max_bounces + 1) + 1);
}

// What the workers of one call of render_passes() share.
struct ProgressiveRenderer::Batch {
    Tiles tiles;
    std::uint64_t items = 0;
    const RenderControl* control = nullptr;
    std::atomic<std::uint64_t> next{0};
    PassGate gate;
};

template <Facts F, bool observed>
bool ProgressiveRenderer::work(Batch& batch, WorkerSums& sums) const {
    const ScopedFlushToZero flush;
    const Tiles& tiles = batch.tiles;
    LightSubpaths light;
    for (LightSubpath& l : light.of)
        l.reserve(static_cast<size_t>(std::min(estimator_.max_bounces, 64)));
    const auto lanes = std::make_unique<EstimatorLanes>();
    FilmRecord<observed> record(targets_, sums);
    const auto go_on = [&] { return !batch.control || batch.control->go_on(); };
    const auto render_group = [&](const PixelGroup& g, std::uint64_t pass) {
        if constexpr (F.one_power2)
            if (g.size() == lane_count)
                return estimate_lanes<F>(estimator_, g, pass, *lanes, record, sums.rays, go_on);
        return estimate<F>(estimator_, g, pass, light, record, sums.rays, go_on);
    };
    const auto render_block = [&](const PixelRect& r, std::uint64_t pass) {
        for (int y = r.y0; y < r.y1; ++y)
            for (int x = r.x0; x < r.x1; x += group_pixels) {
                const int n = (x - tiles.crop.x0) / group_pixels;
                if (!render_group(group_at(tiles.crop, n, y), pass)) return false;
            }
        return true;
    };
    // Where thumbnails are gathered, the samples of one of their pixels nearly follow each other.
    const int rows = observed && targets_.cells ? targets_.cells->box : tiles.size;
    const int columns = (rows + group_pixels - 1) / group_pixels * group_pixels;
    for (std::uint64_t i = batch.next++; i < batch.items; i = batch.next++) {
        if (!batch.gate.enter(i / tiles.count(), batch.control)) return true;
        const std::uint64_t pass = first_pass_ + passes_ + i / tiles.count();
        const PixelRect tile = tiles.at(i % tiles.count());
        for (int y0 = tile.y0, y1 = 0; y0 < tile.y1; y0 = y1) {
            y1 = std::min(tile.y1, block_end(y0, tiles.crop.y0, rows));
            for (int x0 = tile.x0, x1 = 0; x0 < tile.x1; x0 = x1) {
                x1 = std::min(tile.x1, block_end(x0, tiles.crop.x0, columns));
                if (!render_block({x0, y0, x1, y1}, pass)) return false;
            }
        }
    }
    return true;
}

bool ProgressiveRenderer::render_passes(std::uint64_t count,
                                        const std::function<void(double)>& tick,
                                        const RenderControl* control) {
    Batch batch{.tiles = make_tiles(estimator_.crop, count, threads_), .control = control};
    batch.items = count * batch.tiles.count();
    const bool observed = targets_.layers || targets_.statistics || targets_.cells;
    const auto run = [&](WorkerSums& s) {
        return with_facts(facts(), [&]<Facts F> {
            return observed ? work<F, true>(batch, s) : work<F, false>(batch, s);
        });
    };
    std::vector<WorkerSums> sums(threads_);
    std::mutex mutex;
    std::condition_variable finished;
    int running = threads_;
    bool whole = true;
    {
        std::vector<std::jthread> workers;
        for (WorkerSums& s : sums) {
            s.strategies.resize(totals_.strategies.size());
            s.strategy_rays.resize(totals_.strategy_rays.size());
            if (targets_.statistics) s.rays.by_strategy = &s.strategy_rays;
            workers.emplace_back([&] {
                if (background_) lower_priority();
                const bool done = run(s);
                const std::lock_guard lock(mutex);
                whole &= done;
                cpu_seconds_ += thread_cpu_seconds();
                --running;
                finished.notify_one();
            });
        }
        std::unique_lock lock(mutex);
        const auto all_done = [&] { return running == 0; };
        // Without a tick nothing wakes before the end, so that a paused render costs nothing.
        if (!tick) finished.wait(lock, all_done);
        while (!finished.wait_for(lock, std::chrono::milliseconds(100), all_done))
            tick(std::min(1.0, double(batch.next) / double(batch.items)));
    }
    for (const WorkerSums& s : sums) merge(s);
    if (whole) passes_ += batch.gate.passes();
    return whole;
}

void ProgressiveRenderer::begin_statistics(bool on, size_t strategies) {
    targets_.statistics = on;
    totals_.strategies.assign(on ? strategies : 0, {});
    totals_.strategy_rays.assign(on ? strategies : 0, 0);
    statistics_since_ = passes_;
}

void ProgressiveRenderer::observe(const StrategyRequest& request) {
    if (!request.open) {
        if (cells_) begin_statistics(false, 0);
        cells_.reset();
        targets_.cells = nullptr;
        targets_.observed_exponent = 0;
        return;
    }
    size_t exponent = 0;
    for (size_t i = 0; i < films_.size(); ++i)
        if (estimator_.exponents[i] == request.exponent) exponent = i;
    if (!cells_ || cells_->exponent != exponent) {
        cells_ = std::make_unique<StrategyCells>(
            make_cells(estimator_, films_.front().unit_exponent(), exponent, passes_));
        targets_.cells = cells_.get();
        targets_.observed_exponent = exponent;
        totals_.cells_lost = 0;
        begin_statistics(true, statistics_slots);
    }
    keep_full_size(*cells_, request, passes_);
}

void ProgressiveRenderer::adopt(std::vector<Film> films, std::uint64_t passes) {
    films_ = std::move(films);
    passes_ = passes;
}

void ProgressiveRenderer::merge(const WorkerSums& s) {
    totals_.rays.closest += s.rays.closest;
    totals_.rays.shadow += s.rays.shadow;
    totals_.rays.camera_paths += s.rays.camera_paths;
    totals_.rays.light_paths += s.rays.light_paths;
    totals_.fixed.inexact += s.fixed.inexact;
    totals_.fixed.overflow += s.fixed.overflow;
    totals_.nonfinite.merge(s.nonfinite);
    totals_.clamped += s.clamped;
    totals_.cells_lost += s.cells_lost;
    for (size_t i = 0; i < s.strategies.size(); ++i) {
        totals_.strategies[i].samples += s.strategies[i].samples;
        totals_.strategies[i].energy += s.strategies[i].energy;
        totals_.strategies[i].second_moment += s.strategies[i].second_moment;
        totals_.strategy_rays[i] += s.strategy_rays[i];
    }
}

Image ProgressiveRenderer::image(int exponent) const { return resolve(films_[exponent], counts()); }

Image ProgressiveRenderer::variance(int exponent) const {
    return resolve_variance(films_[exponent], counts());
}

std::vector<ProgressiveRenderer::Layer> ProgressiveRenderer::layers() const {
    std::vector<Layer> result;
    for (int edges = 1; strategy_index({1, edges}) < layers_.size(); ++edges)
        for (int s = 1; s <= edges + 1; ++s) {
            const Strategy k{s, edges + 1 - s};
            const size_t i = strategy_index(k);
            if (i < layers_.size() && layers_[i]) result.push_back({k, layers_[i].get()});
        }
    return result;
}

StrategyStatistics ProgressiveRenderer::statistics_of(const Strategy& k, size_t slot) const {
    const int unit = films_.front().unit_exponent();
    const double n =
        std::max(1.0, double(passes_ - statistics_since_) * double(estimator_.crop.area()));
    const StrategySums& sums = totals_.strategies[slot];
    return {k, sums.samples, totals_.strategy_rays[slot], from_fixed(sums.energy, unit) / n,
            from_fixed(sums.second_moment, 2 * unit + 90) / n};
}

RenderStatistics ProgressiveRenderer::statistics() const {
    RenderStatistics r;
    r.rays = totals_.rays;
    r.fixed = totals_.fixed;
    r.nonfinite = totals_.nonfinite;
    r.clamped = totals_.clamped;
    for (int edges = 1; strategy_count(edges) < totals_.strategies.size(); ++edges)
        for (int s = edges + 1; s >= 1; --s) {
            const Strategy k{s, edges + 1 - s};
            const StrategyStatistics found = statistics_of(k, strategy_index(k));
            if (found.samples > 0 || found.rays > 0) r.strategies.push_back(found);
        }
    return r;
}

std::vector<StrategyStatistics> ProgressiveRenderer::cell_statistics() const {
    std::vector<StrategyStatistics> result;
    if (!cells_) return result;
    for (const StrategyCell& cell : cells_->cells) {
        const bool own = !(cell.strategy == longer_paths);
        const size_t last = totals_.strategies.size() - 1;
        result.push_back(statistics_of(cell.strategy, own ? strategy_index(cell.strategy) : last));
    }
    return result;
}

}  // namespace midway
