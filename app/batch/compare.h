// What the parts of `midway compare` share: the wishes of the command line, and one scene's run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "progress.h"
#include "render_options.h"
#include "report/comparison_run.h"

namespace midway {

struct CompareCommand {
    SceneOptions scene;
    RenderSettings settings;
    RenderWords words;
    std::vector<std::string> techniques{"path", "light", "bdpt:0", "bdpt:1", "bdpt:2", "auto"};
    std::optional<double> seconds;
    int seeds = 4, threads = 0;
    std::optional<std::string> reference, references, suite;
    std::optional<double> reference_seconds;
    std::string folder;
    std::string typed;  // the whole command, to make it again
    bool quiet = false;
};

// Throws std::runtime_error, with one line, where it cannot be made.
void make_folder(const std::string& folder);

// The plan of one scene, which is not loaded yet. `folder` is the scene's own.
ComparePlan make_compare_plan(const CompareCommand& command, const std::string& name,
                              const std::string& folder);

// Progress over all scenes of a run: seconds of rendering done of those that are planned.
class CompareProgress {
  public:
    CompareProgress(bool quiet, double planned) : progress_(quiet), planned_(planned) {}

    // For the scene of this name; ends when Ctrl-C is pressed.
    CompareHooks hooks(const std::string& scene);

  private:
    void show(const std::string& doing);

    Progress progress_;
    double planned_, done_ = 0;
};

// Loads and compares one scene, and writes all its files; empty where it was stopped before the
// first curve.
std::optional<Comparison> run_compare_scene(ComparePlan plan, const SceneOptions& scene,
                                            CompareProgress& progress, bool quiet);

// 3 where samples were not finite, 130 where it was stopped, else 0.
int compare_status(const std::vector<Comparison>& scenes, bool complete);

// Every scene of the file command.suite; `options` tells what was typed, which comes before what
// the file says.
int run_suite(CompareCommand command, const CLI::App& options);

}  // namespace midway
