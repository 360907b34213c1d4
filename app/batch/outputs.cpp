#include "outputs.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "image/png.h"
#include "render/aov.h"
#include "render/film_file.h"

namespace midway {
namespace {

namespace fs = std::filesystem;

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
    return (p.parent_path() /
            (p.stem().string() + fmt::format(".b{:g}", exponent) + p.extension().string()))
        .string();
}

float exposure_of(const std::string& text, const Image& image) {
    if (text == "auto") return auto_exposure(image);
    float ev = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), ev);
    if (error != std::errc() || end != text.data() + text.size())
        throw std::invalid_argument("not an exposure: \"" + text +
                                    "\" (--exposure); give EV or auto");
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

}  // namespace

void check_outputs(const OutputOptions& o) {
    for (const std::string& path : o.images) {
        const std::string e = ending(path);
        if (e != ".exr" && e != ".png" && e != ".film")
            throw std::invalid_argument("unknown kind of image (" + path +
                                        "); use .exr, .png or .film");
        check_writable(path);
    }
    for (const auto& path : {o.aov, o.strategies, o.stats})
        if (path) check_writable(*path);
    if (o.exposure != "auto") exposure_of(o.exposure, {});
}

void write_image(const std::string& path, const OutputOptions& o, const Image& image,
                 const std::vector<double>& exponents, size_t index, Metadata metadata) {
    const std::string name = numbered(path, exponents[index], exponents.size());
    set_exponent(metadata, exponents[index]);
    if (ending(path) == ".exr")
        write_exr(name, {{"", image}}, metadata);
    else
        write_png(name, image, {exposure_of(o.exposure, image), Curve::srgb});
}

void write_outputs(const OutputOptions& o, const PreparedScene& p, const RenderSettings& settings,
                   const ProgressiveRenderer& r, const RunFigures& figures) {
    const Metadata metadata = image_metadata(p, settings, r.passes(), r.statistics().clamped);
    for (const std::string& path : o.images) {
        if (ending(path) == ".film") {
            write_film(path, film_header(p, settings, r), r);
            continue;
        }
        for (size_t i = 0; i < settings.exponents.size(); ++i)
            write_image(path, o, r.image(static_cast<int>(i)), settings.exponents, i, metadata);
    }
    // Of a list of exponents these show the first.
    Metadata of_first = metadata;
    set_exponent(of_first, settings.exponents.front());
    if (o.aov) write_aovs(*o.aov, r, of_first);
    if (o.strategies) write_strategies(*o.strategies, r, of_first);
    if (o.stats) write_stats(*o.stats, p, settings, r, figures);
}

}  // namespace midway
