#include "render/pilot_sums.h"

#include <atomic>
#include <cmath>
#include <thread>

#include "math/float_mode.h"

namespace midway {
namespace {

// What one thread does at a time.
constexpr int chunks = 16, rows_per_chunk = pilot_rows / chunks;
constexpr std::uint64_t pilot_seed = 0x70696c6f74;

// The weights of the pilot's samples: exponent 1 four times, over these families.
enum Column { all, emitter_hits, camera_side, without_connections, column_count };

// Sums over strategies j of n_j p_j / (n_k p_k), by family, from the weights of strategy k.
using Densities = std::array<double, 4>;

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

// What a plan has of the pilot's samples, of one family.
double sample_share(const Plan& p, Family family, bool direct_light, int direct_samples) {
    if (!p.families.has(family)) return 0;
    if (family == Family::light_tracing) return light_share(p);
    if (family == Family::connection) return connection_share(p);
    const bool split = family == Family::next_event && direct_light;
    return split ? double(p.direct_samples) / direct_samples : 1;
}

using SampleShares = std::array<ByPlan, 4>;  // by family
SampleShares sample_shares(const Candidates& c, bool direct_light) {
    SampleShares shares{};
    const int direct_samples = c.plans[c.sampled()].direct_samples;
    for (size_t i = 0; i < c.plans.size(); ++i)
        for (size_t f = 0; f < shares.size(); ++f)
            shares[f][i] = sample_share(c.plans[i], Family(f), direct_light, direct_samples);
    return shares;
}

using Gathered = std::array<Moments, 2>;

class PilotRecord {
  public:
    PilotRecord(const Grid& grid, const Candidates& candidates, std::vector<BlockSums>& blocks)
        : grid_(grid),
          direct_(sample_shares(candidates, true)),
          indirect_(sample_shares(candidates, false)),
          full_(size_t(candidates.full())),
          blocks_(blocks) {}

    void begin(int x, int y) {
        block_ = grid_.block(x, y);
        gathered_ = {};
    }
    // The sample's weighted luminances, as PixelVariances.
    const Gathered& gathered() const { return gathered_; }

    bool wants(const Strategy&) const { return true; }
    void contribution(const Contribution& c) {
        const Energies found = add(blocks_[block_], c);
        const int g = group_of(family_of(c.strategy), c.strategy.edges());
        if (c.sample == 0) gathered_[0][g] += found.full;
        gathered_[1][g] += found.sampled;
    }
    void splat(int x, int y, const Contribution& c) { add(blocks_[grid_.block(x, y)], c); }

  private:
    // Weighted luminances: as the pilot has it, and as the full plan would without second samples.
    struct Energies {
        double sampled = 0, full = 0;
    };

    Energies add(BlockSums& b, const Contribution& c) const {
        const double value = luminance(c.value), weight = c.weights[all];
        if (!(value > 0) || !(weight > 0) || !std::isfinite(value)) return {};
        const Densities d = densities(c);
        const SampleShares& shares = c.strategy.edges() == 2 ? direct_ : indirect_;
        const double energy = weight * value;
        ByPlan scale;
        for (size_t i = 0; i < scale.size(); ++i)
            scale[i] = 1 / (d[0] * shares[0][i] + d[1] * shares[1][i] + d[2] * shares[2][i] +
                            d[3] * shares[3][i]);
        ByPlan squares{};
        for (size_t f = 0; f < d.size(); ++f) {
            if (!(d[f] > 0)) continue;
            const int g = group_of(Family(f), c.strategy.edges());
            // Other families would have found the path without choosing among many.
            const double bare = Family(f) == Family::connection ? value : value * c.probability;
            for (size_t i = 0; i < scale.size(); ++i) {
                const double found = energy * d[f] * shares[f][i] * scale[i];
                const double square = found * bare * scale[i];
                b.first[g][i] += found;
                b.second[g][i] += square;
                squares[i] += square;
            }
        }
        for (size_t i = 0; i < scale.size(); ++i) b.largest[i] = std::max(b.largest[i], squares[i]);
        b.image += energy;
        return {energy, value * scale[full_]};
    }

