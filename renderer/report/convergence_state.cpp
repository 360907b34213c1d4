#include "report/convergence_state.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "image/file.h"
#include "render/film_file.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;

// A number that is not finite has no form in JSON and is kept as null.
double number(const Json& j) { return j.is_null() ? unknown_number : j.get<double>(); }

Json point_json(const ErrorPoint& p) {
    Json j = {p.seconds, p.cpu_seconds,    p.spp,   p.mse,  p.rmse,
              p.relmse,  p.relmse_trimmed, p.smape, p.bias, p.bias_z};
    j.push_back(p.flip ? Json(*p.flip) : Json());
    return j;
}

ErrorPoint parse_point(const Json& j) {
    ErrorPoint p;
    p.spp = j.at(2);
    double* const values[] = {&p.seconds, &p.cpu_seconds,    nullptr,  &p.mse,  &p.rmse,
                              &p.relmse,  &p.relmse_trimmed, &p.smape, &p.bias, &p.bias_z};
    for (size_t i = 0; i < std::size(values); ++i)
        if (values[i]) *values[i] = number(j.at(i));
    if (!j.at(10).is_null()) p.flip = j.at(10).get<double>();
    return p;
}

}  // namespace

std::string processor_name() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name") && line.find(':') + 2 < line.size())
            return line.substr(line.find(':') + 2);
    return "unknown";
}

std::string curve_key(const ConvergencePlan& plan, const RenderSettings& settings) {
    const int threads =
        plan.threads > 0 ? plan.threads : int(std::max(1u, std::thread::hardware_concurrency()));
    Json j;
    j["scene"] = plan.scene->hash;
    j["settings"] = settings_json(settings);
    j["reference"] = reference_hash(*plan.reference);
    j["version"] = MIDWAY_VERSION;
    j["instruction_set"] = MIDWAY_ARCH;
    j["processor"] = processor_name();
    j["threads"] = threads;
    return j.dump();
}

std::string curve_path(const ConvergencePlan& plan, const std::string& label, std::uint64_t seed) {
    return (std::filesystem::path(plan.folder) /
            (file_label(label) + "-seed" + std::to_string(seed)))
        .string();
}

KeptCurve read_curve(const std::string& path, const std::string& key, CurveRun& run) {
    std::ifstream in(path + ".json", std::ios::binary);
    if (!in) return KeptCurve::none;
    try {
        const Json j = Json::parse(in);
        if (j.at("key") != key || !std::filesystem::exists(path + ".film")) return KeptCurve::stale;
        CurveRun r;
        r.curve.seed = j.at("seed");
        for (const Json& p : j.at("points")) r.curve.points.push_back(parse_point(p));
        r.luminance_a = number(j.at("luminance_a"));
        r.luminance_b = number(j.at("luminance_b"));
        r.seconds = j.at("seconds");
        r.cpu_seconds = j.at("cpu_seconds");
        r.metric_seconds = j.at("metric_seconds");
        r.nonfinite = j.at("nonfinite");
        r.passes = pass_counts(0, j.at("passes").get<std::uint64_t>());
        run = std::move(r);
        return KeptCurve::usable;
    } catch (const Json::exception&) {
        return KeptCurve::stale;
    }
}

void write_curve(const std::string& path, const std::string& key, const CurveRun& r) {
    Json j;
    j["key"] = key;
    j["seed"] = r.curve.seed;
    j["passes"] = r.passes.total();
    j["seconds"] = r.seconds;
    j["cpu_seconds"] = r.cpu_seconds;
    j["metric_seconds"] = r.metric_seconds;
    j["luminance_a"] = r.luminance_a;
    j["luminance_b"] = r.luminance_b;
    j["nonfinite"] = r.nonfinite;
    j["points"] = Json::array();
    for (const ErrorPoint& p : r.curve.points) j["points"].push_back(point_json(p));
    atomic_write(path + ".json", j.dump() + "\n");
}

}  // namespace midway
