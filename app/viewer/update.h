// Changes of the scene (sky, lamps) worked out beside the window: a new sky may have to be read and
// its tables built. A newer change takes the place of an older one that waits.
#pragma once

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
};

class SceneUpdater {
  public:
    // `finished` is called from the updater's thread; it must not block.
    explicit SceneUpdater(std::function<void()> finished);
    ~SceneUpdater();
    SceneUpdater(const SceneUpdater&) = delete;
    SceneUpdater& operator=(const SceneUpdater&) = delete;

    void submit(std::shared_ptr<const PreparedScene> scene, SceneOptions options);
    void forget();  // no result comes for what was submitted
    bool busy() const;
    std::optional<UpdateResult> take();  // the newest, once

  private:
    struct Request {
        std::shared_ptr<const PreparedScene> scene;
        SceneOptions options;
    };
    void work();

    std::function<void()> finished_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    // Under the mutex.
    bool quit_ = false, working_ = false;
    std::uint64_t generation_ = 0;  // of forget()
    std::optional<Request> pending_;
    std::optional<UpdateResult> result_;

    std::jthread thread_;  // last: ends before what it uses
};

}  // namespace midway
