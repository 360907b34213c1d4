// Albedo, normal, depth and object for a window, beside the image and never in its way: a thread of
// its own that sleeps until a job comes, shows a coarse version within some 20 ms, then full size,
// then the 16 samples that `midway render --aov` takes.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "render/aov.h"
#include "render/live_job.h"
#include "render/render_control.h"

namespace midway {

struct ChannelSnapshot {
    std::uint64_t job = 0;
    int scale = 1;
    int samples = 0;  // per pixel
    ImagePlacement placement;
    AovImages images;
};

class LiveChannels {
  public:
    explicit LiveChannels(std::function<void()> published);
    ~LiveChannels();
    LiveChannels(const LiveChannels&) = delete;
    LiveChannels& operator=(const LiveChannels&) = delete;

    // Replaces the job that runs; none of these functions waits.
    void submit(std::uint64_t number, const LiveJob& job);
    void stop();   // keeps what is shown
    void clear();  // stops and forgets
    std::shared_ptr<const ChannelSnapshot> snapshot() const;

  private:
    using Clock = RenderControl::Clock;
    struct Pending {
        std::uint64_t number = 0;
        LiveJob job;
    };

    void coordinate();
    void render_job(const Pending& pending);
    bool render(const Pending& pending, int scale, int samples);

    std::function<void()> published_;
    RenderControl control_;
    LiveCost cost_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    // Under the mutex.
    bool quit_ = false, running_ = false, stopped_ = false, first_out_ = false;
    Clock::time_point started_;
    std::optional<Pending> pending_;
    std::shared_ptr<const ChannelSnapshot> snapshot_;

    std::jthread coordinator_;  // last: ends before what it uses
};

}  // namespace midway
