#include "render/pilot_sums.h"

#include <atomic>
#include <cmath>
#include <thread>

#include "math/float_mode.h"

namespace midway {
namespace {

// What one thread does at a time.
constexpr int chunks = 32, rows_per_chunk = pilot_rows / chunks;
constexpr std::uint64_t pilot_seed = 0x70696c6f74;

// The weights of the pilot's samples: exponent 1 four times, over these families.
enum Column { all, emitter_hits, camera_side, without_connections, column_count };

// Sums over strategies j of n_j p_j / (n_k p_k), by family, from the weights of strategy k.
struct Densities {
    double emitter_hit = 0, next_event = 0, light_tracing = 0, connection = 0;
    double of(const Plan& p) const {
        return emitter_hit + next_event +
               (p.families.light_tracing ? light_share(p) * light_tracing : 0) +
               (p.families.connection ? connection : 0);
    }
};

Densities densities(const Contribution& c) {
    const Family family = family_of(c.strategy);
    // A weight is 1 / (1 + the others); the 1 belongs to k, which need not be of the column.
    const auto sum = [&](Column column, bool counts_k) {
        return 1 / c.weights[column] - (counts_k ? 0 : 1);
    };
    const bool hit = family == Family::emitter_hit;
    const bool on_camera_side = hit || family == Family::next_event;
    const double hits = sum(emitter_hits, hit), own = sum(camera_side, on_camera_side);
    const double unconnected = sum(without_connections, family != Family::connection);
    return {std::max(0.0, hits), std::max(0.0, own - hits), std::max(0.0, unconnected - own),
            std::max(0.0, sum(all, true) - unconnected)};
}

void add_energy(Energies& e, int length, double energy, const Densities& d, const Plan& p) {
    const double one = energy / d.of(p);
    e[length] += one * d.emitter_hit;
    e[lengths + length] += one * d.next_event;
    if (p.families.connection) e[2 * lengths + length] += one * d.connection;
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
        const double energy = weight * value;
        const int length = length_group(c.strategy);
        for (int i = 0; i < candidates_.count; ++i) {
            b.excess[i] += energy * value * (1 / d.of(candidates_.plans[i]) - weight);
            add_energy(b.energy[i], length, energy, d, candidates_.plans[i]);
        }
        add_energy(b.full_energy, length, energy, d, {});
        b.image += energy;
        return energy;
    }

    const Grid& grid_;
    const Candidates& candidates_;
    std::vector<BlockSums>& blocks_;
    int block_ = 0;
    double luminance_ = 0;
};

void sample_pair(const Estimator& e, const Grid& grid, int column, int row, PilotRecord& record,
                 LightSubpath& scratch, PilotSums& result) {
    const std::uint64_t stratum = std::uint64_t(row) * pilot_columns + column;
    const std::uint64_t jitter = hash_combine(pilot_seed, stratum);
    const auto place = [](int i, std::uint32_t random, int strata, int size) {
        const double u = (i + random * 0x1p-32) / strata;
        return std::min(static_cast<int>(u * size), size - 1);
    };
    const int x = e.crop.x0 + place(column, std::uint32_t(jitter), pilot_columns, e.crop.width());
    const int y = e.crop.y0 + place(row, std::uint32_t(jitter >> 32), pilot_rows, e.crop.height());
    double luminances[2];
    for (int half = 0; half < 2; ++half) {
        const std::uint64_t pass = 2 * stratum + half;
        record.begin(x, y);
        scratch.clear();
        if (e.families.needs_light_subpaths())
            trace_light_subpath(e, paired_subpath(e, x, y, pass), pass, scratch, record,
                                result.light);
        trace_camera_subpath(e, x, y, pass, scratch, record, result.camera);
        luminances[half] = record.end();
    }
    result.pairs.push_back({sqr(luminances[0] - luminances[1]), grid.block(x, y)});
}

PilotSums sample_chunk(const Estimator& e, const Grid& grid, const Candidates& candidates,
                       int chunk, const RenderControl* control) {
    PilotSums result;
    result.blocks.resize(size_t(grid.x) * grid.y);
    result.shadow_rays.resize(strategy_count(e.max_bounces + 1) + 1);
    result.camera.by_strategy = result.light.by_strategy = &result.shadow_rays;
    PilotRecord record(grid, candidates, result.blocks);
    LightSubpath scratch;
    for (int row = chunk * rows_per_chunk; row < (chunk + 1) * rows_per_chunk; ++row)
        for (int column = 0; column < pilot_columns; ++column) {
            if (control && !control->go_on()) return {};
            sample_pair(e, grid, column, row, record, scratch, result);
        }
    result.camera.by_strategy = result.light.by_strategy = nullptr;
    return result;
}

// Empty where `control` ended it.
std::vector<PilotSums> sample_chunks(const Estimator& e, const Grid& grid,
                                     const Candidates& candidates, int threads,
                                     const RenderControl* control) {
    if (threads < 1) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<PilotSums> results(chunks);
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
    for (const PilotSums& r : results)
        if (r.pairs.empty()) return {};
    return results;
}

void add_to(Energies& to, const Energies& from) {
    for (int g = 0; g < groups; ++g) to[g] += from[g];
}

PilotSums added(std::vector<PilotSums>& parts) {
    PilotSums all = std::move(parts.front());
    for (size_t i = 1; i < parts.size(); ++i) {
        const PilotSums& p = parts[i];
        for (size_t b = 0; b < all.blocks.size(); ++b) {
            all.blocks[b].image += p.blocks[b].image;
            all.blocks[b].splat_square += p.blocks[b].splat_square;
            for (size_t k = 0; k < most_candidates; ++k) {
                all.blocks[b].excess[k] += p.blocks[b].excess[k];
                add_to(all.blocks[b].energy[k], p.blocks[b].energy[k]);
            }
            add_to(all.blocks[b].full_energy, p.blocks[b].full_energy);
        }
        all.pairs.insert(all.pairs.end(), p.pairs.begin(), p.pairs.end());
        for (size_t k = 0; k < all.shadow_rays.size(); ++k) all.shadow_rays[k] += p.shadow_rays[k];
        all.camera.closest += p.camera.closest;
        all.light.closest += p.light.closest;
    }
    return all;
}

}  // namespace

Estimator pilot_estimator(const Scene& scene, const CameraDescription& camera, RenderSettings s) {
    s.plan.reset();
    s.exponents.assign(column_count, 1.0);
    s.seed = pilot_seed;
    Estimator e = make_estimator(scene, camera, s);
    e.weighed[emitter_hits] = e.families & Families{true, false, false, false};
    e.weighed[camera_side].light_tracing = e.weighed[camera_side].connection = false;
    e.weighed[without_connections].connection = false;
    return e;
}

std::optional<PilotSums> sample_pilot(const Estimator& e, const Grid& grid,
                                      const Candidates& candidates, int threads,
                                      const RenderControl* control) {
    std::vector<PilotSums> parts = sample_chunks(e, grid, candidates, threads, control);
    if (parts.empty()) return {};
    return added(parts);
}

}  // namespace midway
