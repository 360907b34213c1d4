#include "render/pilot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "integrator/estimator.h"
#include "math/float_mode.h"
#include "render/coverage.h"

namespace midway {
namespace {

// Places of the samples: strata of the crop, a pair in each.
constexpr int columns = 256, rows = 64;
constexpr int samples = 2 * columns * rows;
// What one thread does at a time. Sums are kept apart by chunk and added in their order.
constexpr int chunks = 32, rows_per_chunk = rows / chunks;
// Errors are relative to the image, which is known coarsely: in blocks, at most so many a side.
constexpr int most_blocks = 64;
// As in the trimmed relMSE: a few pixels that no plan can help must not decide.
constexpr double trimmed_share = 0.001;
// A plan that needs more kinds of strategy must be so much better.
constexpr double margin = 0.98;
constexpr std::uint64_t pilot_seed = 0x70696c6f74;

// The weights of the pilot's samples: exponent 1 three times, over these families.
enum Column { all, camera_side, without_connections, column_count };

// Prices, in units of a camera walk's ray. Measured on the project's scenes (tests/README.md).
struct Prices {
    double sample = 0.5, camera_ray = 1, next_event = 0.7;
    double subpath = 0.4, light_ray = 0.9, light_tracing = 0.6, connection = 0.5;
};

struct Candidates {
    std::array<Plan, 8> plans;
    int count = 0;
    void add(const Families& f, int quarters) { plans[count++] = {f, quarters}; }
};
constexpr size_t most_candidates = 8;

struct BlockSums {
    double image = 0;         // of luminance
    double splat_square = 0;  // of the full plan's splats
    // What the second moment of each plan has more than the full one's.
    std::array<double, most_candidates> excess{};
};

struct Pair {
    double square = 0;  // of the difference of the two samples' luminances
    int block = 0;
};

struct Counts {
    RayCounts camera, light;
    std::vector<std::uint64_t> by_strategy;
};

struct ChunkResult {
    std::vector<BlockSums> blocks;
    std::vector<Pair> pairs;
    Counts counts;
};

struct Grid {
    PixelRect crop;
    int x = 1, y = 1;
    explicit Grid(const PixelRect& c)
        : crop(c), x(std::min(most_blocks, c.width())), y(std::min(most_blocks, c.height())) {}
    int block(int px, int py) const {
        return static_cast<int>(std::int64_t{py - crop.y0} * y / crop.height()) * x +
               static_cast<int>(std::int64_t{px - crop.x0} * x / crop.width());
    }
};

double light_share(const Plan& p) { return p.light_quarters / 4.0; }

// Sums over strategies j of n_j p_j / (n_k p_k), from the weights of strategy k.
struct Densities {
    double camera_side = 0, light_tracing = 0, connection = 0;
    double full = 0;
    double of(const Plan& p) const {
        return camera_side + (p.families.light_tracing ? light_share(p) * light_tracing : 0) +
               (p.families.connection ? connection : 0);
    }
};

Densities densities(const Contribution& c) {
    const Family family = family_of(c.strategy);
    const bool on_camera_side = family == Family::emitter_hit || family == Family::next_event;
    const bool connects = family == Family::connection;
    // A weight is 1 / (1 + the others); the 1 belongs to k, which need not be of the plan.
    const double own_only = 1 / c.weights[camera_side] - (on_camera_side ? 0 : 1);
    const double no_connections = 1 / c.weights[without_connections] - (connects ? 1 : 0);
    Densities d;
    d.full = 1 / c.weights[all];
    d.camera_side = std::max(0.0, own_only);
    d.light_tracing = std::max(0.0, no_connections - own_only);
    d.connection = std::max(0.0, d.full - no_connections);
    return d;
}

class PilotRecord {
  public:
    PilotRecord(const Grid& grid, const Candidates& candidates, std::vector<BlockSums>& blocks)
        : grid_(grid), candidates_(candidates), blocks_(blocks) {}

    void begin(int x, int y) {
        block_ = grid_.block(x, y);
        luminance_ = 0;
    }
    double end() const { return luminance_; }

    bool wants(const Strategy&) const { return true; }
    void contribution(const Contribution& c) { luminance_ += add(blocks_[block_], c); }
    void splat(int x, int y, const Contribution& c) {
        BlockSums& b = blocks_[grid_.block(x, y)];
        b.splat_square += sqr(add(b, c));
    }

