#include "render/live_render.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "render/live_pace.h"
#include "render/pilot.h"

namespace midway {
namespace {

double seconds_between(RenderControl::Clock::time_point a, RenderControl::Clock::time_point b) {
    return std::chrono::duration<double>(b - a).count();
}

}  // namespace

struct LiveRender::Running {
    Pending pending;
    int threads = 1;
    int scale = 1;
    ScaledView view;
    std::shared_ptr<ProgressiveRenderer> renderer;
    double seconds = 0;  // with this renderer
    // At the snapshot before, with the same renderer.
    std::uint64_t shown_passes = 0, shown_rays = 0;
    double shown_seconds = 0;
    Clock::time_point shown;
    double resolving = 0;  // seconds that it took
    // Of the strategy pyramid: what the renderer observes, and the number of that request.
    StrategyRequest request;
    std::uint64_t request_number = 0;
};

LiveRender::LiveRender(std::function<void()> published)
    : published_(std::move(published)),
      channels_(published_),
      coordinator_([this] { coordinate(); }) {}

LiveRender::~LiveRender() {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    control_.cancel();
    changed_.notify_all();
}

RenderControl::Clock::duration LiveRender::paused_time(Clock::time_point now) const {
    return paused_for_ + (paused_since_ ? now - *paused_since_ : Clock::duration{0});
}

void LiveRender::coordinate() {
    for (;;) {
        Running r;
        {
            std::unique_lock lock(mutex_);
            running_ = false;
            if (!pending_ && !quit_) {
                lock.unlock();
                free_retired();
                lock.lock();
            }
            changed_.wait(lock, [&] { return quit_ || pending_; });
            if (quit_) return;
            r.pending = std::move(*pending_);
            pending_.reset();
            running_ = true;
            first_out_ = cleared_ = false;
            started_ = r.shown = Clock::now();
            stop_asked_.reset();
            paused_since_.reset();
            paused_for_ = {};
            for (auto& image : pool_.unused()) retired_.push_back(std::move(image));
            control_.run();
        }
        render_job(r);
        const std::lock_guard lock(mutex_);
        if (stop_asked_) latency_.stop_seconds = seconds_between(*stop_asked_, Clock::now());
        retired_.push_back(std::move(r.renderer));
        retired_.push_back(std::move(r.pending.job.scene));
    }
}

void LiveRender::render_job(Running& r) {
    const LiveJob& job = r.pending.job;
    try {
        r.threads = thread_count(job);
        make_estimator(*job.scene, job.camera, job.settings);  // throws what is wrong with the job
        if (refine(r)) accumulate(r);
    } catch (const std::bad_alloc&) {
        fail(r, "not enough memory (image); choose a smaller one");
    } catch (const std::exception& e) {
        fail(r, e.what());
    }
}

void LiveRender::fail(Running& r, const std::string& error) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->job = r.pending.number;
    snapshot->finished = true;
    snapshot->error = error;
    show(r, std::move(snapshot));
}

// What `auto` renders with. Coarse images make do with the plan of the image before, so that a drag
// does not wait; the image itself has the plan that `midway render` would decide on. False where
// the job was replaced.
bool LiveRender::plan(Running& r) {
    LiveJob& job = r.pending.job;
    if (job.settings.technique != Technique::automatic) return true;
    job.settings.plan.reset();
    if (r.scale > 1) {
        if (plan_of_.lock() == job.scene) job.settings.plan = plan_;
        return true;
    }
    const std::optional<PlanDecision> decision =
        decide_plan(*job.scene, job.camera, job.settings, r.threads, &control_);
    if (!decision) return false;
    job.settings.plan = plan_ = decision->plan;
    plan_in_words_ = describe(*decision);
    plan_of_ = job.scene;
    return true;
}

