// Rendering for a window: jobs go in, snapshots come out, and nobody waits. One coordinator thread
// takes the newest job and renders it with workers at low priority: first an image of few, large
// pixels that is ready within some 20 ms, then finer and finer ones, at last the image itself, pass
// by pass. At scale 1 the passes are those of ProgressiveRenderer, so an image of n passes has the
// bits of `midway render --spp n`. Nothing runs and nothing wakes while a job is finished or
// paused.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "render/live_channels.h"
#include "render/live_images.h"
#include "render/live_strategies.h"
#include "render/render_control.h"
#include "render/renderer.h"

namespace midway {

// What the window sees. Images are never changed once they are here; copying a Snapshot is cheap.
struct Snapshot {
    std::uint64_t job = 0;
    int scale = 1;              // one pixel of the images stands for scale x scale of the job's
    int width = 0, height = 0;  // of the job's whole image
    PixelRect crop;             // of the job
    ImagePlacement placement;   // where the images below lie in the whole image
    std::vector<double> exponents;
    std::optional<Plan> plan;   // of `auto`: what these images were rendered with
    std::string plan_in_words;  // the last that was decided on; of coarse images the one before
    // One of each per exponent, from the same paths. Variances (of the mean, resolve_variance) are
    // null with fewer than two passes.
    std::vector<std::shared_ptr<const Image>> images, variances;
    std::uint64_t passes = 0;             // in these images
    double seconds = 0, cpu_seconds = 0;  // rendering this job, pauses and coarse images excluded
    RenderStatistics statistics;          // of these images
    std::shared_ptr<const StrategySnapshot> strategies;  // null while nobody looks at them
    double samples_per_second = 0;                       // pixel samples, since the snapshot before
    double rays_per_second = 0;
    bool finished = false;  // a limit of the job is reached
    bool paused = false;
    std::string error;  // one line where the job cannot be rendered; there are no images then
};

// How fast the last edits were answered.
struct LiveLatency {
    std::uint64_t job = 0;           // the job whose first image was published last
    double first_image_seconds = 0;  // from its submit() to that image
    double stop_seconds = 0;         // from the last submit() that stopped workers to their rest
};

class LiveRender {
  public:
    // `published` is called after every new snapshot, from the coordinator's thread or the thread
    // that called pause(); it must not block.
    explicit LiveRender(std::function<void()> published = {});
    ~LiveRender();
    LiveRender(const LiveRender&) = delete;
    LiveRender& operator=(const LiveRender&) = delete;

    // Replaces the job that runs; returns the new job's number, counted from 1. A job whose first
    // image is not out and that is younger than 50 ms may finish that image, so that a stream of
    // edits shows something.
    std::uint64_t submit(LiveJob job);

    // The newest; null before the first.
    std::shared_ptr<const Snapshot> snapshot() const;

    // Workers sleep where they are. A job submitted meanwhile is shown up to its first pass of full
    // size, then sleeps.
    void pause(bool paused);

    // Goes on with a finished job until these limits (absent: none); its samples are kept.
    void set_limits(std::optional<std::uint64_t> passes, std::optional<double> seconds);

    // What is gathered of each strategy beside the image, of the current job and of later ones:
    // from the next pass on, without a new start.
    void observe_strategies(const StrategyRequest& request);

    // Albedo, normal, depth and object of the current job and of later ones, while wanted.
    void request_channels(bool wanted);
    std::shared_ptr<const ChannelSnapshot> channels() const;

    // Stops the job and forgets the snapshots: the scene is no longer held.
    void clear();

    LiveLatency latency() const;

  private:
    using Clock = RenderControl::Clock;
    struct Pending {
        std::uint64_t number = 0;
        LiveJob job;
        Clock::time_point submitted;
    };
    struct Running;

    void coordinate();
    void render_job(Running& r);
    bool refine(Running& r);
    bool plan(Running& r);
    void accumulate(Running& r);
    bool render(Running& r, std::uint64_t passes);
    bool take_request(Running& r);
    bool publish(Running& r, bool finished);
    void fail(Running& r, const std::string& error);
    void show(Running& r, std::shared_ptr<const Snapshot> snapshot);
    int first_scale(const LiveJob& job);
    void free_retired();

    // With the mutex held.
    bool superseded() const { return quit_ || cleared_ || pending_; }
    bool reached_limits(const Running& r) const;
    Clock::duration paused_time(Clock::time_point now) const;  // of the job that runs

    std::function<void()> published_;
    RenderControl control_;
    LiveChannels channels_;

    // Of the coordinator alone.
    LiveCost cost_;
    ImagePool pool_;
    int last_first_scale_ = 0;
    // The last plan of `auto`, in words, and the scene that it was made for: coarse images use it.
    std::optional<Plan> plan_;
    std::string plan_in_words_;
    std::weak_ptr<const Scene> plan_of_;
    std::jthread cleaner_;  // gives back what finished jobs held

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    // Under the mutex.
    bool quit_ = false, cleared_ = false, paused_ = false, channels_wanted_ = false;
    bool running_ = false, first_out_ = false;  // a job runs; its first image is published
    Clock::time_point started_;                 // of the job that runs
    std::optional<Clock::time_point> stop_asked_, paused_since_;
    Clock::duration paused_for_{0};
    std::uint64_t last_number_ = 0;
    StrategyRequest strategies_;
    std::uint64_t strategies_number_ = 0;  // of changes
    std::optional<Pending> pending_;
    std::optional<LiveJob> current_;                    // the newest job, with the newest limits
    std::vector<std::shared_ptr<const void>> retired_;  // to be freed where nobody waits
    std::shared_ptr<const Snapshot> snapshot_;
    LiveLatency latency_;

    std::jthread coordinator_;  // last: ends before what it uses
};

}  // namespace midway