  private:
    // Returns the weighted luminance.
    double add(BlockSums& b, const Contribution& c) const {
        const double value = luminance(c.value), weight = c.weights[all];
        if (!(value > 0) || !(weight > 0) || !std::isfinite(value)) return 0;
        const Densities d = densities(c);
        const double square = weight * value * value;
        for (int i = 0; i < candidates_.count; ++i)
            b.excess[i] += square * (1 / d.of(candidates_.plans[i]) - weight);
        b.image += weight * value;
        return weight * value;
    }

    const Grid& grid_;
    const Candidates& candidates_;
    std::vector<BlockSums>& blocks_;
    int block_ = 0;
    double luminance_ = 0;
};

// Plans that make every path the full one makes.
Candidates find_candidates(const Scene& scene, const Estimator& full) {
    const SceneFeatures features = scene_features(scene);
    const auto gaps = [&](const Families& f) {
        return not_covered(features, f, full.direct_lamps).size();
    };
    const Families& f = full.families;
    const size_t fewest = gaps(f);
    Candidates c;
    const Families own{f.emitter_hit, f.next_event, false, false};
    if (gaps(own) == fewest) c.add(own, 0);
    if (f.light_tracing) {
        const Families tracing{f.emitter_hit, f.next_event, true, false};
        if (gaps(tracing) == fewest)
            for (const int quarters : {1, 2, 4, 8}) c.add(tracing, quarters);
    }
    if (f.connection) {
        const Families connecting{f.emitter_hit, f.next_event, false, true};
        if (f.light_tracing && gaps(connecting) == fewest) c.add(connecting, 4);
        c.add(f, 4);
        if (f.light_tracing) c.add(f, 8);
    }
    return c;
}

Estimator pilot_estimator(const Scene& scene, const CameraDescription& camera, RenderSettings s) {
    s.plan.reset();
    s.exponents.assign(column_count, 1.0);
    s.seed = pilot_seed;
    Estimator e = make_estimator(scene, camera, s);
    e.weighed[camera_side].light_tracing = e.weighed[camera_side].connection = false;
    e.weighed[without_connections].connection = false;
    return e;
}

void sample_pair(const Estimator& e, const Grid& grid, int column, int row, PilotRecord& record,
                 LightSubpath& scratch, ChunkResult& result) {
    const std::uint64_t stratum = std::uint64_t(row) * columns + column;
    const std::uint64_t jitter = hash_combine(pilot_seed, stratum);
    const auto place = [](int i, std::uint32_t random, int strata, int size) {
        const double u = (i + random * 0x1p-32) / strata;
        return std::min(static_cast<int>(u * size), size - 1);
    };
    const int x = e.crop.x0 + place(column, std::uint32_t(jitter), columns, e.crop.width());
    const int y = e.crop.y0 + place(row, std::uint32_t(jitter >> 32), rows, e.crop.height());
    double luminances[2];
    for (int half = 0; half < 2; ++half) {
        const std::uint64_t pass = 2 * stratum + half;
        record.begin(x, y);
        scratch.clear();
        if (e.families.needs_light_subpaths())
            trace_light_subpath(e, paired_subpath(e, x, y, pass), pass, scratch, record,
                                result.counts.light);
        trace_camera_subpath(e, x, y, pass, scratch, record, result.counts.camera);
        luminances[half] = record.end();
    }
    result.pairs.push_back({sqr(luminances[0] - luminances[1]), grid.block(x, y)});
}

ChunkResult sample_chunk(const Estimator& e, const Grid& grid, const Candidates& candidates,
                         int chunk, const RenderControl* control) {
    ChunkResult result;
    result.blocks.resize(size_t(grid.x) * grid.y);
    result.counts.by_strategy.resize(strategy_count(e.max_bounces + 1) + 1);
    result.counts.camera.by_strategy = result.counts.light.by_strategy = &result.counts.by_strategy;
    PilotRecord record(grid, candidates, result.blocks);
    LightSubpath scratch;
    for (int row = chunk * rows_per_chunk; row < (chunk + 1) * rows_per_chunk; ++row)
        for (int column = 0; column < columns; ++column) {
            if (control && !control->go_on()) return {};
            sample_pair(e, grid, column, row, record, scratch, result);
        }
    result.counts.camera.by_strategy = result.counts.light.by_strategy = nullptr;
    return result;
}

// Empty where `control` ended it.
std::vector<ChunkResult> sample_all(const Estimator& e, const Grid& grid,
                                    const Candidates& candidates, int threads,
                                    const RenderControl* control) {
    if (threads < 1) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<ChunkResult> results(chunks);
    std::atomic<int> next{0};
    {
        std::vector<std::jthread> workers;
        for (int i = 0; i < std::min(threads, chunks); ++i)
            workers.emplace_back([&] {
                const ScopedFlushToZero flush;
                for (int c = next++; c < chunks; c = next++)
                    results[c] = sample_chunk(e, grid, candidates, c, control);
            });
    }
    for (const ChunkResult& r : results)
        if (r.pairs.empty()) return {};
    return results;
}

ChunkResult added(std::vector<ChunkResult>& parts) {
    ChunkResult all = std::move(parts.front());
    for (size_t i = 1; i < parts.size(); ++i) {
        const ChunkResult& p = parts[i];
        for (size_t b = 0; b < all.blocks.size(); ++b) {
            all.blocks[b].image += p.blocks[b].image;
            all.blocks[b].splat_square += p.blocks[b].splat_square;
            for (size_t k = 0; k < most_candidates; ++k)
                all.blocks[b].excess[k] += p.blocks[b].excess[k];
        }
        all.pairs.insert(all.pairs.end(), p.pairs.begin(), p.pairs.end());
        for (size_t k = 0; k < all.counts.by_strategy.size(); ++k)
            all.counts.by_strategy[k] += p.counts.by_strategy[k];
        all.counts.camera.closest += p.counts.camera.closest;
        all.counts.light.closest += p.counts.light.closest;
    }
    return all;
}

// Without the largest so many.
double trimmed_sum(std::vector<double>& values, size_t trimmed) {
    std::sort(values.begin(), values.end());
    double sum = 0;
    for (size_t i = 0; i + trimmed < values.size(); ++i) sum += values[i];
    return sum;
}

// The relative squared error of each plan, per sample of a pixel; the last element is that of the
// full one.
std::vector<double> relative_errors(const ChunkResult& r, const Grid& grid, int candidates) {
    std::vector<double> pixels(r.blocks.size(), 0.0), scale(r.blocks.size());
    for (int y = grid.crop.y0; y < grid.crop.y1; ++y)
        for (int x = grid.crop.x0; x < grid.crop.x1; ++x) ++pixels[grid.block(x, y)];
    double mean = 0;
    for (const BlockSums& b : r.blocks) mean += b.image / samples;
    for (size_t b = 0; b < r.blocks.size(); ++b) {
        const double image = r.blocks[b].image * double(grid.crop.area()) / (samples * pixels[b]);
        const double denominator = sqr(image) + 0.01 * sqr(mean);
        scale[b] = denominator > 0 ? 1 / denominator : 0;
    }
    std::vector<double> squares;
    for (const Pair& p : r.pairs) squares.push_back(p.square * scale[p.block]);
    double common = trimmed_sum(squares, size_t(trimmed_share * double(squares.size())));
    for (size_t b = 0; b < r.blocks.size(); ++b) common += r.blocks[b].splat_square * scale[b];
    std::vector<double> errors;
    for (int i = 0; i < candidates; ++i) {
        std::vector<double> excess;
        for (size_t b = 0; b < r.blocks.size(); ++b)
            excess.push_back(r.blocks[b].excess[i] * scale[b]);
        const double more = trimmed_sum(excess, size_t(trimmed_share * double(excess.size())));
        errors.push_back((common + more) / samples);
    }
    errors.push_back(common / samples);
    return errors;
}

double cost_of(const Plan& p, const Counts& n) {
    const Prices price;
    std::array<double, 4> rays{};
    for (int edges = 1; strategy_count(edges) < n.by_strategy.size(); ++edges)
        for (int s = 1; s <= edges + 1; ++s) {
            const Strategy k{s, edges + 1 - s};
            rays[size_t(family_of(k))] += double(n.by_strategy[strategy_index(k)]);
        }
    const double camera = price.sample * samples + price.camera_ray * double(n.camera.closest) +
                          price.next_event * rays[size_t(Family::next_event)];
    double light = price.subpath * samples + price.light_ray * double(n.light.closest);
    if (p.families.light_tracing)
        light += price.light_tracing * rays[size_t(Family::light_tracing)];
    const double connections =
        p.families.connection ? price.connection * rays[size_t(Family::connection)] : 0;
    return camera + light_share(p) * light + connections;
}

}  // namespace

const PlanForecast& PlanDecision::chosen() const {
    return *std::find_if(forecasts.begin(), forecasts.end(),
                         [&](const PlanForecast& f) { return f.plan == plan; });
}

namespace {

// Plans with connections end their walks by roulette earlier than others (make_estimator), which
// changes noise and cost alike: each kind is measured with its own, from the same random numbers.
struct Run {
    ChunkResult sums;
    std::vector<double> errors;  // relative_errors()
};
std::optional<Run> run_pilot(const Estimator& e, const Candidates& candidates, int threads,
                             const RenderControl* control) {
    const Grid grid(e.crop);
    std::vector<ChunkResult> parts = sample_all(e, grid, candidates, threads, control);
    if (parts.empty()) return {};
    Run run{added(parts), {}};
    run.errors = relative_errors(run.sums, grid, candidates.count);
    return run;
}

}  // namespace

std::optional<PlanDecision> decide_plan(const Scene& scene, const CameraDescription& camera,
                                        const RenderSettings& settings, int threads,
                                        const RenderControl* control) {
    const auto start = std::chrono::steady_clock::now();
    const Estimator e = pilot_estimator(scene, camera, settings);
    const Candidates candidates = find_candidates(scene, e);
    const Plan full{e.families, e.families.needs_light_subpaths() ? 4 : 0};
    PlanDecision decision{full, {}};
    if (candidates.count < 2) {
        decision.forecasts.push_back({full});
        return decision;
    }
    Estimator unconnected = e;
    unconnected.roulette_start = roulette_start(Families{true, true, true, false});
    const std::optional<Run> a = run_pilot(e, candidates, threads, control);
    const std::optional<Run> b = run_pilot(unconnected, candidates, threads, control);
    if (!a || !b) return {};
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < candidates.count; ++i) {
        PlanForecast f{candidates.plans[i]};
        const Run& run = f.plan.families.connection ? *a : *b;
        f.cost = cost_of(f.plan, run.sums.counts) / cost_of(full, a->sums.counts);
        // A black image has no error to compare: the cheapest plan then.
        f.error = a->errors.back() > 0 ? run.errors[i] / a->errors.back() : 1;
        if (!(f.error > 0)) f.error = std::numeric_limits<double>::infinity();
        if (f.time() < margin * best) {
            best = f.time();
            decision.plan = f.plan;
        }
        decision.forecasts.push_back(f);
    }
    decision.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return decision;
}