// Shows coarse images down to the first pass of full size. False where the job was replaced.
bool LiveRender::refine(Running& r) {
    const LiveJob& job = r.pending.job;
    r.scale = last_first_scale_ = first_scale(job);
    // Something is seen while the pilot runs.
    if (job.settings.technique == Technique::automatic) r.scale = std::max(r.scale, 2);
    for (;;) {
        {
            const std::lock_guard lock(mutex_);
            if (superseded() && first_out_) return false;
            retired_.push_back(std::move(r.renderer));
        }
        if (!plan(r)) return false;
        r.view = scaled_view(job, r.scale);
        RendererOptions options;
        options.threads = r.threads;
        options.statistics = job.statistics;
        options.background = true;
        r.renderer = std::make_shared<ProgressiveRenderer>(job.scene, r.view.camera,
                                                           r.view.settings, options);
        r.seconds = r.shown_seconds = 0;
        r.shown_passes = r.shown_rays = r.request_number = 0;
        take_request(r);
        if (!render(r, 1)) return false;
        if (r.scale == 1) return true;
        if (!publish(r, false)) return false;
        free_retired();
        r.scale =
            std::min((r.scale + 1) / 2, cost_.fitting_scale(job, r.threads, first_image_budget));
    }
}

// The coarsest image of a job, at the scale of the job before where that still does: a drag must
// not flicker between scales.
int LiveRender::first_scale(const LiveJob& job) {
    const int threads = thread_count(job);
    const int fitting = cost_.fitting_scale(job, threads, first_image_budget);
    if (last_first_scale_ == 0) return fitting;
    const double expected = cost_.expected_seconds(job, threads, last_first_scale_);
    const bool still_does = expected < 1.3 * first_image_budget &&
                            last_first_scale_ < 2 * fitting && expected > 0.5 * first_image_budget;
    return still_does ? last_first_scale_ : fitting;
}

// Observes what is asked for now; true where that is new.
bool LiveRender::take_request(Running& r) {
    {
        const std::lock_guard lock(mutex_);
        if (r.request_number == strategies_number_) return false;
        r.request_number = strategies_number_;
        r.request = strategies_;
        control_.begin_batches();
    }
    r.renderer->observe(r.request);
    return true;
}

bool LiveRender::reached_limits(const Running& r) const {
    if (!current_) return true;
    return (current_->stop_passes && r.renderer->passes() >= *current_->stop_passes) ||
           (current_->stop_seconds && r.seconds >= *current_->stop_seconds);
}

// Adds passes of full size until the job is replaced; sleeps where it is finished or paused.
void LiveRender::accumulate(Running& r) {
    bool shown_finished = false;
    bool soon = false;  // the first pass with what was asked for is shown at once
    for (;;) {
        const bool asked = take_request(r);
        soon |= asked;
        bool finished = false, rest = false;
        std::optional<std::uint64_t> stop_passes;
        std::optional<double> stop_seconds;
        {
            const std::lock_guard lock(mutex_);
            if (superseded()) return;
            finished = reached_limits(r);
            rest = finished || paused_;
            stop_passes = current_->stop_passes;
            stop_seconds = current_->stop_seconds;
        }
        const bool more = r.renderer->passes() > r.shown_passes;
        const double since = seconds_between(r.shown, Clock::now());
        const bool due =
            rest || soon || r.shown_passes == 0 || since >= interval_after(r.seconds, r.resolving);
        if (asked || finished != shown_finished || (more && due)) {
            soon = asked;
            if (!publish(r, finished)) return;
            shown_finished = finished;
            free_retired();
        }
        if (rest) {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [&] {
                return superseded() || (!paused_ && !reached_limits(r)) ||
                       reached_limits(r) != finished || r.request_number != strategies_number_;
            });
            continue;
        }
        const double passes = double(r.renderer->passes());
        const double per_pass = std::max(1e-9, r.seconds / passes);
        double room = std::max(0.0, interval_after(r.seconds, r.resolving) - since) / per_pass;
        if (stop_seconds) room = std::min(room, (*stop_seconds - r.seconds) / per_pass);
        if (soon) room = 1;
        auto count = static_cast<std::uint64_t>(std::clamp(room, 1.0, passes));
        if (stop_passes) count = std::min(count, *stop_passes - r.renderer->passes());
        if (!render(r, count)) return;
    }
}

