#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

namespace midway {
namespace {

std::string clock_text(double seconds) {
    const long s = static_cast<long>(std::clamp(seconds, 0.0, 1e7));
    return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                    : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

Progress::Progress(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO)) {}

Progress::~Progress() {
    if (drawn_ && terminal_) fmt::print(stderr, "\n");
}

void Progress::update(const ProgressState& s) {
    if (quiet_) return;
    const auto now = Clock::now();
    const double since = std::chrono::duration<double>(now - last_).count();
    if (since < (terminal_ ? 0.1 : 10.0)) return;
    last_ = now;
    drawn_ = true;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const std::string left =
        s.done > 0 ? clock_text(elapsed * (1 - s.done) / s.done) : std::string("?");
    const std::string text = s.doing.empty()
                                 ? fmt::format("{:.0f} samples  {:.2f} Mrays/s  {} left", s.samples,
                                               static_cast<double>(s.rays) / elapsed * 1e-6, left)
                                 : fmt::format("{}  {} left", s.doing, left);
    if (!terminal_) {
        fmt::print(stderr, "midway: {:3.0f} %  {}\n", 100 * s.done, text);
        return;
    }
    constexpr int width = 30;
    const int filled = static_cast<int>(width * std::clamp(s.done, 0.0, 1.0));
    fmt::print(stderr, "\r[{}{}] {:3.0f} %  {}  ", std::string(filled, '#'),
               std::string(width - filled, '.'), 100 * s.done, text);
    std::fflush(stderr);
}

}  // namespace midway
