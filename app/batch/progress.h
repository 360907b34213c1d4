// Progress on stderr: a bar that is redrawn on a terminal, a line now and then otherwise.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace midway {

struct ProgressState {
    double done = 0;     // 0..1
    double samples = 0;  // per pixel
    std::uint64_t rays = 0;
    std::string doing = {};  // shown in place of samples and rays
};

class Progress {
  public:
    explicit Progress(bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void update(const ProgressState& state);

  private:
    using Clock = std::chrono::steady_clock;
    bool quiet_, terminal_;
    bool drawn_ = false;
    Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace midway
