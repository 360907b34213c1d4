#include "render/live_images.h"

#include <algorithm>
#include <mutex>
#include <thread>

#include "render/worker_priority.h"

namespace midway {
namespace {

// Images below this many pixels are resolved faster than threads are started.
constexpr std::int64_t few_pixels = 64 * 1024;
constexpr int rows_at_once = 8;
constexpr std::uint64_t jobs_kept = 8;

}  // namespace

struct ImagePool::Shelf {
    struct Entry {
        std::unique_ptr<Image> image;
        std::uint64_t job = 0;  // that used it last
    };
    std::mutex mutex;
    std::vector<Entry> free;
    std::uint64_t job = 0;

    void give_back(std::unique_ptr<Image> image) {
        const std::lock_guard lock(mutex);
        free.push_back({std::move(image), job});
    }
};

ImagePool::ImagePool() : shelf_(std::make_shared<Shelf>()) {}

std::shared_ptr<Image> ImagePool::take(int width, int height) {
    std::unique_ptr<Image> image;
    {
        const std::lock_guard lock(shelf_->mutex);
        const auto fits = [&](const Shelf::Entry& e) {
            return e.image->width == width && e.image->height == height;
        };
        const auto found = std::find_if(shelf_->free.begin(), shelf_->free.end(), fits);
        if (found != shelf_->free.end()) {
            image = std::move(found->image);
            shelf_->free.erase(found);
        }
    }
    if (!image) image = std::make_unique<Image>(width, height);
    const auto give_back = [shelf = shelf_](Image* p) {
        shelf->give_back(std::unique_ptr<Image>(p));
    };
    return {image.release(), give_back};
}

std::vector<std::unique_ptr<Image>> ImagePool::unused() {
    const std::lock_guard lock(shelf_->mutex);
    ++shelf_->job;
    std::vector<std::unique_ptr<Image>> images;
    for (Shelf::Entry& e : shelf_->free)
        if (e.job + jobs_kept < shelf_->job) images.push_back(std::move(e.image));
    std::erase_if(shelf_->free, [](const Shelf::Entry& e) { return !e.image; });
    return images;
}

std::optional<ResolvedImages> resolve_all(const ProgressiveRenderer& r, size_t exponents,
                                          ImagePool& pool, const RenderControl& control) {
    const int width = r.film().width(), height = r.film().height();
    const PassCounts passes = r.counts();
    const bool has_variance = passes.a > 0 && passes.b > 0;
    std::vector<std::shared_ptr<Image>> means, variances;
    for (size_t i = 0; i < exponents; ++i) {
        means.push_back(pool.take(width, height));
        variances.push_back(has_variance ? pool.take(width, height) : nullptr);
    }
    const int bands = (height + rows_at_once - 1) / rows_at_once;
    const int items = bands * static_cast<int>(exponents);
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int i = next++; i < items && !control.cancelled(); i = next++) {
            const auto k = static_cast<size_t>(i / bands);
            const int y = i % bands * rows_at_once;
            resolve_rows(r.film(static_cast<int>(k)), passes, y, std::min(y + rows_at_once, height),
                         means[k].get(), variances[k].get());
        }
    };
    if (std::int64_t{width} * height < few_pixels) {
        work();
    } else {
        std::vector<std::jthread> workers;
        for (int i = 0; i < r.threads(); ++i)
            workers.emplace_back([&] {
                lower_priority();
                work();
            });
    }
    if (control.cancelled()) return {};
    ResolvedImages resolved;
    resolved.images.assign(means.begin(), means.end());
    resolved.variances.assign(variances.begin(), variances.end());
    return resolved;
}

}  // namespace midway
