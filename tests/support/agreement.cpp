#include "support/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/coverage.h"

namespace midway::test {
namespace {

double luminance_of(const FixedRgb& sum, int unit) {
    return 0.2126 * from_fixed(sum[0], unit) + 0.7152 * from_fixed(sum[1], unit) +
           0.0722 * from_fixed(sum[2], unit);
}

struct Blocks {
    int size, columns, rows;
    explicit Blocks(const Film& f, int block)
        : size(block),
          columns((f.width() + block - 1) / block),
          rows((f.height() + block - 1) / block) {}
    int of(int x, int y) const { return y / size * columns + x / size; }
    size_t count() const { return size_t(columns) * rows; }
};

// Exact sums so far, of every block; the difference of two is a batch.
std::vector<FixedRgb> block_sums(const Film& f, const Blocks& blocks) {
    std::vector<FixedRgb> sums(blocks.count(), FixedRgb{});
    for (int y = 0; y < f.height(); ++y)
        for (int x = 0; x < f.width(); ++x)
            for (int half = 0; half < 2; ++half) {
                const FixedRgb s = f.sum(half, x, y);
                for (int k = 0; k < 3; ++k) sums[blocks.of(x, y)][k] += s[k];
            }
    return sums;
}

std::vector<double> block_pixels(const Film& f, const Blocks& blocks) {
    std::vector<double> n(blocks.count(), 0);
    for (int y = 0; y < f.height(); ++y)
        for (int x = 0; x < f.width(); ++x) ++n[blocks.of(x, y)];
    return n;
}

void add_batch(const Film& f, const Blocks& blocks, double passes, std::vector<FixedRgb>& before,
               Measured& m) {
    const std::vector<FixedRgb> now = block_sums(f, blocks);
    const std::vector<double> pixels = block_pixels(f, blocks);
    std::vector<double> told(1 + now.size(), 0.0);
    for (size_t i = 0; i < now.size(); ++i) {
        FixedRgb d;
        for (int k = 0; k < 3; ++k) d[k] = now[i][k] - before[i][k];
        const double sum = luminance_of(d, f.unit_exponent());
        told[0] += sum / (double(f.width()) * f.height() * passes);
        told[1 + i] = sum / (pixels[i] * passes);
        m.blocks[i].add(told[1 + i]);
    }
    m.image.add(told[0]);
    m.told.push_back(std::move(told));
    before = now;
}

bool good_enough(const std::vector<Measured>& all, double relative_error) {
    for (const Measured& m : all)
        if (m.image.estimate().standard_error > relative_error * m.image.mean) return false;
    return true;
}

bool strategy_makes(const std::vector<bool>& rough, bool hittable, const Strategy& k) {
    const int n = static_cast<int>(rough.size());  // surfaces, from the camera on
    if (k.t == 0) return hittable;
    if (k.t == 1) return rough[n - 1];
    if (k.s == 1) return rough[0];
    return rough[k.s - 2] && rough[k.s - 1];
}

bool any_makes(const std::vector<bool>& rough, bool hittable, const Families& families) {
    const int vertices = static_cast<int>(rough.size()) + 2;
    for (int s = 1; s <= vertices; ++s) {
        const Strategy k{s, vertices - s};
        if (families.has(family_of(k)) && strategy_makes(rough, hittable, k)) return true;
    }
    return false;
}

}  // namespace

std::vector<Measured> measure(const AgreementScene& scene, const RenderSettings& settings,
                              const Effort& effort) {
    RendererOptions options;
    options.threads = effort.threads;
    ProgressiveRenderer renderer(scene.scene, scene.camera, settings, options);
    const size_t count = settings.exponents.size();
    const Blocks blocks(renderer.film(), effort.block);
    std::vector<Measured> result(count);
    std::vector<std::vector<FixedRgb>> before(count);
    for (size_t i = 0; i < count; ++i) {
        result[i].blocks.resize(blocks.count());
        before[i].assign(blocks.count(), FixedRgb{});
    }
    for (int round = 0; round < effort.rounds; ++round) {
        for (int batch = 0; batch < effort.batches; ++batch) {
            renderer.render_passes(effort.passes);
            for (size_t i = 0; i < count; ++i)
                add_batch(renderer.film(int(i)), blocks, double(effort.passes), before[i],
                          result[i]);
        }
        if (good_enough(result, effort.relative_error)) break;
    }
    return result;
}

std::vector<Measured> measure_seeds(const AgreementScene& scene, RenderSettings settings,
                                    const SeedsEffort& effort) {
    RendererOptions options;
    options.threads = effort.threads;
    std::vector<Measured> result(settings.exponents.size());
    for (int i = 0; i < effort.most_seeds; ++i, ++settings.seed) {
        if (i >= effort.seeds && good_enough(result, effort.relative_error)) break;
        ProgressiveRenderer renderer(scene.scene, scene.camera, settings, options);
        renderer.render_passes(effort.passes);
        const Blocks blocks(renderer.film(), effort.block);
        for (size_t k = 0; k < result.size(); ++k) {
            result[k].blocks.resize(blocks.count());
            std::vector<FixedRgb> nothing(blocks.count(), FixedRgb{});
            add_batch(renderer.film(int(k)), blocks, double(effort.passes), nothing, result[k]);
        }
    }
    return result;
}

std::vector<Strategy> all_but_direct_lamps(int max_bounces) {
    std::vector<Strategy> all;
    for (int edges = 2; edges <= max_bounces + 1; ++edges)
        for (int s = 1; s <= edges + 1; ++s) all.push_back({s, edges + 1 - s});
    return all;
}

bool families_cover(const AgreementScene& scene, const Families& families) {
    const SceneFeatures f = scene_features(*scene.scene);
    for (const bool hittable : {true, false}) {
        if (!(hittable ? f.hittable_lights : f.delta_lights)) continue;
        for (int n = 1; n <= scene.max_bounces; ++n)
            for (int bits = 0; bits < (1 << n); ++bits) {
                std::vector<bool> rough;
                bool exists = true;
                for (int i = 0; i < n; ++i) {
                    rough.push_back((bits >> i) & 1);
                    exists &= rough.back() ? f.rough : f.smooth;
                }
                exists &= rough[0] || scene.sees_smooth;
                if (exists && any_makes(rough, hittable, {}) &&
                    !any_makes(rough, hittable, families))
                    return false;
            }
    }
    return true;
}

double welch_z(const RunningMean& a, const RunningMean& b) {
    const double va = a.variance() / double(a.count), vb = b.variance() / double(b.count);
    const double difference = a.mean - b.mean;
    if (va + vb == 0) return difference == 0 ? 0 : HUGE_VAL;
    const double t2 = difference * difference / (va + vb);
    const double n =
        (va + vb) * (va + vb) / (va * va / double(a.count - 1) + vb * vb / double(b.count - 1));
    return std::copysign((8 * n + 1) / (8 * n + 3) * std::sqrt(n * std::log1p(t2 / n)), difference);
}

Difference difference(const Measured& a, const Measured& b) {
    Difference d;
    d.image_z = welch_z(a.image, b.image);
    for (size_t i = 0; i < a.blocks.size(); ++i) {
        const double z = welch_z(a.blocks[i], b.blocks[i]);
        if (!(std::abs(z) <= std::abs(d.worst_block_z))) {
            d.worst_block_z = z;
            d.worst_block = static_cast<int>(i);
        }
    }
    const double m = b.image.mean;
    if (m != 0) {
        d.relative = a.image.mean / m - 1;
        d.relative_error =
            std::hypot(a.image.estimate().standard_error, b.image.estimate().standard_error) /
            std::abs(m);
    }
    return d;
}

Difference paired_difference(const Measured& a, const Measured& b) {
    const size_t columns = 1 + a.blocks.size();
    std::vector<RunningMean> differences(columns), nothing(columns);
    for (size_t row = 0; row < std::min(a.told.size(), b.told.size()); ++row)
        for (size_t i = 0; i < columns; ++i) {
            differences[i].add(a.told[row][i] - b.told[row][i]);
            nothing[i].add(0);
        }
    Difference d = difference({differences[0], {differences.begin() + 1, differences.end()}, {}},
                              {nothing[0], {nothing.begin() + 1, nothing.end()}, {}});
    if (b.image.mean != 0) {
        d.relative = differences[0].mean / b.image.mean;
        d.relative_error = differences[0].estimate().standard_error / std::abs(b.image.mean);
    }
    return d;
}

bool Verdict::agrees() const {
    return std::abs(difference.image_z) < 3.5 && std::abs(difference.worst_block_z) < block_limit;
}

std::string Verdict::text() const {
    return fmt::format(
        "mean {:+.3f} % +- {:.3f} % (z {:+.2f}), worst block {} (z {:+.2f}, limit {:.2f})",
        100 * difference.relative, 100 * difference.relative_error, difference.image_z,
        difference.worst_block, difference.worst_block_z, block_limit);
}

Verdict judge(const Measured& a, const Measured& b, int comparisons) {
    const double level =
        sidak_level(1e-4, std::int64_t(comparisons) * std::int64_t(a.blocks.size()));
    return {difference(a, b), -normal_quantile(level / 2)};
}

std::string disagreement(const AgreementScene& scene, RenderSettings a, RenderSettings b,
                         Effort effort, int comparisons) {
    b.seed += 500;
    for (const bool again : {false, true}) {
        const Measured x = measure(scene, a, effort).front(), y = measure(scene, b, effort).front();
        const Verdict v = judge(x, y, comparisons);
        if (!(x.image.mean > 0) || !(y.image.mean > 0)) return scene.name + " is black";
        if (v.agrees()) return {};
        if (again) return scene.name + ": " + v.text();
        a.seed += 1000;
        b.seed += 1000;
        effort.passes *= 4;
    }
    return {};
}

}  // namespace midway::test
