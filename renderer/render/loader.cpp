#include "render/loader.h"

#include <sys/stat.h>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include "image/file.h"
#include "io/gltf_references.h"
#include "math/hash.h"

namespace midway {
namespace {

// Thrown through prepare_scene by its progress; no std::exception, since it is no failure.
struct Cancelled {};

// A visible step of a progress bar.
constexpr double visible_step = 0.01;

}  // namespace

std::vector<std::string> scene_files(const SceneOptions& options) {
    std::vector<std::string> files{options.path};
    const std::vector<std::string> named = gltf_references(options.path);
    files.insert(files.end(), named.begin(), named.end());
    if (options.sky) files.push_back(*options.sky);
    return files;
}

std::uint64_t file_stamp(const std::vector<std::string>& files) {
    std::uint64_t stamp = 0;
    for (const std::string& file : files) {
        struct stat s {};
        std::int64_t facts[4] = {-1, -1, -1, -1};
        if (stat(file.c_str(), &s) == 0) {
            facts[0] = s.st_size;
            facts[1] = s.st_mtim.tv_sec;
            facts[2] = s.st_mtim.tv_nsec;
            facts[3] = static_cast<std::int64_t>(s.st_ino);
        }
        stamp = hash_bytes(stamp, facts, sizeof facts);
    }
    return stamp;
}

Loader::Loader(std::function<void()> changed)
    : changed_(std::move(changed)), thread_([this] { coordinate(); }) {}

Loader::~Loader() {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    wanted_ = 0;
    wake_.notify_all();
}

std::uint64_t Loader::load(SceneOptions options) {
    const std::lock_guard lock(mutex_);
    pending_ = Request{++last_number_, std::move(options)};
    result_.reset();
    status_ = {true, "waiting", 0};
    wanted_ = last_number_;
    wake_.notify_all();
    return last_number_;
}

void Loader::cancel() {
    const std::lock_guard lock(mutex_);
    wanted_ = 0;
    pending_.reset();
    result_.reset();
    status_ = {};
}

LoadStatus Loader::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

std::optional<LoadResult> Loader::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(result_, std::nullopt);
}

void Loader::coordinate() {
    for (;;) {
        Request request;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return quit_ || pending_; });
            if (quit_) return;
            request = std::move(*pending_);
            pending_.reset();
        }
        LoadResult result;
        try {
            result = load_now(request);
        } catch (const Cancelled&) {
            continue;
        }
        {
            const std::lock_guard lock(mutex_);
            if (wanted_ != request.number) continue;
            result_ = std::move(result);
            status_ = {};
        }
        if (changed_) changed_();
    }
}

LoadResult Loader::load_now(const Request& request) {
    LoadResult result;
    result.request = request.number;
    result.options = request.options;
    result.files = scene_files(request.options);
    result.stamp = file_stamp(result.files);
    try {
        result.prepared = std::make_shared<PreparedScene>(prepare_scene(
            request.options,
            [&](const char* stage, double done) { report(request.number, stage, done); }));
    } catch (const std::bad_alloc&) {
        result.error = "not enough memory for the scene (" + one_line(request.options.path) +
                       "); close programs or split the scene";
    } catch (const std::exception& e) {
        result.error = one_line(e.what());
    }
    return result;
}

void Loader::report(std::uint64_t request, const char* stage, double done) {
    if (wanted_ != request) throw Cancelled{};
    {
        const std::lock_guard lock(mutex_);
        if (wanted_ != request) throw Cancelled{};
        const bool visible = status_.stage != stage || done >= status_.done + visible_step;
        if (!visible) return;
        status_ = {true, stage, done};
    }
    if (changed_) changed_();
}

}  // namespace midway
