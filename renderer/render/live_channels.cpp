#include "render/live_channels.h"

#include <exception>

#include "render/live_pace.h"

namespace midway {
namespace {

constexpr int final_samples = 16;

}  // namespace

LiveChannels::LiveChannels(std::function<void()> published)
    : published_(std::move(published)), coordinator_([this] { coordinate(); }) {}

LiveChannels::~LiveChannels() {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    control_.cancel();
    changed_.notify_all();
}

void LiveChannels::submit(std::uint64_t number, const LiveJob& job) {
    const std::lock_guard lock(mutex_);
    const bool may_finish = running_ && !first_out_ && !pending_ && !stopped_ &&
                            Clock::now() - started_ < protected_age;
    if (may_finish)
        control_.cancel_at(started_ + protected_age);
    else if (!pending_ || first_out_)
        control_.cancel();
    pending_ = Pending{number, job};
    changed_.notify_all();
}

void LiveChannels::stop() {
    const std::lock_guard lock(mutex_);
    pending_.reset();
    stopped_ = true;
    control_.cancel();
}

void LiveChannels::clear() {
    stop();
    const std::lock_guard lock(mutex_);
    snapshot_.reset();
}

std::shared_ptr<const ChannelSnapshot> LiveChannels::snapshot() const {
    const std::lock_guard lock(mutex_);
    return snapshot_;
}

void LiveChannels::coordinate() {
    for (;;) {
        Pending pending;
        {
            std::unique_lock lock(mutex_);
            running_ = false;
            changed_.wait(lock, [&] { return quit_ || pending_; });
            if (quit_) return;
            pending = std::move(*pending_);
            pending_.reset();
            running_ = true;
            first_out_ = stopped_ = false;
            started_ = Clock::now();
            control_.run();
        }
        try {
            render_job(pending);
        } catch (const std::exception&) {
            // The image's own thread meets the same error and says it.
        }
    }
}

void LiveChannels::render_job(const Pending& pending) {
    const LiveJob& job = pending.job;
    const int threads = thread_count(job);
    make_estimator(*job.scene, job.camera, job.settings);  // throws where the job makes no sense
    int scale = cost_.fitting_scale(job, threads, first_image_budget);
    while (render(pending, scale, 1) && scale > 1)
        scale = std::min((scale + 1) / 2, cost_.fitting_scale(job, threads, first_image_budget));
    if (scale == 1) render(pending, 1, final_samples);
}

bool LiveChannels::render(const Pending& pending, int scale, int samples) {
    const LiveJob& job = pending.job;
    const ScaledView view = scaled_view(job, scale);
    const Estimator estimator = make_estimator(*job.scene, view.camera, view.settings);
    const auto began = Clock::now();
    std::optional<AovImages> images = render_aovs(estimator, samples, thread_count(job), control_);
    if (!images) return false;
    const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
    cost_.learn(job.settings.technique, seconds * thread_count(job),
                double(estimator.crop.area()) * samples);
    auto snapshot = std::make_shared<ChannelSnapshot>(
        ChannelSnapshot{pending.number, scale, samples, view.placement, std::move(*images)});
    bool go_on = true;
    {
        const std::lock_guard lock(mutex_);
        if (stopped_) return false;
        snapshot_ = std::move(snapshot);
        first_out_ = true;
        go_on = !pending_;
    }
    if (published_) published_();
    return go_on;
}

}  // namespace midway
