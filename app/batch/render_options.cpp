#include "render_options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace midway {
namespace {

// The whole text as a number; empty where it is none.
template <class Number>
std::optional<Number> parse_number(const std::string& text) {
    Number n{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return n;
}

Strategy parse_strategy(const std::string& text) {
    Strategy k;
    int n = 0;
    const bool read = std::sscanf(text.c_str(), "%d,%d%n", &k.s, &k.t, &n) == 2;
    if (!read || static_cast<size_t>(n) != text.size() || k.s < 1 || k.t < 0 || k.s + k.t < 2 ||
        k == Strategy{1, 1})
        usage("--only: \"" + text + "\" is not a strategy S,T");
    return k;
}

}  // namespace

void usage(const std::string& message) { throw CLI::ValidationError(message); }

void parse_size(const std::string& text, RenderSettings& s) {
    int n = 0;
    if (std::sscanf(text.c_str(), "%dx%d%n", &s.width, &s.height, &n) != 2 ||
        static_cast<size_t>(n) != text.size())
        usage("--size: \"" + text + "\" is not WxH");
}

void choose_technique(const std::string& text, RenderSettings& s) {
    const size_t colon = text.find(':');
    try {
        s.technique = parse_technique(text.substr(0, colon));
    } catch (const std::invalid_argument& e) {
        usage(e.what());
    }
    if (colon == std::string::npos) return;
    const std::optional<double> exponent = parse_number<double>(text.substr(colon + 1));
    if (!exponent) usage("--technique: \"" + text + "\" has no number after the colon");
    s.exponents = {*exponent};
}

void finish_settings(const RenderWords& w, RenderSettings& s) {
    try {
        s.sampler = parse_sampler(w.sampler);
        s.filter = parse_filter(w.filter);
        if (w.families) s.families = parse_families(*w.families);
    } catch (const std::exception& e) {
        usage(e.what());
    }
    parse_size(w.size, s);
    if (w.crop.size() == 4) s.crop = PixelRect{w.crop[0], w.crop[1], w.crop[2], w.crop[3]};
    for (const std::string& text : w.only) s.only.push_back(parse_strategy(text));
}

CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
    return CLI::Validator(
        [=](const std::string& text) {
            const std::optional<std::uint64_t> n = parse_number<std::uint64_t>(text);
            if (n && *n >= low && *n <= high) return std::string();
            return fmt::format("\"{}\" is not a whole number from {} to {}", text, low, high);
        },
        "");
}

CLI::Validator positive_number() {
    return CLI::Validator(
        [](const std::string& text) {
            const std::optional<double> x = parse_number<double>(text);
            if (x && *x > 0 && std::isfinite(*x)) return std::string();
            return fmt::format("\"{}\" is not a number above 0", text);
        },
        "");
}

void add_settings_options(CLI::App& sub, RenderSettings& s, RenderWords& w) {
    sub.add_option("--size", w.size, "Image size WxH")->capture_default_str();
    sub.add_option("--crop", w.crop, "X0,Y0,X1,Y1")->delimiter(',')->expected(4);
    sub.add_option("--filter", w.filter, "box, gaussian or blackman-harris")->capture_default_str();
    sub.add_option("--max-bounces", s.max_bounces, "Longest path, scattering events")
        ->capture_default_str();
    sub.add_option("--seed", s.seed, "Seed of the random numbers")
        ->check(whole_number(0, ~std::uint64_t{0}));
    sub.add_option("--sampler", w.sampler, "sobol or independent")->capture_default_str();
    sub.add_option("--clamp", s.clamp, "Largest component of a contribution (biased)")
        ->check(positive_number());
    sub.add_option("--families", w.families, "Of emitter,next-event,light,connect");
    sub.add_option("--only", w.only, "S,T: record this strategy alone (repeatable)")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    sub.add_flag("--unweighted", s.unweighted, "Record bare estimates");
}

void add_threads_option(CLI::App& sub, int& threads) {
    sub.add_option("--threads", threads, "Threads; 0: all processors")->check(CLI::Range(0, 1024));
}

}  // namespace midway
