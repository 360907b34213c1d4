// A thread that works on the newest request: a newer one cancels what runs and takes the place of
// what waits. Nobody waits for it; results are taken when they are there, the newest only.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "render/render_control.h"

namespace midway {

template <class Request, class Result>
class NewestWorker {
  public:
    // May be called several times for one request.
    using Publish = std::function<void(Result)>;
    // Ends soon once the control says so; throws nothing.
    using Work = std::function<void(const Request&, const RenderControl&, const Publish&)>;

    // `published` is called from the worker's thread; it must not block.
    NewestWorker(Work work, std::function<void()> published)
        : work_(std::move(work)), published_(std::move(published)), thread_([this] { run(); }) {}
    ~NewestWorker() {
        const std::lock_guard lock(mutex_);
        quit_ = true;
        control_.cancel();
        changed_.notify_all();
    }
    NewestWorker(const NewestWorker&) = delete;
    NewestWorker& operator=(const NewestWorker&) = delete;

    void submit(Request request) {
        const std::lock_guard lock(mutex_);
        forget();
        pending_ = std::move(request);
        changed_.notify_all();
    }

    // Nothing more comes of what was submitted.
    void cancel() {
        const std::lock_guard lock(mutex_);
        forget();
    }

    bool busy() const {
        const std::lock_guard lock(mutex_);
        return pending_ || working_ || result_;
    }

    std::optional<Result> take() {
        const std::lock_guard lock(mutex_);
        return std::exchange(result_, std::nullopt);
    }

  private:
    void forget() {
        ++generation_;
        pending_.reset();
        result_.reset();
        control_.cancel();
    }

    void publish(std::uint64_t generation, Result result) {
        {
            const std::lock_guard lock(mutex_);
            if (generation != generation_) return;
            result_ = std::move(result);
        }
        published_();
    }

    void run() {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait(lock, [this] { return quit_ || pending_; });
            if (quit_) return;
            std::optional<Request> request = std::exchange(pending_, std::nullopt);
            working_ = true;
            const std::uint64_t generation = generation_;
            control_.run();
            lock.unlock();
            work_(*request, control_, [&](Result r) { publish(generation, std::move(r)); });
            // A scene that is held by nobody else takes its time to be given back.
            request.reset();
            lock.lock();
            working_ = false;
        }
    }

    Work work_;
    std::function<void()> published_;
    RenderControl control_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    // Under the mutex.
    bool quit_ = false, working_ = false;
    std::uint64_t generation_ = 0;
    std::optional<Request> pending_;
    std::optional<Result> result_;

    std::jthread thread_;  // last: ends before what it uses
};

}  // namespace midway
