// Errors taken while a render runs: --error-log writes them, --target-error stops at one. They are
// taken at fixed numbers of passes (report/error_log.h), never at a time, so that a render with a
// target always ends at the same sample.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "render/renderer.h"
#include "report/error_log.h"

namespace midway {

struct ErrorOptions {
    std::optional<std::string> reference, log;
    std::optional<double> target;
};

void add_error_options(CLI::App& command, ErrorOptions& options);

// Wrong usage of the options together; throws.
void check_error_options(const ErrorOptions& options, bool resume);

class ErrorWatch {
  public:
    // Reads the reference, where there is one.
    ErrorWatch(const ErrorOptions& options, const RenderSettings& settings);

    bool wanted() const { return options_.log || options_.target; }
    // The number of passes at which the next error is to be taken.
    std::uint64_t next(const ProgressiveRenderer& renderer) const;
    // What was done before the first pass and counts as rendering too.
    void begin_at(const Elapsed& before) { before_ = before; }
    // Takes the error after `seconds` of rendering, unless it has been taken at these very samples.
    void take(const ProgressiveRenderer& renderer, double seconds);
    // At the last number of passes that counts: has the target been reached?
    bool reached() const { return reached_; }
    // The share of the way to the target, as errors fall with the number of samples.
    double share() const;

  private:
    ErrorOptions options_;
    RenderSettings settings_;
    std::optional<Reference> reference_;
    std::string rows_ = error_csv_header();
    Elapsed before_;
    std::uint64_t taken_ = 0;
    double error_ = 0;
    bool reached_ = false;
};

}  // namespace midway
