#include "report/summary.h"

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "image/file.h"
#include "render/json_text.h"
#include "report/convergence.h"
#include "report/error_log.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json interval_json(const Interval& i) {
    return {{"value", i.value}, {"lower", i.lower}, {"upper", i.upper}};
}

Json machine_json(const Machine& m) {
    return {{"cpu", m.cpu},
            {"threads", m.threads},
            {"version", m.version},
            {"instruction_set", m.instruction_set},
            {"compiler", m.compiler}};
}

Json point_json(const ErrorPoint& p) {
    Json j = {{"seconds", p.seconds}, {"cpu_seconds", p.cpu_seconds},
              {"spp", p.spp},         {"mse", p.mse},
              {"rmse", p.rmse},       {"relmse", p.relmse},
              {"smape", p.smape},     {"relmse_trimmed", p.relmse_trimmed},
              {"bias", p.bias},       {"bias_z", p.bias_z}};
    if (p.flip) j["flip"] = *p.flip;
    return j;
}

Json band_json(const std::vector<BandPoint>& band) {
    Json j = Json::array();
    for (const BandPoint& p : band)
        j.push_back({{"seconds", p.seconds},
                     {"spp", p.spp},
                     {"relmse", interval_json(p.relmse)},
                     {"relmse_trimmed", interval_json(p.relmse_trimmed)}});
    return j;
}

Json technique_json(const TechniqueResult& t) {
    Json j;
    j["technique"] = t.name;
    j["exponent"] = t.exponent;
    j["label"] = t.label;
    j["not_covered"] = t.not_covered;
    j["left_out"] = t.left_out;
    j["seeds"] = Json::array();
    for (const ErrorCurve& c : t.curves)
        j["seeds"].push_back({{"seed", c.seed}, {"complete", c.complete}});
    j["final"] = point_json(t.final_mean);
    j["slope"] = interval_json(t.fit.slope);
    j["slope_spp"] = interval_json(t.fit.slope_spp);
    j["slope_points"] = t.fit.points;
    j["time_to"] = Json::array();
    for (const TimeTo& e : t.time_to)
        j["time_to"].push_back({{"relmse", e.relmse},
                                {"seconds", e.seconds ? Json(*e.seconds) : Json("not reached")},
                                {"at_most", e.at_most}});
    if (t.efficiency) j["efficiency"] = interval_json(*t.efficiency);
    if (t.efficiency_trimmed) j["efficiency_trimmed"] = interval_json(*t.efficiency_trimmed);
    j["bias"] = {{"relative", interval_json(t.bias.bias)},
                 {"z", t.bias.z},
                 {"limit", t.bias.limit},
                 {"flagged", t.bias.flagged},
                 {"expected", t.bias.expected},
                 {"text", t.bias.text}};
    j["nonfinite"] = t.nonfinite;
    j["band"] = band_json(t.band);
    return j;
}

Metadata image_metadata(const Comparison& c, const std::string& technique, std::uint64_t spp) {
    Metadata m{{"midway:version", c.machine.version},
               {"midway:scene", c.scene},
               {"midway:technique", technique},
               {"midway:spp", std::to_string(spp)},
               {"midway:command", c.command}};
    for (const NamedValue& s : c.settings) m["midway:setting:" + s.name] = s.value;
    return m;
}

void write_images(const Comparison& c, const fs::path& folder) {
    fs::create_directories(folder);
    std::vector<ImageLayer> layers{{"", c.reference.image}};
    if (c.reference.variance) layers.push_back({"variance", *c.reference.variance});
    write_exr((folder / "reference.exr").string(), layers,
              image_metadata(c, c.reference.technique, c.reference.spp));
    for (const TechniqueResult& t : c.techniques) {
        if (t.image.pixels.empty()) continue;
        Metadata m = image_metadata(c, t.label, t.image_spp);
        m["midway:seed"] = std::to_string(t.image_seed);
        write_exr((folder / (file_label(t.label) + ".exr")).string(), {{"", t.image}}, m);
    }
}

}  // namespace

std::string convergence_csv(const Comparison& c) {
    std::string text = error_csv_header();
    for (const TechniqueResult& t : c.techniques)
        for (const ErrorCurve& curve : t.curves)
            for (const ErrorPoint& p : curve.points)
                text += error_csv_row(t.name, t.exponent, curve.seed, p);
    return text;
}

std::string summary_json(const Comparison& c) {
    Json j;
    j["name"] = c.name;
    j["scene"] = c.scene;
    j["command"] = c.command;
    j["complete"] = c.complete;
    j["time"] = c.time;
    j["seeds"] = c.seeds;
    j["metric_seconds"] = c.metric_seconds;
    for (const NamedValue& s : c.settings) j["settings"][s.name] = s.value;
    j["machine"] = machine_json(c.machine);
    const ReferenceInfo& r = c.reference;
    j["reference"] = {{"source", r.source},
                      {"technique", r.technique},
                      {"spp", r.spp},
                      {"seconds", r.seconds},
                      {"floor_mse", r.floor_mse},
                      {"floor_relmse", r.floor_relmse},
                      {"floor_relmse_trimmed", r.floor_relmse_trimmed},
                      {"why", r.why}};
    j["left_out"] = c.left_out;
    j["warnings"] = c.warnings;
    j["formula"] = c.formula;
    j["method"] = c.method;
    j["techniques"] = Json::array();
    for (const TechniqueResult& t : c.techniques) j["techniques"].push_back(technique_json(t));
    return json_text(j) + "\n";
}

void write_comparison(const Comparison& c, const std::string& directory) {
    const fs::path folder(directory);
    fs::create_directories(folder);
    write_images(c, folder / "images");
    atomic_write((folder / "convergence.csv").string(), convergence_csv(c));
    atomic_write((folder / "summary.json").string(), summary_json(c));
}

}  // namespace midway
