// Between the window's state and what measures beside it: images are kept, a reference is read, and
// the curves of the error grow with the snapshots. By the UI thread; nothing here waits.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>

#include "compare_state.h"
#include "error_meter.h"

namespace midway {

struct App;
struct Engine;

// Brings a reference from the thread that reads it.
struct ReferenceInbox {
    std::mutex mutex;
    std::uint64_t number = 0;  // of the request that may still answer
    std::optional<LoadedReference> loaded;
};

// The part of the engine that belongs to comparing.
struct ComparingEngine {
    using Clock = std::chrono::steady_clock;
    explicit ComparingEngine(std::function<void()> wake) : meter(std::move(wake)) {}

    ErrorMeter meter;
    std::shared_ptr<ReferenceInbox> inbox = std::make_shared<ReferenceInbox>();
    std::optional<std::string> keep_later;  // the name of an image to keep at its first whole pass
    // What was given to the meter last.
    std::uint64_t job = 0, passes = 0;
    std::shared_ptr<const Reference> reference;
    double render_seconds = 0;  // of that image
    Clock::time_point submitted;
    double cost = 0;  // seconds that the last measurement took
};

// Keeps what is shown as A under this name (empty: one that says what it is), or does so at its
// first whole pass. Throws where there is no image, or no room for one more.
void keep_image(App& app, Engine& engine, const std::string& name);
void forget_image(CompareState& comparison, std::uint64_t id);

// Reads a reference beside the window; an empty path puts away the one there is.
void load_reference_file(App& app, Engine& engine, const std::string& path);

// The reference is taken to be of what is shown now.
void use_reference_here(App& app);

// Takes what was measured and read, follows the shown job, gives its newest image to the meter
// where it is time for it. True where something looks different.
bool follow_comparison(App& app, Engine& engine);

// The newest image is measured, or cannot be.
bool is_measured(const App& app, const Engine& engine);

// Writes the curves as .csv beside the window. Throws where there are none.
void save_curves(const App& app, Engine& engine, const std::string& path);

}  // namespace midway
