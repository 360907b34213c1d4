// Measures the error of a render's images beside the window, on a thread of its own. A newer
// request takes the place of one that waits; results come in order.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "error_curves.h"
#include "render/live_render.h"
#include "report/reference.h"

namespace midway {

struct MeasureRequest {
    std::shared_ptr<const Snapshot> snapshot;    // of scale 1
    std::shared_ptr<const Reference> reference;  // of the crop, or of the whole image; null: none
};

struct Measurement {
    std::uint64_t job = 0, passes = 0;
    std::shared_ptr<const Reference> reference;
    std::vector<CurvePoint> points;  // one per exponent of the snapshot
    double seconds = 0;              // that measuring took
    std::string error;               // one line where it could not be done; no points then
};

// Throws std::runtime_error where the reference fits neither the crop nor the whole image.
std::vector<CurvePoint> measure(const MeasureRequest& request);

class ErrorMeter {
  public:
    // `finished` is called from the meter's thread; it must not block.
    explicit ErrorMeter(std::function<void()> finished);
    ~ErrorMeter();
    ErrorMeter(const ErrorMeter&) = delete;
    ErrorMeter& operator=(const ErrorMeter&) = delete;

    void submit(MeasureRequest request);
    bool busy() const;                  // until its last result is taken
    std::optional<Measurement> take();  // the oldest, once

  private:
    void work();

    std::function<void()> finished_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // Under the mutex.
    bool quit_ = false, working_ = false;
    std::optional<MeasureRequest> pending_;
    std::deque<Measurement> results_;

    std::jthread thread_;  // last: ends before what it uses
};

}  // namespace midway
