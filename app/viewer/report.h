// What the window measured of itself, as JSON: how fast frames, edits, stops and samples are.
// Seconds throughout. `median` and `p95` are order statistics of all that was kept since the mark.
#pragma once

#include <chrono>
#include <ctime>
#include <string>

#include "state.h"

namespace midway {

// Where `mark` began.
struct ReportMark {
    std::chrono::steady_clock::time_point time = std::chrono::steady_clock::now();
    double cpu_seconds = double(std::clock()) / CLOCKS_PER_SEC;  // of the whole process
    double samples = 0;                                          // per pixel, of the job then
    std::uint64_t job = 0;
};

ReportMark mark_now(App& app);  // forgets the timings but for the first pixels

// Throws std::runtime_error where the file cannot be written.
void write_report(const std::string& path, const App& app, const ReportMark& mark);

// Adds to a list of bounded length.
void note_time(std::vector<float>& list, double seconds);

}  // namespace midway
