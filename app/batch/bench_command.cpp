// midway bench: how fast a scene renders here, and how much of that are its rays.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "middle_json.h"
#include "plan_json.h"
#include "render/json_text.h"
#include "render_options.h"
#include "report/bench.h"
#include "session_options.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, work_kinds> work_names = {"other",   "rays",    "sampling",
                                                                 "shading", "weights", "film"};

struct BenchJob {
    SceneOptions scene;
    RenderSettings settings;
    RenderWords words;
    std::string technique = "auto";
    BenchOptions options;
    bool json = false;
};

Json bench_json(const BenchResult& r) {
    Json j;
    j["threads"] = r.threads;
    j["samples_per_second"] = r.samples_per_second;
    j["rays_per_second"] = r.rays_per_second;
    j["rays_replayed_per_second"] = r.replayed_per_second;
    j["limit_ratio"] = r.limit_ratio.median;
    j["limit_ratio_interval"] = {r.limit_ratio.low, r.limit_ratio.high};
    j["whole_log"] = r.whole_log;
    j["seconds_per_pass"] = middle_json(r.seconds_per_pass);
    j["rays_per_sample"] = {
        {"closest", double(r.per_pass.closest) / double(r.per_pass.camera_paths)},
        {"shadow", double(r.per_pass.shadow) / double(r.per_pass.camera_paths)}};
    j["shares"] = Json::object();
    for (size_t i = 0; i < work_kinds; ++i) j["shares"][work_names[i]] = r.shares[i];
    j["sharing"] = middle_json(r.sharing);
    j["scaling"] = Json::array();
    for (const BenchResult::Scaling& s : r.scaling)
        j["scaling"].push_back(
            {{"threads", s.threads}, {"samples_per_second", s.samples_per_second}});
    return j;
}

void print_text(const BenchResult& r, const std::string& technique) {
    const double samples = double(r.per_pass.camera_paths);
    fmt::print("{}, {} thread{}: {:.3g} million samples/s, {:.3g} million rays/s\n", technique,
               r.threads, r.threads == 1 ? "" : "s", 1e-6 * r.samples_per_second,
               1e-6 * r.rays_per_second);
    fmt::print("  a sample: {:.2f} rays to the next surface, {:.2f} connections\n",
               double(r.per_pass.closest) / samples, double(r.per_pass.shadow) / samples);
    fmt::print("  the same rays alone: {:.3g} million/s, {:.3f} of the time ({:.3f} to {:.3f}){}\n",
               1e-6 * r.replayed_per_second, r.limit_ratio.median, r.limit_ratio.low,
               r.limit_ratio.high, r.whole_log ? "" : "; only the first rays were kept");
    fmt::print("  time:");
    for (size_t i = 0; i < work_kinds; ++i)
        fmt::print(" {} {:.1f} %{}", work_names[i], 100 * r.shares[i],
                   i + 1 < work_kinds ? "," : "\n");
    fmt::print("  one film for all threads: {:.3f} of the time of films apart ({:.3f} to {:.3f})\n",
               r.sharing.median, r.sharing.low, r.sharing.high);
    for (const BenchResult::Scaling& s : r.scaling)
        fmt::print("  {} thread{}: {:.3g} million samples/s\n", s.threads,
                   s.threads == 1 ? "" : "s", 1e-6 * s.samples_per_second);
}

int run(const CLI::App& command, BenchJob& job) {
    finish_settings(job.words, job.settings);
    choose_technique(job.technique, job.settings);
    if (const auto session = take_session(command, job.scene, job.json))
        take_settings(command, session->settings, job.settings);
    const PreparedScene p = prepare_scene(job.scene);
    if (!job.json) print_warnings(p.warnings);
    std::string technique{to_string(job.settings.technique)};
    if (const auto decision = choose_plan(*p.scene, p.camera, job.settings, job.options.threads))
        technique += " (" + describe(decision->plan) + ")";
    const BenchResult r = run_bench(p.scene, p.camera, job.settings, job.options);
    if (!job.json) {
        print_text(r, technique);
        return exit_done;
    }
    Json j = bench_json(r);
    j["scene"] = p.description.source;
    j["technique"] = technique;
    j["size"] = {job.settings.width, job.settings.height};
    fmt::print("{}\n", json_text(j));
    return exit_done;
}

}  // namespace

Command add_bench_command(CLI::App& app) {
    auto* c = app.add_subcommand("bench", "How fast a scene renders, and how much of it are rays");
    auto job = std::make_shared<BenchJob>();
    add_scene_options(*c, job->scene);
    c->add_option("--technique", job->technique, "path, light, bdpt, bdpt:EXPONENT or auto")
        ->capture_default_str();
    add_settings_options(*c, job->settings, job->words);
    add_threads_option(*c, job->options.threads);
    c->add_option("--rounds", job->options.rounds, "Rounds of each measurement, in turns")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    c->add_flag("--json", job->json, "As JSON");
    return [c, job] { return run(*c, *job); };
}

}  // namespace midway
