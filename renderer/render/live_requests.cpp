// What others ask of a LiveRender, from any thread: noted under the mutex, taken up by the
// coordinator (live_render.cpp).
#include <utility>

#include "render/live_pace.h"
#include "render/live_render.h"

namespace midway {

std::uint64_t LiveRender::submit(LiveJob job) {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    const bool stopping = !running_ || superseded();
    if (!stopping && !first_out_ && now < started_ + protected_age) {
        control_.cancel_at(started_ + protected_age);
    } else if (!stopping || first_out_) {
        if (running_ && !stop_asked_) stop_asked_ = now;
        control_.cancel();
    }
    const std::uint64_t number = ++last_number_;
    // The last holder of a scene pays for freeing it: not this thread.
    if (pending_) retired_.push_back(std::move(pending_->job.scene));
    if (current_) retired_.push_back(std::move(current_->scene));
    current_ = job;
    if (channels_wanted_) channels_.submit(number, job);
    pending_ = Pending{number, std::move(job), now};
    changed_.notify_all();
    return number;
}

std::shared_ptr<const Snapshot> LiveRender::snapshot() const {
    const std::lock_guard lock(mutex_);
    return snapshot_;
}

void LiveRender::pause(bool paused) {
    {
        const std::lock_guard lock(mutex_);
        if (paused == paused_) return;
        paused_ = paused;
        // What is being stopped must not be woken to go on.
        if (running_ && !superseded()) {
            paused_for_ = paused_time(Clock::now());
            paused_since_.reset();
            if (paused) paused_since_ = Clock::now();
            paused ? control_.pause() : control_.run();
        }
        if (snapshot_) {
            auto copy = std::make_shared<Snapshot>(*snapshot_);
            copy->paused = paused;
            snapshot_ = std::move(copy);
        }
        changed_.notify_all();
    }
    if (published_) published_();
}

void LiveRender::set_limits(std::optional<std::uint64_t> passes, std::optional<double> seconds) {
    const std::lock_guard lock(mutex_);
    if (!current_) return;
    current_->stop_passes = passes;
    current_->stop_seconds = seconds;
    if (pending_) {
        pending_->job.stop_passes = passes;
        pending_->job.stop_seconds = seconds;
    }
    changed_.notify_all();
}

void LiveRender::observe_strategies(const StrategyRequest& request) {
    const std::lock_guard lock(mutex_);
    if (request == strategies_) return;
    strategies_ = request;
    ++strategies_number_;
    control_.end_batch();
    changed_.notify_all();
}

void LiveRender::request_channels(bool wanted) {
    const std::lock_guard lock(mutex_);
    if (wanted == channels_wanted_) return;
    channels_wanted_ = wanted;
    if (!wanted)
        channels_.stop();
    else if (current_)
        channels_.submit(last_number_, *current_);
}

std::shared_ptr<const ChannelSnapshot> LiveRender::channels() const { return channels_.snapshot(); }

void LiveRender::clear() {
    const std::lock_guard lock(mutex_);
    cleared_ = running_;
    control_.cancel();
    channels_.clear();
    if (pending_) retired_.push_back(std::move(pending_->job.scene));
    if (current_) retired_.push_back(std::move(current_->scene));
    pending_.reset();
    current_.reset();
    snapshot_.reset();
    changed_.notify_all();
}

LiveLatency LiveRender::latency() const {
    const std::lock_guard lock(mutex_);
    return latency_;
}

}  // namespace midway
