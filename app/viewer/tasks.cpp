#include "tasks.h"

#include <exception>

namespace midway {

void Waker::set(std::function<void()> wake) {
    const std::lock_guard lock(mutex_);
    wake_ = std::move(wake);
}

void Waker::wake() {
    const std::lock_guard lock(mutex_);
    if (wake_) wake_();
}

Tasks::Tasks(std::function<void()> finished)
    : finished_(std::move(finished)), thread_([this] { work(); }) {}

Tasks::~Tasks() {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    changed_.notify_all();
}

void Tasks::submit(std::function<std::string()> task) {
    const std::lock_guard lock(mutex_);
    pending_.push_back(std::move(task));
    changed_.notify_all();
}

bool Tasks::busy() const {
    const std::lock_guard lock(mutex_);
    return working_ || !pending_.empty();
}

std::optional<TaskResult> Tasks::take() {
    const std::lock_guard lock(mutex_);
    if (results_.empty()) return {};
    TaskResult result = std::move(results_.front());
    results_.pop_front();
    return result;
}

void Tasks::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return quit_ || !pending_.empty(); });
        if (pending_.empty()) return;
        const std::function<std::string()> task = std::move(pending_.front());
        pending_.pop_front();
        working_ = true;
        lock.unlock();
        TaskResult result;
        try {
            result.notice = task();
        } catch (const std::exception& e) {
            result.error = e.what();
        }
        lock.lock();
        working_ = false;
        results_.push_back(std::move(result));
        finished_();
    }
}

}  // namespace midway
