// Loads scenes on a thread of its own, for a window that goes on meanwhile. A newer request takes
// the place of an older one.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "render/prepare.h"

namespace midway {

struct LoadStatus {
    bool busy = false;
    std::string stage;  // in words, for a progress bar: "building the tree"
    double done = 0;    // of the whole load, 0 to 1; a rough share
};

struct LoadResult {
    std::uint64_t request = 0;
    SceneOptions options;
    std::shared_ptr<const PreparedScene> prepared;  // null where it failed
    std::string error;                              // one line then
    std::vector<std::string>
        files;                // the scene's, in the order they were opened; also of a failure
    std::uint64_t stamp = 0;  // file_stamp(files), from before they were read
};

// The files that a scene is read from: its own first, then those it names and the sky's. Also where
// some of them do not exist or the scene is broken; throws nothing.
std::vector<std::string> scene_files(const SceneOptions& options);

// Sizes and times of change of these files as one number: another number, another content. A file
// that does not exist has its own.
std::uint64_t file_stamp(const std::vector<std::string>& files);

class Loader {
  public:
    // `changed` is called from the loader's thread after every visible step of progress and for
    // every result; it must not block.
    explicit Loader(std::function<void()> changed = {});
    ~Loader();
    Loader(const Loader&) = delete;
    Loader& operator=(const Loader&) = delete;

    // Starts loading, and gives up what is being loaded; never waits. Returns the request's number,
    // counted from 1.
    std::uint64_t load(SceneOptions options);
    void cancel();  // no result comes for what is being loaded

    LoadStatus status() const;
    // The result of the newest request, once.
    std::optional<LoadResult> take();

  private:
    struct Request {
        std::uint64_t number = 0;
        SceneOptions options;
    };

    void coordinate();
    LoadResult load_now(const Request& request);
    void report(std::uint64_t request, const char* stage, double done);

    std::function<void()> changed_;
    std::atomic<std::uint64_t> wanted_{0};  // the newest request's number; 0: none

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // Under the mutex.
    bool quit_ = false;
    std::uint64_t last_number_ = 0;
    std::optional<Request> pending_;
    std::optional<LoadResult> result_;
    LoadStatus status_;

    std::jthread thread_;  // last: ends before what it uses
};

}  // namespace midway
