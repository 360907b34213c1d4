// midway render: from a scene to image files.
#include <fmt/format.h>

#include <ctime>

#include "checkpoint.h"
#include "commands.h"
#include "error_watch.h"
#include "interrupt.h"
#include "outputs.h"
#include "progress.h"
#include "render/coverage.h"
#include "render/pilot.h"
#include "render/waves.h"
#include "render_options.h"
#include "sample_output.h"
#include "session_options.h"

namespace midway {
namespace {

struct RenderCommand {
    const CLI::App* command = nullptr;
    SceneOptions scene;
    RenderSettings settings;
    RendererOptions renderer;
    OutputOptions outputs;
    ErrorOptions errors;
    std::optional<std::uint64_t> spp;
    std::optional<double> seconds;
    RenderWords words;
    std::string technique = "auto";
    std::vector<double> exponents;
    std::vector<std::uint64_t> debug_pixel;
    CheckpointOptions checkpoint;
    std::string shard;
    int layer_edges = 8;
    bool quiet = false;
};

// --shard I/N: the I-th of N nearly equal blocks of passes.
void choose_shard(RenderCommand& c) {
    if (c.shard.empty()) return;
    unsigned long long i = 0, n = 0;
    int read = 0;
    if (std::sscanf(c.shard.c_str(), "%llu/%llu%n", &i, &n, &read) != 2 ||
        static_cast<size_t>(read) != c.shard.size() || n == 0 || i >= n)
        usage("--shard: \"" + c.shard + "\" is not I/N with 0 <= I < N");
    if (!c.spp || c.seconds) usage("--shard: needs --spp for the whole render, and no --time");
    if (*c.spp < n) usage("--shard: fewer samples than shards");
    const std::uint64_t first = *c.spp * i / n, end = *c.spp * (i + 1) / n;
    c.renderer.first_pass = first;
    c.spp = end - first;
}

// Turns the words of the command line, and the session's where it names one, into settings.
void finish_command(RenderCommand& c) {
    choose_technique(c.technique, c.settings);
    if (!c.exponents.empty()) c.settings.exponents = c.exponents;
    finish_settings(c.words, c.settings);
    if (const auto session = take_session(*c.command, c.scene, c.quiet)) {
        take_settings(*c.command, session->settings, c.settings);
        if (!c.spp && !c.seconds) {
            c.spp = session->limits.spp;
            c.seconds = session->limits.seconds;
        }
    }
    choose_shard(c);
    if (c.checkpoint.resume && (c.outputs.strategies || c.outputs.stats))
        usage("--resume: strategy layers and statistics are not in a checkpoint");
    if (c.checkpoint.resume && !c.checkpoint.path) usage("--resume: needs --checkpoint FILE");
    if (c.outputs.strategies) c.renderer.layer_edges = c.layer_edges;
    c.renderer.statistics = c.outputs.stats.has_value();
}

int debug(const RenderCommand& c, const PreparedScene& p) {
    const Estimator e = make_estimator(*p.scene, p.camera, c.settings);
    const auto x = static_cast<int>(c.debug_pixel[0]), y = static_cast<int>(c.debug_pixel[1]);
    if (!e.crop.contains(x, y))
        throw std::invalid_argument(
            fmt::format("pixel outside of the image ({},{}); the image is {}x{}", x, y,
                        c.settings.width, c.settings.height));
    print_sample(inspect_sample({p.scene, p.camera, c.settings}, x, y, c.debug_pixel[2]));
    return exit_done;
}

void warn_of_gaps(const ProgressiveRenderer& r, const PreparedScene& p, Technique technique) {
    const Estimator& e = r.estimator();
    for (const std::string& what :
         not_covered(scene_features(*p.scene), e.families, e.direct_lamps))
        print_warnings({fmt::format("{} does not cover: {}", to_string(technique), what)});
}

// Strategies that were asked for and leave the image black.
void warn_of_absent(const ProgressiveRenderer& r, const PreparedScene& p,
                    const RenderSettings& settings) {
    for (const Strategy& k : settings.only)
        if (const std::string why =
                why_left_out(k, scene_features(*p.scene), r.estimator(), settings);
            !why.empty())
            print_warnings({fmt::format("--only {},{} adds nothing: {}", k.s, k.t, why)});
}

// Renders to the first limit that is met, an error among them; returns the seconds of rendering.
double render_watched(ProgressiveRenderer& r, const WaveLimits& all, ErrorWatch& watch,
                      const std::function<void(const WaveState&)>& progress) {
    double seconds = 0;
    const std::uint64_t first = r.passes();
    watch.take(r, seconds);
    while (!watch.reached() && !interrupted()) {
        WaveLimits limits = all;
        if (all.passes) *limits.passes -= r.passes() - first;
        if (limits.passes && *limits.passes == 0) break;
        if (all.seconds && r.passes() > first && seconds >= *all.seconds) break;
        if (all.seconds) *limits.seconds -= seconds;
        const double before = double(r.passes() - first);
        if (watch.wanted()) {
            const std::uint64_t next = watch.next(r) - r.passes();
            limits.passes = std::min(limits.passes.value_or(next), next);
        }
        const double so_far = seconds;
        seconds += render_in_waves(r, limits, interrupted, [&](WaveState w) {
            w.passes += before;
            if (watch.wanted()) {
                w.done = watch.share();
                if (all.passes) w.done = std::max(w.done, w.passes / double(*all.passes));
                if (all.seconds) w.done = std::max(w.done, so_far / *all.seconds);
            }
            progress(w);
        });
        watch.take(r, seconds);
    }
    return seconds;
}

RunFigures render_all(const RenderCommand& c, const PreparedScene& p, ProgressiveRenderer& r,
                      ErrorWatch& watch, const std::optional<PlanDecision>& decision) {
    Progress progress(c.quiet);
    Checkpoint checkpoint(c.checkpoint, p, c.settings);
    checkpoint.resume(r);
    if (decision && !c.quiet) fmt::print(stderr, "midway: auto: {}\n", describe(*decision));
    const std::clock_t cpu = std::clock();
    WaveLimits limits;
    limits.passes = c.spp;
    limits.seconds = c.seconds;
    if (!c.spp && !c.seconds && !c.errors.target) limits.passes = 128;
    if (limits.passes) *limits.passes -= std::min(*limits.passes, r.passes());
    const double seconds = render_watched(r, limits, watch, [&](const WaveState& w) {
        const RayCounts n = r.statistics().rays;
        progress.update({w.done, w.passes, n.closest + n.shadow});
        if (w.whole) checkpoint.write_if_due(r);
    });
    checkpoint.write(r);
    RunFigures figures;
    figures.decision = decision;
    figures.seconds_render = seconds;
    figures.cpu_seconds = double(std::clock() - cpu) / CLOCKS_PER_SEC;
    figures.interrupted = interrupted();
    return figures;
}

int run(RenderCommand& c) {
    if (c.outputs.images.empty() && c.debug_pixel.empty())
        usage("-o: name at least one output (.exr, .png or .film)");
    finish_command(c);
    check_outputs(c.outputs);
    check_error_options(c.errors, c.checkpoint.resume);
    ErrorWatch watch(c.errors, c.settings);
    const PreparedScene p = prepare_scene(c.scene);
    if (!c.quiet) print_warnings(p.warnings);
    const std::optional<PlanDecision> decision =
        choose_plan(*p.scene, p.camera, c.settings, c.renderer.threads);
    if (!c.debug_pixel.empty()) return debug(c, p);
    if (decision) watch.begin_at({decision->seconds, decision->cpu_seconds});
    ProgressiveRenderer r(p.scene, p.camera, c.settings, c.renderer);
    if (!c.quiet) {
        warn_of_gaps(r, p, c.settings.technique);
        warn_of_absent(r, p, c.settings);
    }
    catch_interrupt();
    const RunFigures figures = render_all(c, p, r, watch, decision);
    write_outputs(c.outputs, p, c.settings, r, figures);

    const RenderStatistics s = r.statistics();
    if (s.clamped > 0) print_warnings({fmt::format("{} contributions were clamped", s.clamped)});
    if (s.fixed.overflow > 0)
        print_warnings({fmt::format("{} contributions overflowed the film", s.fixed.overflow)});
    if (s.nonfinite.count > 0)
        print_warnings(
            {fmt::format("{} samples were not finite; see --debug-pixel {},{},{}",
                         s.nonfinite.count, s.nonfinite.x, s.nonfinite.y, s.nonfinite.pass)});
    if (figures.interrupted) return c.checkpoint.path ? exit_checkpointed : exit_interrupted;
    return s.nonfinite.count > 0 || s.fixed.overflow > 0 ? exit_nonfinite : exit_done;
}

// More samples than any film is good for.
constexpr std::uint64_t most_samples = std::uint64_t{1} << 40;

void add_image_options(CLI::App& sub, RenderCommand& c) {
    sub.add_option("-o,--output", c.outputs.images, "Image: .exr, .png or .film (repeatable)");
    sub.add_option("--exposure", c.outputs.exposure, "EV of PNG files, or auto");
    sub.add_option("--aov", c.outputs.aov, "EXR with albedo, normal, depth, object, variance");
    sub.add_option("--strategies", c.outputs.strategies, "EXR with a layer for every strategy");
    sub.add_option("--strategies-length", c.layer_edges, "Longest path in --strategies, edges")
        ->check(CLI::Range(1, 64));
    sub.add_option("--stats", c.outputs.stats, "Statistics as JSON");
    sub.add_option("--debug-pixel", c.debug_pixel, "X,Y,SAMPLE: print one sample")
        ->delimiter(',')
        ->expected(3);
}

void add_run_options(CLI::App& sub, RenderCommand& c) {
    sub.add_option("--spp", c.spp, "Samples per pixel")->check(whole_number(1, most_samples));
    sub.add_option("--time", c.seconds, "Seconds of rendering")->check(positive_number());
    add_threads_option(sub, c.renderer.threads);
    sub.add_option("--shard", c.shard, "I/N: render the I-th of N parts, for midway merge");
    sub.add_option("--checkpoint", c.checkpoint.path, "Film that the render can be resumed from");
    sub.add_option("--checkpoint-every", c.checkpoint.every_seconds, "Seconds between checkpoints")
        ->check(positive_number());
    sub.add_flag("--resume", c.checkpoint.resume, "Go on from --checkpoint where it exists");
}

}  // namespace

Command add_render_command(CLI::App& app) {
    auto c = std::make_shared<RenderCommand>();
    CLI::App& sub = *app.add_subcommand("render", "Render a scene to image files");
    c->command = &sub;
    add_scene_options(sub, c->scene);
    add_image_options(sub, *c);
    sub.add_option("--technique", c->technique, "path, light, bdpt, bdpt:EXPONENT or auto")
        ->capture_default_str();
    sub.add_option("--exponent", c->exponents, "Exponent of the MIS weights; a list: same paths")
        ->delimiter(',');
    add_settings_options(sub, c->settings, c->words);
    add_run_options(sub, *c);
    add_error_options(sub, c->errors);
    sub.add_flag("--quiet", c->quiet, "No progress, no warnings");
    return [c] { return run(*c); };
}

}  // namespace midway