    const Grid& grid_;
    const SampleShares direct_, indirect_;
    const size_t full_;
    std::vector<BlockSums>& blocks_;
    int block_ = 0;
    Gathered gathered_{};
};

template <size_t n>
void add_to(std::array<double, n>& to, const std::array<double, n>& from) {
    for (size_t i = 0; i < n; ++i) to[i] += from[i];
}

// From sums over the even and the odd passes.
GatheredVariances variances(const Moments& even, const Moments& odd) {
    // The means of two halves differ by four times the variance of the mean of all.
    const auto of = [](double difference) { return sqr(difference) / pilot_passes; };
    GatheredVariances v;
    double all = 0;
    for (int g = 0; g < groups; ++g) {
        const double difference = even[g] - odd[g];
        all += difference;
        v.groups[g] = of(difference);
    }
    v.all = of(all);
    return v;
}

// A place of the samples: a pixel, and passes of its own. (A small crop has the same pixel in many
// strata.)
struct PilotPixel {
    int x = 0, y = 0;
    std::uint64_t first_pass = 0;
};
PilotPixel pilot_pixel(const PixelRect& crop, int column, int row) {
    const std::uint64_t stratum = std::uint64_t(row) * pilot_columns + column;
    const std::uint64_t jitter = hash_combine(pilot_seed, stratum);
    const auto place = [](int i, std::uint32_t random, int strata, int size) {
        const double u = (i + random * 0x1p-32) / strata;
        return std::min(static_cast<int>(u * size), size - 1);
    };
    return {crop.x0 + place(column, std::uint32_t(jitter), pilot_columns, crop.width()),
            crop.y0 + place(row, std::uint32_t(jitter >> 32), pilot_rows, crop.height()),
            pilot_passes * stratum};
}

// Eight pixels share their light subpaths, as neighbours do in a render: a pixel meets new ones in
// each of its passes.
void sample_pixels(const Estimator& e, const Grid& grid, int column, int row, PilotRecord& record,
                   LightSubpaths& light, PilotSums& result) {
    std::array<PilotPixel, group_pixels> pixels;
    for (int k = 0; k < group_pixels; ++k) pixels[k] = pilot_pixel(e.crop, column + k, row);
    std::array<std::array<Gathered, 2>, group_pixels> halves{};
    for (int i = 0; i < pilot_passes; ++i) {
        light.begin(group_pixels);
        for (int k = 0; k < group_pixels && e.families.needs_light_subpaths(); ++k) {
            const auto [x, y, first] = pixels[k];
            trace_light_subpaths(e, paired_subpath(e, x, y, first + i), first + i, k, light, record,
                                 result.light);
        }
        for (int k = 0; k < group_pixels; ++k) {
            const auto [x, y, first] = pixels[k];
            record.begin(x, y);
            trace_camera_subpath(e, x, y, first + i, k, light, record, result.camera);
            for (int split = 0; split < 2; ++split)
                add_to(halves[k][i % 2][split], record.gathered()[split]);
        }
    }
    for (int k = 0; k < group_pixels; ++k) {
        PixelVariances& found = result.pixels.emplace_back();
        found.block = grid.block(pixels[k].x, pixels[k].y);
        for (int split = 0; split < 2; ++split)
            found.of[split] = variances(halves[k][0][split], halves[k][1][split]);
    }
}

PilotSums sample_chunk(const Estimator& e, const Grid& grid, const Candidates& candidates,
                       int chunk, const RenderControl* control) {
    PilotSums result;
    result.blocks.resize(size_t(grid.x) * grid.y);
    result.shadow_rays.resize(strategy_count(e.max_bounces + 1) + 1);
    result.camera.by_strategy = result.light.by_strategy = &result.shadow_rays;
    PilotRecord record(grid, candidates, result.blocks);
    LightSubpaths light;
    for (int row = chunk * rows_per_chunk; row < (chunk + 1) * rows_per_chunk; ++row)
        for (int column = 0; column < pilot_columns; column += group_pixels) {
            if (control && !control->go_on()) return {};
            sample_pixels(e, grid, column, row, record, light, result);
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
        if (r.pixels.empty()) return {};
    return results;
}

PilotSums added(std::vector<PilotSums>& parts) {
    PilotSums all = std::move(parts.front());
    for (size_t i = 1; i < parts.size(); ++i) {
        const PilotSums& p = parts[i];
        for (size_t b = 0; b < all.blocks.size(); ++b) {
            all.blocks[b].image += p.blocks[b].image;
            for (size_t i = 0; i < all.blocks[b].largest.size(); ++i)
                all.blocks[b].largest[i] =
                    std::max(all.blocks[b].largest[i], p.blocks[b].largest[i]);
            for (int g = 0; g < groups; ++g) {
                add_to(all.blocks[b].first[g], p.blocks[b].first[g]);
                add_to(all.blocks[b].second[g], p.blocks[b].second[g]);
            }
        }
        all.pixels.insert(all.pixels.end(), p.pixels.begin(), p.pixels.end());
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
    e.direct_samples = 2;
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