// False where the job was replaced; its films are of no use then.
bool LiveRender::render(Running& r, std::uint64_t passes) {
    const std::uint64_t paths_before = r.renderer->statistics().rays.camera_paths;
    const auto working_time = [&] {
        const std::lock_guard lock(mutex_);
        const auto now = Clock::now();
        return seconds_between(started_, now - paused_time(now));
    };
    const double began = working_time();
    const bool whole = r.renderer->render_passes(passes, {}, &control_);
    const double seconds = working_time() - began;
    r.seconds += seconds;
    const std::uint64_t paths = r.renderer->statistics().rays.camera_paths - paths_before;
    cost_.learn(r.pending.job.settings.technique, seconds * r.threads, double(paths));
    return whole;
}

bool LiveRender::publish(Running& r, bool finished) {
    const LiveJob& job = r.pending.job;
    const ProgressiveRenderer& renderer = *r.renderer;
    const auto began = Clock::now();
    std::optional<ResolvedImages> resolved =
        resolve_all(renderer, job.settings.exponents.size(), pool_, control_);
    if (!resolved) return false;
    std::shared_ptr<const StrategySnapshot> strategies =
        resolve_strategies(renderer, r.request, {r.view.placement, r.scale}, pool_);
    r.resolving = seconds_between(began, Clock::now());
    auto s = std::make_shared<Snapshot>();
    s->job = r.pending.number;
    s->scale = r.scale;
    s->width = job.settings.width;
    s->height = job.settings.height;
    s->crop = job.settings.crop.value_or(PixelRect{0, 0, s->width, s->height});
    s->placement = r.view.placement;
    s->exponents = job.settings.exponents;
    if (job.settings.technique == Technique::automatic) {
        s->plan = job.settings.plan;
        s->plan_in_words = plan_in_words_;
    }
    s->images = std::move(resolved->images);
    s->variances = std::move(resolved->variances);
    s->passes = renderer.passes();
    s->seconds = r.seconds;
    s->cpu_seconds = renderer.cpu_seconds();
    s->statistics = renderer.statistics();
    s->strategies = std::move(strategies);
    const std::uint64_t rays = s->statistics.rays.closest + s->statistics.rays.shadow;
    const double seconds = r.seconds - r.shown_seconds;
    if (seconds > 0) {
        s->samples_per_second =
            double(s->passes - r.shown_passes) * double(renderer.estimator().crop.area()) / seconds;
        s->rays_per_second = double(rays - r.shown_rays) / seconds;
    } else if (const auto before = snapshot()) {
        s->samples_per_second = before->samples_per_second;
        s->rays_per_second = before->rays_per_second;
    }
    s->finished = finished;
    r.shown_passes = s->passes;
    r.shown_rays = rays;
    r.shown_seconds = r.seconds;
    show(r, std::move(s));
    return true;
}

void LiveRender::show(Running& r, std::shared_ptr<const Snapshot> snapshot) {
    {
        const std::lock_guard lock(mutex_);
        if (cleared_) return;
        r.shown = Clock::now();
        if (paused_) {
            auto copy = std::make_shared<Snapshot>(*snapshot);
            copy->paused = true;
            snapshot = std::move(copy);
        }
        if (!first_out_) {
            latency_.job = r.pending.number;
            latency_.first_image_seconds = seconds_between(r.pending.submitted, r.shown);
        }
        first_out_ = true;
        snapshot_.swap(snapshot);
    }
    if (published_) published_();
}

// Large films take milliseconds to give back, and somebody is waiting for the next image.
void LiveRender::free_retired() {
    std::vector<std::shared_ptr<const void>> retired;
    {
        const std::lock_guard lock(mutex_);
        retired.swap(retired_);
    }
    if (retired.empty()) return;
    cleaner_ = std::jthread([old = std::move(retired)]() mutable { old.clear(); });
}

}  // namespace midway