std::string describe(const Plan& plan) {
    const Families& f = plan.families;
    if (!f.needs_light_subpaths()) return "path tracing, no light subpaths";
    std::string what = "all families";
    if (!f.connection) what = "path and light tracing, no connections";
    if (!f.light_tracing) what = "connections, no light tracing";
    constexpr const char* numbers[] = {"no", "a quarter of a", "half a", "", "one", "", "", "",
                                       "two"};
    return fmt::format("{}, {} light subpath{} per pixel", what, numbers[plan.light_quarters],
                       plan.light_quarters > 4 ? "s" : "");
}

std::string describe(const PlanDecision& decision) {
    const PlanForecast& f = decision.chosen();
    if (decision.forecasts.size() < 2)
        return describe(f.plan) + ": no other plan covers what it covers";
    return fmt::format("{}; expected {:.2g} of the time of plain bdpt for the same error",
                       describe(f.plan), f.time());
}

std::optional<PlanDecision> choose_plan(const Scene& scene, const CameraDescription& camera,
                                        RenderSettings& settings, int threads) {
    if (settings.technique != Technique::automatic || settings.plan) return {};
    std::optional<PlanDecision> decision = decide_plan(scene, camera, settings, threads);
    settings.plan = decision->plan;
    return decision;
}

}  // namespace midway
