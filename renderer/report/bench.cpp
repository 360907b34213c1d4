#include "report/bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "math/float_mode.h"

namespace midway {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_of(const std::function<void()>& work) {
    const auto start = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Runs work(0) to work(count - 1) at once.
void side_by_side(int count, const std::function<void(int)>& work) {
    std::vector<std::jthread> threads;
    for (int i = 0; i < count; ++i) threads.emplace_back([&work, i] { work(i); });
}

// What every measurement needs.
struct Bench {
    std::shared_ptr<const Scene> scene;
    const CameraDescription& camera;
    const RenderSettings& settings;
    const BenchOptions& options;
    int threads;

    std::unique_ptr<ProgressiveRenderer> renderer(int with_threads,
                                                  std::atomic<Work>* watch = nullptr) const {
        return std::make_unique<ProgressiveRenderer>(
            scene, camera, settings, RendererOptions{.threads = with_threads, .watch = watch});
    }
    // One for each thread.
    std::vector<std::unique_ptr<ProgressiveRenderer>> renderers_apart() const {
        std::vector<std::unique_ptr<ProgressiveRenderer>> all;
        for (int i = 0; i < threads; ++i) all.push_back(renderer(1));
        return all;
    }
};

// Pass i by thread i.
std::vector<RayLog> record_rays(const Bench& b) {
    std::vector<RayLog> logs(static_cast<size_t>(b.threads));
    side_by_side(b.threads, [&](int i) {
        RayLog& log = logs[static_cast<size_t>(i)];
        log.limit = b.options.log_bytes / sizeof(RayLog::Entry) / logs.size();
        const auto scene = std::make_shared<Scene>(*b.scene);
        scene->accel = std::make_shared<Accel>(*b.scene->accel, log);
        RendererOptions one{.threads = 1, .first_pass = std::uint64_t(i)};
        ProgressiveRenderer(scene, b.camera, b.settings, one).render_passes(1);
    });
    return logs;
}

double replay_seconds(const Bench& b, const std::vector<RayLog>& logs) {
    std::atomic<std::uint64_t> met{0};  // so that nothing is optimised away
    return seconds_of([&] {
        side_by_side(b.threads, [&](int i) {
            const ScopedFlushToZero flush;
            met += b.scene->accel->replay(logs[static_cast<size_t>(i)], {b.scene.get()});
        });
    });
}

// Each in a line of the cache of its own: what a worker is at would cost all others time.
struct alignas(64) Watched {
    std::atomic<Work> work{Work::other};
};

// How often each kind of work was met by looking at every thread now and then.
std::array<double, work_kinds> watch_work(const Bench& b) {
    std::vector<Watched> at(static_cast<size_t>(b.threads));
    std::atomic<bool> over{false};
    std::atomic<int> started{0};
    std::vector<std::jthread> workers;
    for (Watched& now : at)
        workers.emplace_back([&] {
            const auto r = b.renderer(1, &now.work);
            r->render_passes(1);
            ++started;
            while (!over) r->render_passes(1);
        });
    while (started < b.threads) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::array<double, work_kinds> counts{};
    double all = 0;
    const auto end = Clock::now() + std::chrono::duration<double>(b.options.watch_seconds);
    while (Clock::now() < end) {
        // Not in step with anything that a worker repeats.
        std::this_thread::sleep_for(std::chrono::microseconds(311));
        for (const Watched& now : at) ++counts[static_cast<size_t>(now.work.load())];
        all += double(at.size());
    }
    over = true;
    for (double& c : counts) c /= std::max(1.0, all);
    return counts;
}

std::vector<BenchResult::Scaling> measure_scaling(const Bench& b, std::uint64_t passes) {
    std::vector<BenchResult::Scaling> scaling;
    for (int n = 1;; n = std::min(2 * n, b.threads)) {
        const auto r = b.renderer(n);
        r->render_passes(1);
        const double t = seconds_of([&] { r->render_passes(passes); });
        scaling.push_back({n, double(passes) * double(r->estimator().crop.area()) / t});
        if (n == b.threads) return scaling;
    }
}

// Passes that take as long as asked for, a multiple of the threads.
std::uint64_t passes_per_round(const Bench& b, ProgressiveRenderer& r) {
    r.render_passes(1);  // the first one touches new memory
    const double t = seconds_of([&] { r.render_passes(std::uint64_t(b.threads)); });
    return std::uint64_t(b.threads) *
           std::uint64_t(std::clamp(std::ceil(b.options.seconds / t), 1.0, 1e6));
}

RayCounts mean_counts(const ProgressiveRenderer& r) {
    const RayCounts sum = r.statistics().rays;
    const std::uint64_t n = r.passes();
    RayCounts mean;
    mean.closest = sum.closest / n;
    mean.shadow = sum.shadow / n;
    mean.camera_paths = sum.camera_paths / n;
    mean.light_paths = sum.light_paths / n;
    return mean;
}

}  // namespace

Middle middle_of(std::vector<double> v) {
    if (v.empty()) return {};
    std::sort(v.begin(), v.end());
    const double n = double(v.size());
    // Ranks of the median's interval: the binomial distribution by its normal approximation.
    const double rank = std::floor(0.5 * (n - 1.96 * std::sqrt(n)));
    const size_t low = rank > 0 ? static_cast<size_t>(rank) : 0;
    const size_t half = v.size() / 2;
    const double median = v.size() % 2 ? v[half] : 0.5 * (v[half - 1] + v[half]);
    return {median, v[low], v[v.size() - 1 - low]};
}

BenchResult run_bench(const std::shared_ptr<const Scene>& scene, const CameraDescription& camera,
                      const RenderSettings& settings, const BenchOptions& options,
                      const std::function<void(const char*, double)>& progress) {
    Bench b{scene, camera, settings, options, options.threads};
    const auto together = b.renderer(options.threads);
    b.threads = together->threads();
    const auto tell = [&](const char* what, double done) {
        if (progress) progress(what, done);
    };
    tell("rays are recorded", 0);
    const std::vector<RayLog> logs = record_rays(b);
    double kept = 0, traced = 0;
    for (const RayLog& log : logs) {
        kept += double(log.rays.size());
        traced += double(log.rays.size()) + double(log.missed);
    }
    const auto apart = b.renderers_apart();
    BenchResult result;
    result.threads = b.threads;
    result.whole_log = kept == traced;
    const std::uint64_t passes = result.passes = passes_per_round(b, *together);
    const std::uint64_t share = passes / std::uint64_t(b.threads);
    const auto render_apart = [&] {
        side_by_side(b.threads, [&](int i) { apart[size_t(i)]->render_passes(share); });
    };
    render_apart();
    std::vector<double> per_pass, limit, sharing, replay;
    for (int round = 0; round < options.rounds; ++round) {
        tell("rounds", double(round) / options.rounds);
        const double rendered = seconds_of([&] { together->render_passes(passes); });
        // A log is a pass of one thread; of a log that is not whole, the part counts.
        const double replayed = replay_seconds(b, logs) * (traced / std::max(1.0, kept));
        const double alone = seconds_of(render_apart);
        per_pass.push_back(rendered / double(passes));
        limit.push_back(replayed * double(share) / rendered);
        sharing.push_back(rendered / alone);
        replay.push_back(replayed);
    }
    result.seconds_per_pass = middle_of(per_pass);
    result.limit_ratio = middle_of(limit);
    result.sharing = middle_of(sharing);
    result.per_pass = mean_counts(*together);
    const double t = result.seconds_per_pass.median;
    result.samples_per_second = double(together->estimator().crop.area()) / t;
    result.rays_per_second = double(result.per_pass.closest + result.per_pass.shadow) / t;
    result.replayed_per_second = traced / middle_of(replay).median;
    tell("work is watched", 0);
    result.shares = watch_work(b);
    tell("threads are counted", 0);
    result.scaling = measure_scaling(b, passes);
    return result;
}

}  // namespace midway
