// Options of what is recorded and how: shared by the commands that render. Their words are turned
// into settings after parsing.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "render/settings.h"

namespace midway {

struct RenderWords {
    std::string sampler = "sobol", filter = "blackman-harris", size = "512x512";
    std::optional<std::string> families;
    std::vector<int> crop;
    std::vector<std::string> only;
};

// A value that does not parse is wrong usage (exit 2), like an unknown option.
[[noreturn]] void usage(const std::string& message);

// All but technique and exponents.
void add_settings_options(CLI::App& command, RenderSettings& settings, RenderWords& words);
void add_threads_option(CLI::App& command, int& threads);
void finish_settings(const RenderWords& words, RenderSettings& settings);

// "NAME" or "NAME:EXPONENT".
void choose_technique(const std::string& text, RenderSettings& settings);

// WxH; throws wrong usage.
void parse_size(const std::string& text, RenderSettings& settings);

// A whole number from `low` to `high`, in words that fit on a line; CLI11 itself would wrap -1
// around.
CLI::Validator whole_number(std::uint64_t low, std::uint64_t high);
CLI::Validator positive_number();

}  // namespace midway
