#include "outputs.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "image/file.h"
#include "image/png.h"
#include "render/aov.h"
#include "render/coverage.h"
#include "render/film_file.h"

namespace midway {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int aov_samples = 16;

std::string ending(const std::string& path) { return fs::path(path).extension().string(); }

void check_writable(const std::string& path) {
    fs::path folder = fs::path(path).parent_path();
    if (folder.empty()) folder = ".";
    if (!fs::is_directory(folder))
        throw std::runtime_error("no such folder (" + path + "); make it first");
    if (fs::is_directory(path))
        throw std::runtime_error("output is a folder (" + path + "); give a file name");
}

std::string numbered(const std::string& path, double exponent, size_t count) {
    if (count == 1) return path;
    const fs::path p(path);
    return (p.parent_path() / (p.stem().string() + fmt::format(".b{:g}", exponent) + p.extension().string()))
        .string();
}

float exposure_of(const std::string& text, const Image& image) {
    if (text == "auto") return auto_exposure(image);
    float ev = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ev);
    if (error != std::errc() || end != text.data() + text.size())
        throw std::runtime_error("not an exposure: \"" + text + "\" (--exposure); give EV or auto");
    return ev;
}

void write_aovs(const std::string& path, const ProgressiveRenderer& r, const Metadata& metadata) {
    const AovImages a = render_aovs(
        r.estimator(), static_cast<int>(std::min<std::uint64_t>(aov_samples, r.passes())),
        r.threads());
    write_exr(path,
              {{"", r.image()},
               {"albedo", a.albedo},
               {"normal", a.normal},
               {"depth", a.depth, true},
               {"object", a.object, true},
               {"variance", r.variance()}},
              metadata);
}

void write_strategies(const std::string& path, const ProgressiveRenderer& r,
                      const Metadata& metadata) {
    std::vector<ImageLayer> layers{{"", r.image()}};
    for (const ProgressiveRenderer::Layer& l : r.layers()) {
        const std::string name = fmt::format("s{}t{}", l.strategy.s, l.strategy.t);
        layers.push_back({name, resolve(l.films->weighted, r.counts())});
        layers.push_back({name + ".raw", resolve(l.films->bare, r.counts())});
    }
    write_exr(path, layers, metadata);
}

Json strategies_json(const RenderStatistics& s) {
    Json a = Json::array();
    for (const StrategyStatistics& k : s.strategies)
        a.push_back({{"s", k.strategy.s},
                     {"t", k.strategy.t},
                     {"samples", k.samples},
                     {"energy", k.energy},
                     {"second_moment", k.second_moment},
                     {"rays", k.rays}});
    return a;
}

void write_stats(const std::string& path, const PreparedScene& p, const RenderSettings& settings,
                 const ProgressiveRenderer& r, const RunFigures& figures) {
    const RenderStatistics s = r.statistics();
    const SceneFeatures features = scene_features(*p.scene);
    struct rusage usage {};
    getrusage(RUSAGE_SELF, &usage);
    Json j;
    j["scene"] = p.description.source;
    j["technique"] = to_string(settings.technique);
    if (settings.exponents.size() == 1)
        j["exponent"] = settings.exponents.front();
    else
        j["exponent"] = settings.exponents;
    j["families"] = to_string(r.estimator().families);
    j["size"] = {settings.width, settings.height};
    j["max_bounces"] = settings.max_bounces;
    j["seed"] = settings.seed;
    j["threads"] = r.threads();
    j["spp"] = r.passes();
    j["interrupted"] = figures.interrupted;
    j["seconds_load"] = p.seconds_load;
    j["seconds_build"] = p.seconds_build;
    j["seconds_render"] = figures.seconds_render;
    j["cpu_seconds"] = figures.cpu_seconds;
    j["paths_camera"] = s.rays.camera_paths;
    j["paths_light"] = s.rays.light_paths;
    j["rays_closest"] = s.rays.closest;
    j["rays_shadow"] = s.rays.shadow;
    j["peak_memory_bytes"] = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    j["nonfinite"] = s.nonfinite.count;
    j["nonfinite_first"] = nullptr;
    if (s.nonfinite.count > 0)
        j["nonfinite_first"] = {{"x", s.nonfinite.x}, {"y", s.nonfinite.y}, {"sample", s.nonfinite.pass}};
    j["film_inexact"] = s.fixed.inexact;
    j["film_overflow"] = s.fixed.overflow;
    j["clamped"] = s.clamped;
    j["strategies"] = strategies_json(s);
    j["left_out"] = Json::array();
    for (const FamilyNeed& need : family_needs(features))
        if (!need.needed) j["left_out"].push_back({{"what", need.family}, {"why", need.why}});
    j["not_covered"] = Json::array();
    for (const std::string& what :
         not_covered(features, r.estimator().families, r.estimator().direct_lamps))
        j["not_covered"].push_back({{"technique", to_string(settings.technique)}, {"what", what}});
    atomic_write(path, j.dump(2) + "\n");
}

}  // namespace

void check_outputs(const OutputOptions& o) {
    for (const std::string& path : o.images) {
        const std::string e = ending(path);
        if (e != ".exr" && e != ".png" && e != ".film")
            throw std::runtime_error("unknown kind of image (" + path + "); use .exr, .png or .film");
        check_writable(path);
    }
    for (const auto& path : {o.aov, o.strategies, o.stats})
        if (path) check_writable(*path);
    if (o.exposure != "auto") exposure_of(o.exposure, {});
}

Metadata image_metadata(const PreparedScene& p, const RenderSettings& settings,
                        const ProgressiveRenderer& r) {
    const RenderStatistics s = r.statistics();
    Metadata m{{"midway:version", MIDWAY_VERSION},
               {"midway:scene", p.description.source},
               {"midway:scene_hash", fmt::format("{:016x}", p.hash)},
               {"midway:settings", settings_json(settings)},
               {"midway:seed", std::to_string(settings.seed)},
               {"midway:spp", std::to_string(r.passes())}};
    if (s.clamped > 0) m["midway:clamped"] = std::to_string(s.clamped) + " contributions";
    return m;
}

void write_outputs(const OutputOptions& o, const PreparedScene& p, const RenderSettings& settings,
                   const ProgressiveRenderer& r, const RunFigures& figures) {
    const Metadata metadata = image_metadata(p, settings, r);
    const size_t n = settings.exponents.size();
    for (const std::string& path : o.images) {
        if (ending(path) == ".film") {
            write_film(path, film_header(p, settings, r), r);
            continue;
        }
        for (size_t i = 0; i < n; ++i) {
            const std::string name = numbered(path, settings.exponents[i], n);
            const Image image = r.image(static_cast<int>(i));
            Metadata m = metadata;
            m["midway:exponent"] = fmt::format("{:g}", settings.exponents[i]);
            if (ending(path) == ".exr")
                write_exr(name, {{"", image}}, m);
            else
                write_png(name, image, {exposure_of(o.exposure, image), Curve::srgb});
        }
    }
    if (o.aov) write_aovs(*o.aov, r, metadata);
    if (o.strategies) write_strategies(*o.strategies, r, metadata);
    if (o.stats) write_stats(*o.stats, p, settings, r, figures);
}

}  // namespace midway
