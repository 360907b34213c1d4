// midway compare: the error of techniques against render time.
#include <filesystem>

#include "commands.h"
#include "compare.h"
#include "interrupt.h"
#include "session_options.h"

namespace midway {
namespace {

int run(CompareCommand& c, const CLI::App& options) {
    finish_settings(c.words, c.settings);
    if (c.suite.has_value() == !c.scene.path.empty())
        usage("compare: give a scene or --suite FILE.json, and not both");
    if (c.reference && c.reference_seconds)
        usage("--reference-time: the reference is given and not rendered");
    if (c.suite && c.reference) usage("--reference: a suite renders a reference for each scene");
    catch_interrupt();
    if (c.suite) {
        for (const char* own : {"--sky", "--sky-rotation", "--sky-strength", "--lamp-strength",
                                "--camera", "--look-at", "--fov", "--aperture", "--focus"})
            if (options.count(own) > 0)
                usage(std::string(own) + ": the scenes of a suite have their own (" + *c.suite +
                      ")");
        return run_suite(c, options);
    }
    const std::string name = std::filesystem::path(c.scene.path).stem().string();
    if (const auto session = take_session(options, c.scene, c.quiet)) {
        // What belongs to a technique is the comparison's own.
        RenderSettings s = session->settings;
        s.families = c.settings.families;
        s.clamp = c.settings.clamp;
        s.only = c.settings.only;
        s.unweighted = c.settings.unweighted;
        take_settings(options, s, c.settings);
    }
    ComparePlan plan = make_compare_plan(c, name.empty() ? "scene" : name, c.folder);
    make_folder(c.folder);
    CompareProgress progress(c.quiet, planned_seconds(plan));
    std::optional<Comparison> result = run_compare_scene(plan, c.scene, progress, c.quiet);
    if (!result) {
        print_warnings(
            {"stopped before the first curve; the same command goes on (" + c.folder + ")"});
        return exit_interrupted;
    }
    const bool complete = result->complete;
    return compare_status({std::move(*result)}, complete);
}

}  // namespace

Command add_compare_command(CLI::App& app, const std::string& typed) {
    auto c = std::make_shared<CompareCommand>();
    c->typed = typed;
    CLI::App& sub = *app.add_subcommand(
        "compare", "Error against run time of several techniques, with a report");
    add_scene_options(sub, c->scene);
    sub.get_option("scene")->required(false);
    sub.add_option("--suite", c->suite, "Scenes and defaults from a file, as assets/suite.json");
    sub.add_option("-o,--output", c->folder, "Folder of the report")->required();
    sub.add_option("--time", c->seconds, "Seconds of rendering, per technique and seed")
        ->check(positive_number());
    sub.add_option("--techniques", c->techniques, "Of path, light, bdpt, bdpt:EXPONENT, auto")
        ->delimiter(',')
        ->capture_default_str();
    sub.add_option("--seeds", c->seeds, "Independent runs of each technique: they give the bands")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    sub.add_option("--reference", c->reference,
                   "EXR, HDR or .film; an EXR's layer \"variance\" tells its own error");
    sub.add_option("--reference-time", c->reference_seconds,
                   "Seconds for a reference that is rendered (16 x --time)")
        ->check(positive_number());
    sub.add_option("--references", c->references,
                   "Folder of the references that were rendered (references, in the report's)");
    add_settings_options(sub, c->settings, c->words);
    add_threads_option(sub, c->threads);
    sub.add_flag("--quiet", c->quiet, "No progress, no warnings");
    return [c, &sub] { return run(*c, sub); };
}

}  // namespace midway
