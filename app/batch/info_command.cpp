// midway info: what is in a scene, and what each technique makes of it.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "info_cost.h"
#include "render/coverage.h"
#include "render/json_text.h"
#include "render/leave_outs.h"
#include "render_options.h"
#include "session_options.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;

std::string_view kind_name(LightKind k) {
    switch (k) {
        case LightKind::point:
            return "point";
        case LightKind::spot:
            return "spot";
        case LightKind::directional:
            return "directional";
        case LightKind::area:
            return "area";
        case LightKind::sky:
            return "sky";
    }
    return "";
}

Json describe_lights(const Scene& s) {
    std::map<std::string_view, std::pair<int, double>> kinds;
    for (const Light& l : s.lights) {
        auto& [count, power] = kinds[kind_name(l.kind)];
        ++count;
        power += l.power;
    }
    Json lights = Json::array();
    for (const auto& [kind, entry] : kinds)
        lights.push_back({{"kind", kind},
                          {"count", entry.first},
                          {"power_share", s.total_power > 0 ? entry.second / s.total_power : 0.0}});
    return lights;
}

Json describe_scene(const PreparedScene& p) {
    const SceneDescription& d = p.description;
    const SceneFeatures f = scene_features(*p.scene);
    const Normalisation& n = p.scene->geometry->normalisation;
    Json j;
    j["scene"] = d.source;
    j["generator"] = d.generator;
    j["hash"] = fmt::format("{:016x}", p.hash);
    j["triangles"] = p.scene->geometry->triangle_count;
    j["objects"] = p.scene->geometry->objects.size();
    j["materials"] = d.materials.size();
    j["textures"] = d.images.size();
    j["radius"] = p.scene->geometry->radius / n.scale;
    j["cameras"] = Json::array();
    for (const CameraDescription& c : d.cameras) j["cameras"].push_back(c.name);
    j["lights"] = describe_lights(*p.scene);
    if (d.sky) j["sky"] = d.sky->source;
    j["edits"] = edits_in_words(p.options.edits);
    j["surfaces"] = {{"rough", f.rough}, {"smooth", f.smooth}, {"transparent", f.transparent}};
    j["families"] = Json::array();
    for (const FamilyNeed& need : family_needs(f))
        j["families"].push_back(
            {{"family", need.family}, {"needed", need.needed}, {"why", need.why}});
    j["left_out"] = Json::array();
    for (const LeaveOut& line : leave_outs(*p.scene))
        j["left_out"].push_back({{"what", line.what}, {"why", line.why}});
    j["not_covered"] = Json::array();
    for (const Technique t : {Technique::path, Technique::light, Technique::bdpt})
        for (const std::string& what : not_covered(f, families_of(t), t == Technique::light))
            j["not_covered"].push_back({{"technique", to_string(t)}, {"what", what}});
    j["warnings"] = p.warnings;
    return j;
}

void print_text(const Json& j) {
    fmt::print("{}\n  {} triangles in {} objects, {} materials, {} textures, radius {:.6g}\n",
               j["scene"].get<std::string>(), j["triangles"].get<size_t>(),
               j["objects"].get<size_t>(), j["materials"].get<size_t>(),
               j["textures"].get<size_t>(), j["radius"].get<double>());
    for (const Json& c : j["cameras"]) fmt::print("  camera \"{}\"\n", c.get<std::string>());
    for (const Json& l : j["lights"])
        fmt::print("  {} {} light{}: {:.1f} % of the power\n", l["count"].get<int>(),
                   l["kind"].get<std::string>(), l["count"].get<int>() == 1 ? "" : "s",
                   100 * l["power_share"].get<double>());
    if (j.contains("sky")) fmt::print("  sky: {}\n", j["sky"].get<std::string>());
    for (const Json& e : j["edits"]) fmt::print("  edited: {}\n", e.get<std::string>());
    for (const Json& f : j["families"])
        if (f["needed"].get<bool>())
            fmt::print("  used: {}: {}\n", f["family"].get<std::string>(),
                       f["why"].get<std::string>());
    for (const Json& l : j["left_out"])
        fmt::print("  left out: {}: {}\n", l["what"].get<std::string>(),
                   l["why"].get<std::string>());
    for (const Json& n : j["not_covered"])
        fmt::print("  {} does not cover: {}\n", n["technique"].get<std::string>(),
                   n["what"].get<std::string>());
}

}  // namespace

Command add_info_command(CLI::App& app) {
    auto options = std::make_shared<SceneOptions>();
    auto json = std::make_shared<bool>(false);
    auto cost = std::make_shared<bool>(false);
    auto job = std::make_shared<CostJob>();
    CLI::App& sub = *app.add_subcommand("info", "What is in a scene, and what it needs");
    add_scene_options(sub, *options);
    sub.add_flag("--json", *json, "Print JSON");
    CLI::Option* wanted =
        sub.add_flag("--cost", *cost, "Measure what each leave-out saves; up to a minute");
    add_threads_option(sub, job->options.threads);
    sub.add_option("--rounds", job->options.rounds, "Rounds of each measurement, in turns")
        ->capture_default_str()
        ->check(CLI::Range(2, 1000))
        ->needs(wanted);
    return [options, json, cost, job, &sub] {
        take_session(sub, *options, *json);
        const PreparedScene p = prepare_scene(*options);
        Json j = describe_scene(p);
        job->quiet = *json;
        if (*cost) j.update(cost_json(p, *job));
        if (*json) {
            fmt::print("{}\n", json_text(j));
        } else {
            print_warnings(p.warnings);
            print_text(j);
            if (*cost) print_cost(j);
        }
        return static_cast<int>(exit_done);
    };
}

}  // namespace midway
