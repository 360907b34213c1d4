// How somebody outside stops, pauses and resumes the workers of a render. Workers ask between
// pixels; a worker that is paused sleeps until it is told to go on. Every function may be called
// from any thread.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>

namespace midway {

class RenderControl {
  public:
    using Clock = std::chrono::steady_clock;

    void run() { change(State::running); }
    void pause() { change(State::paused); }
    void cancel() { change(State::cancelled); }
    // Goes on until then; what is not done by that time is cancelled.
    void cancel_at(Clock::time_point time) {
        deadline_.store(time.time_since_epoch().count(), std::memory_order_relaxed);
        change(State::ending);
    }

    // A batch of passes shall end with the pass that is under way: somebody has news for the
    // renderer. Stays so until begin_batches().
    void end_batch() { batch_ends_.store(true, std::memory_order_relaxed); }
    void begin_batches() { batch_ends_.store(false, std::memory_order_relaxed); }
    bool batch_ends() const { return batch_ends_.load(std::memory_order_relaxed); }

    // Like go_on(), but never sleeps.
    bool cancelled() const {
        const State state = state_.load(std::memory_order_acquire);
        return state == State::cancelled || (state == State::ending && too_late());
    }

    // For workers: false where they shall stop. Costs one relaxed load while all is well.
    bool go_on() const {
        return state_.load(std::memory_order_relaxed) == State::running || wait_for_word();
    }

  private:
    enum class State : std::int32_t { running, paused, cancelled, ending };

    void change(State state) {
        state_.store(state, std::memory_order_release);
        state_.notify_all();
    }

    bool too_late() const {
        return Clock::now().time_since_epoch().count() >= deadline_.load(std::memory_order_relaxed);
    }

    bool wait_for_word() const {
        for (;;) {
            const State state = state_.load(std::memory_order_acquire);
            if (state == State::running) return true;
            if (state == State::cancelled) return false;
            if (state == State::ending) return !too_late();
            state_.wait(State::paused, std::memory_order_acquire);
        }
    }

    std::atomic<State> state_{State::running};
    std::atomic<bool> batch_ends_{false};
    std::atomic<Clock::rep> deadline_{0};
};

}  // namespace midway
