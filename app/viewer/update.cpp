#include "update.h"

#include <exception>
#include <utility>

namespace midway {

SceneUpdater::SceneUpdater(std::function<void()> finished)
    : finished_(std::move(finished)), thread_([this] { work(); }) {}

SceneUpdater::~SceneUpdater() {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    wake_.notify_all();
}

void SceneUpdater::submit(std::shared_ptr<const PreparedScene> scene, SceneOptions options) {
    const std::lock_guard lock(mutex_);
    pending_ = Request{std::move(scene), std::move(options)};
    wake_.notify_all();
}

void SceneUpdater::forget() {
    const std::lock_guard lock(mutex_);
    ++generation_;
    pending_.reset();
    result_.reset();
}

bool SceneUpdater::busy() const {
    const std::lock_guard lock(mutex_);
    return pending_ || working_ || result_;
}

std::optional<UpdateResult> SceneUpdater::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(result_, std::nullopt);
}

void SceneUpdater::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [this] { return quit_ || pending_; });
        if (quit_) return;
        const Request request = std::move(*pending_);
        pending_.reset();
        working_ = true;
        const std::uint64_t generation = generation_;
        lock.unlock();
        UpdateResult result;
        try {
            result.prepared = std::make_shared<const PreparedScene>(
                update_scene(*request.scene, request.options));
        } catch (const std::exception& e) {
            result.error = e.what();
        }
        lock.lock();
        working_ = false;
        if (generation == generation_) {
            result_ = std::move(result);
            finished_();
        }
    }
}

}  // namespace midway
