#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "commands.h"
#include "compare.h"
#include "image/file.h"
#include "interrupt.h"
#include "report/html_report.h"
#include "report/summary.h"

namespace midway {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

struct SuiteScene {
    std::string name;
    SceneOptions options;
};

struct Suite {
    Json defaults;  // of the command's options
    std::vector<SuiteScene> scenes;
};

[[noreturn]] void refuse(const std::string& what, const std::string& path) {
    throw std::runtime_error("broken suite: " + one_line(what) + " (" + one_line(path) +
                             "); assets/suite.json shows what one holds");
}

// A scene's name becomes a folder.
void check_name(const std::string& name, std::set<std::string>& seen, const std::string& path) {
    const bool usable = !name.empty() && name.size() <= 100 && name[0] != '.' &&
                        name.find_first_not_of(
                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") ==
                            std::string::npos;
    if (!usable) refuse("\"" + name + "\" is no name for a folder", path);
    for (const char* taken : {"references", "index.html", "summary.json", "table.md"})
        if (name == taken) refuse("a scene cannot be called \"" + name + "\"", path);
    if (!seen.insert(name).second) refuse("two scenes are called \"" + name + "\"", path);
}

// Names of files are relative to the suite's own.
std::string beside(const std::string& suite, const std::string& file) {
    return (fs::path(suite).parent_path() / file).string();
}

SceneOptions parse_scene(const Json& j, const std::string& path) {
    SceneOptions o;
    for (const auto& [key, value] : j.items()) {
        if (key == "name") continue;
        if (key == "scene") {
            o.path = beside(path, value);
        } else if (key == "sky") {
            const std::string sky = value;
            const bool file = sky.ends_with(".hdr") || sky.ends_with(".exr");
            o.sky = file ? beside(path, sky) : sky;
        } else if (key == "sky_rotation") {
            o.sky_rotation_degrees = value;
        } else if (key == "sky_strength") {
            o.sky_strength = value;
        } else if (key == "lamp_strength") {
            o.lamp_strength = value;
        } else if (key == "camera") {
            o.camera = value.get<std::string>();
        } else {
            refuse("\"" + key + "\" is nothing that a scene can have", path);
        }
    }
    if (o.path.empty()) refuse("a scene names no file", path);
    if (o.path.ends_with(".midway"))
        refuse("a session is no scene of a suite: name the glTF file, with its options", path);
    if (!fs::exists(o.path))
        throw std::runtime_error("no such scene (" + o.path + "); correct " + path);
    return o;
}

Suite read_suite(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot open suite (" + path + "); check the name");
    Suite s;
    std::set<std::string> seen;
    try {
        Json j = Json::parse(in);
        for (const Json& scene : j.at("scenes")) {
            check_name(scene.at("name"), seen, path);
            s.scenes.push_back({scene.at("name"), parse_scene(scene, path)});
        }
        j.erase("scenes");
        s.defaults = std::move(j);
    } catch (const Json::exception& e) {
        refuse(e.what(), path);
    }
    if (s.scenes.empty()) refuse("it lists no scene", path);
    return s;
}

// What the file says where nothing was typed.
void apply_defaults(const Suite& suite, const CLI::App& options, CompareCommand& c) {
    for (const auto& [key, value] : suite.defaults.items()) {
        const std::string option = "--" + key;
        const CLI::Option* o = options.get_option_no_throw(option);
        if (!o) refuse("\"" + key + "\" is no option", *c.suite);
        if (o->count() > 0) continue;
        try {
            if (key == "time")
                c.seconds = value.get<double>();
            else if (key == "seeds")
                c.seeds = value.get<int>();
            else if (key == "size")
                parse_size(value.get<std::string>(), c.settings);
            else if (key == "techniques")
                c.techniques = value.get<std::vector<std::string>>();
            else if (key == "max-bounces")
                c.settings.max_bounces = value.get<int>();
            else if (key == "reference-time")
                c.reference_seconds = value.get<double>();
            else
                refuse("\"" + key + "\" cannot be set by a suite", *c.suite);
        } catch (const Json::exception& e) {
            refuse(e.what(), *c.suite);
        }
    }
    if (c.seconds && !(*c.seconds > 0)) refuse("the time is not above 0", *c.suite);
    if (c.reference_seconds && !(*c.reference_seconds > 0))
        refuse("the reference's time is not above 0", *c.suite);
    if (c.seeds < 1 || c.seeds > 1000) refuse("seeds are not 1 to 1000", *c.suite);
}

}  // namespace

int run_suite(CompareCommand c, const CLI::App& options) {
    const auto start = std::chrono::steady_clock::now();
    const Suite suite = read_suite(*c.suite);
    apply_defaults(suite, options, c);
    std::vector<ComparePlan> plans;
    double planned = 0;
    for (const SuiteScene& s : suite.scenes) {
        plans.push_back(make_compare_plan(c, s.name, (fs::path(c.folder) / s.name).string()));
        plans.back().bias_comparisons =
            std::int64_t(suite.scenes.size() * plans.back().techniques.size());
        planned += planned_seconds(plans.back());
    }
    make_folder(c.folder);
    SuiteReport report;
    report.name = fs::path(*c.suite).stem().string();
    report.command = c.typed;
    report.machine = this_machine(c.threads);
    report.scenes_planned = suite.scenes.size();
    report.complete = true;
    CompareProgress progress(c.quiet, planned);
    for (size_t i = 0; i < plans.size() && report.complete; ++i) {
        std::optional<Comparison> scene =
            run_compare_scene(plans[i], suite.scenes[i].options, progress, c.quiet);
        report.complete = scene && scene->complete;
        // Stopped before it had anything: what an earlier run has written stays.
        if (!scene) break;
        report.scenes.push_back(std::move(*scene));
        report.seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        write_suite(report, c.folder);
        write_suite_index(report, c.folder);
    }
    return compare_status(report.scenes, report.complete);
}

}  // namespace midway
