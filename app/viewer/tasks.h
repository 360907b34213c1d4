// Small jobs beside the window, one after the other: files are written while it goes on. And the
// way in which any thread wakes the window.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace midway {

// Wakes whatever window there is at the moment; threads may start before it and end after it.
class Waker {
  public:
    void set(std::function<void()> wake);
    void wake();

  private:
    std::mutex mutex_;
    std::function<void()> wake_;
};

struct TaskResult {
    std::string notice, error;  // one of them; one line
};

class Tasks {
  public:
    explicit Tasks(std::function<void()> finished);
    ~Tasks();  // finishes what was submitted
    Tasks(const Tasks&) = delete;
    Tasks& operator=(const Tasks&) = delete;

    // Runs `task`, which returns a line to show; what it throws becomes the error.
    void submit(std::function<std::string()> task);
    bool busy() const;
    std::optional<TaskResult> take();  // the oldest, once

  private:
    void work();

    std::function<void()> finished_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    // Under the mutex.
    bool quit_ = false, working_ = false;
    std::deque<std::function<std::string()>> pending_;
    std::deque<TaskResult> results_;

    std::jthread thread_;  // last: ends before what it uses
};

}  // namespace midway
