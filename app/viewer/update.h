// Changes of the scene (sky, lamps) worked out beside the window: a new sky may have to be read and
// its tables built. A newer change takes the place of an older one that waits. One under way goes
// on to its end, so that a stream of edits shows something and each starts from what the last one
// made; but it is given up where its sky is no longer wanted.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "render/prepare.h"

namespace midway {

struct UpdateResult {
    std::shared_ptr<const PreparedScene> prepared;  // null where it failed
    std::string error;                              // one line then
    std::chrono::steady_clock::time_point edited;   // as submitted
};

class SceneUpdater {
  public:
    // `finished` is called from the updater's thread; it must not block.
    explicit SceneUpdater(std::function<void()> finished);
    ~SceneUpdater();
    SceneUpdater(const SceneUpdater&) = delete;
    SceneUpdater& operator=(const SceneUpdater&) = delete;

    // `edited`: when the change was made.
    void submit(std::shared_ptr<const PreparedScene> scene, SceneOptions options,
                std::chrono::steady_clock::time_point edited = std::chrono::steady_clock::now());
    void forget();  // no result comes for what was submitted
    bool busy() const;
    std::optional<UpdateResult> take();  // the newest, once

  private:
    struct Request {
        std::shared_ptr<const PreparedScene> scene;
        SceneOptions options;
        std::chrono::steady_clock::time_point edited;
    };
    void work();
    UpdateResult update(const Request& request, const PreparedScene& from);

    std::function<void()> finished_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // Under the mutex.
    bool quit_ = false, working_ = false;
    std::uint64_t generation_ = 0;  // of forget()
    std::optional<Request> pending_;
    std::optional<UpdateResult> result_;
    std::shared_ptr<const PreparedScene> newest_;  // that was made here

    std::jthread thread_;  // last: ends before what it uses
};

}  // namespace midway
