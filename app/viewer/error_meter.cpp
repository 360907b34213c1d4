#include "error_meter.h"

#include <chrono>
#include <exception>

#include "render/worker_priority.h"
#include "report/error_log.h"

namespace midway {
namespace {

Image cut(const Image& image, const PixelRect& r) {
    Image part(r.width(), r.height());
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x) part.at(x, y) = image.at(r.x0 + x, r.y0 + y);
    return part;
}

// The reference of what the snapshot shows: its own region, where that is part of the image.
std::shared_ptr<const Reference> fitting(const MeasureRequest& request) {
    const Snapshot& s = *request.snapshot;
    const Image& image = request.reference->image;
    if (image.width == s.crop.width() && image.height == s.crop.height()) return request.reference;
    check_reference_size(*request.reference, s.width, s.height, "reference");
    auto part = std::make_shared<Reference>();
    part->image = cut(image, s.crop);
    if (request.reference->variance) part->variance = cut(*request.reference->variance, s.crop);
    part->luminance.estimate.mean = mean_luminance(part->image);
    return part;
}

}  // namespace

std::vector<CurvePoint> measure(const MeasureRequest& request) {
    const Snapshot& s = *request.snapshot;
    const std::shared_ptr<const Reference> reference =
        request.reference ? fitting(request) : nullptr;
    std::vector<CurvePoint> points;
    for (size_t i = 0; i < s.images.size(); ++i) {
        CurvePoint p{s.seconds, s.cpu_seconds, s.passes};
        if (s.variances[i])
            p.estimate = estimate_relmse(*s.images[i], *s.variances[i], pass_counts(0, s.passes))
                             .value_or(p.estimate);
        if (reference)
            p.measured =
                measure_error(*reference, *s.images[i], s.passes, {s.seconds, s.cpu_seconds});
        points.push_back(p);
    }
    return points;
}

ErrorMeter::ErrorMeter(std::function<void()> finished)
    : finished_(std::move(finished)), thread_([this] { work(); }) {}

ErrorMeter::~ErrorMeter() {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    wake_.notify_all();
}

void ErrorMeter::submit(MeasureRequest request) {
    const std::lock_guard lock(mutex_);
    pending_ = std::move(request);
    wake_.notify_all();
}

bool ErrorMeter::busy() const {
    const std::lock_guard lock(mutex_);
    return working_ || pending_ || !results_.empty();
}

std::optional<Measurement> ErrorMeter::take() {
    const std::lock_guard lock(mutex_);
    if (results_.empty()) return {};
    Measurement result = std::move(results_.front());
    results_.pop_front();
    return result;
}

void ErrorMeter::work() {
    lower_priority();
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [this] { return quit_ || pending_; });
        if (quit_) return;
        std::optional<MeasureRequest> request = std::move(pending_);
        pending_.reset();
        working_ = true;
        lock.unlock();
        const auto began = std::chrono::steady_clock::now();
        Measurement m{request->snapshot->job, request->snapshot->passes, request->reference};
        try {
            m.points = measure(*request);
        } catch (const std::exception& e) {
            m.error = e.what();
        }
        request.reset();  // large images are given back here, not where the window waits
        m.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        lock.lock();
        working_ = false;
        results_.push_back(std::move(m));
        finished_();
    }
}

}  // namespace midway
