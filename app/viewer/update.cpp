#include "update.h"

#include <exception>
#include <utility>

namespace midway {
namespace {

// Thrown through update_scene by its progress; no std::exception, since it is no failure.
struct Superseded {};

}  // namespace

SceneUpdater::SceneUpdater(std::function<void()> finished)
    : finished_(std::move(finished)), thread_([this] { work(); }) {}

SceneUpdater::~SceneUpdater() {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    wake_.notify_all();
}

void SceneUpdater::submit(std::shared_ptr<const PreparedScene> scene, SceneOptions options,
                          std::chrono::steady_clock::time_point edited) {
    const std::lock_guard lock(mutex_);
    pending_ = Request{std::move(scene), std::move(options), edited};
    wake_.notify_all();
}

void SceneUpdater::forget() {
    const std::lock_guard lock(mutex_);
    ++generation_;
    pending_.reset();
    result_.reset();
    newest_.reset();
}

bool SceneUpdater::busy() const {
    const std::lock_guard lock(mutex_);
    return pending_ || working_ || result_;
}

std::optional<UpdateResult> SceneUpdater::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(result_, std::nullopt);
}

UpdateResult SceneUpdater::update(const Request& request, const PreparedScene& from) {
    UpdateResult result;
    result.edited = request.edited;
    try {
        result.prepared = std::make_shared<const PreparedScene>(
            update_scene(from, request.options, [&](const char*, double) {
                const std::lock_guard lock(mutex_);
                if (quit_ || (pending_ && pending_->options.sky != request.options.sky))
                    throw Superseded{};
            }));
    } catch (const std::exception& e) {
        result.error = e.what();
    }
    return result;
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
        // What was made here last may already hold what this change asks for.
        const bool same_file = newest_ && newest_->file == request.scene->file;
        const std::shared_ptr<const PreparedScene> from = same_file ? newest_ : request.scene;
        lock.unlock();
        std::optional<UpdateResult> result;
        try {
            result = update(request, *from);
        } catch (const Superseded&) {
        }
        lock.lock();
        working_ = false;
        if (result && generation == generation_) {
            if (result->prepared) newest_ = result->prepared;
            result_ = std::move(result);
            finished_();
        }
    }
}

}  // namespace midway
