// The progressive renderer: runs whole passes (one sample of every pixel of the crop) on all
// threads. Which thread computes what never shows in the result.
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "integrator/facts.h"
#include "render/film_record.h"
#include "render/render_control.h"
#include "render/settings.h"

namespace midway {

struct RendererOptions {
    int threads = 0;                     // 0: all processors
    int layer_edges = 0;                 // > 0: strategy layers for paths of up to so many edges
    bool statistics = false;             // per strategy, unless observe() decides
    std::uint64_t first_pass = 0;        // of a shard: the samples before belong to others
    bool background = false;             // workers leave the processor to others who want it
    bool general = false;                // by the code that holds for every pass (facts.h)
    std::atomic<Work>* watch = nullptr;  // what the worker is at; for one thread
};

struct StrategyStatistics {
    Strategy strategy;
    std::uint64_t samples = 0, rays = 0;
    double energy = 0, second_moment = 0;  // means per pixel and pass
};

struct RenderStatistics {
    RayCounts rays;
    FixedCounts fixed;
    NonFinite nonfinite;
    std::uint64_t clamped = 0;
    std::vector<StrategyStatistics> strategies;  // those with rays or samples
};

class ProgressiveRenderer {
  public:
    // Keeps the scene alive.
    ProgressiveRenderer(std::shared_ptr<const Scene> scene, const CameraDescription& camera,
                        const RenderSettings& settings, const RendererOptions& options);

    // Renders the next `count` passes and returns when all are in the film; fewer, but one at
    // least, where `control` ends the batch. `tick` is called about ten times a second by the
    // calling thread with the share that is done. False where `control` cancelled them: the film
    // then holds parts of passes, and only statistics() and cpu_seconds() mean something.
    bool render_passes(std::uint64_t count, const std::function<void(double)>& tick = {},
                       const RenderControl* control = nullptr);

    // Begins, changes or ends what is gathered for the strategy pyramid, from the next pass on;
    // the image does not change by it. Statistics per strategy begin anew whenever its cells do,
    // and end with them.
    void observe(const StrategyRequest& request);
    const StrategyCells* cells() const { return cells_.get(); }  // null: not observed
    // In the order of the cells; means per pixel and pass since they were begun.
    std::vector<StrategyStatistics> cell_statistics() const;
    std::uint64_t cells_lost() const { return totals_.cells_lost; }

    // Goes on from films of this very render (same scene and settings) that hold `passes` passes.
    void adopt(std::vector<Film> films, std::uint64_t passes);

    std::uint64_t passes() const { return passes_; }
    std::uint64_t first_pass() const { return first_pass_; }
    int threads() const { return threads_; }
    const Estimator& estimator() const { return estimator_; }
    // What the code of its passes makes use of.
    Facts facts() const { return general_ ? no_facts : facts_of(estimator_); }
    const Film& film(int exponent = 0) const { return films_[exponent]; }
    Image image(int exponent = 0) const;
    Image variance(int exponent = 0) const;
    RenderStatistics statistics() const;
    double cpu_seconds() const { return cpu_seconds_; }  // of all workers

    struct Layer {
        Strategy strategy;
        const StrategyFilms* films;
    };
    std::vector<Layer> layers() const;
    PassCounts counts() const { return pass_counts(first_pass_, first_pass_ + passes_); }

  private:
    struct Batch;
    template <Facts F, bool observed>
    bool work(Batch& batch, WorkerSums& sums) const;
    void merge(const WorkerSums& sums);
    void begin_statistics(bool on, size_t strategies);
    StrategyStatistics statistics_of(const Strategy& k, size_t slot) const;

    std::shared_ptr<const Scene> scene_;
    Estimator estimator_;
    int threads_ = 1;
    std::uint64_t first_pass_ = 0, passes_ = 0, statistics_since_ = 0;
    std::vector<Film> films_;
    std::unique_ptr<StrategyCells> cells_;
    std::vector<std::unique_ptr<StrategyFilms>> layers_;
    FilmTargets targets_;
    WorkerSums totals_;
    bool background_ = false;
    bool general_ = false;
    double cpu_seconds_ = 0;
};

}  // namespace midway
