#include "render/film_file.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "image/file.h"
#include "math/hash.h"
#include "render/json_text.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view magic = "MIDWAYFILM 1\n";
constexpr std::uint64_t longest_header = 1 << 20;
constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

[[noreturn]] void refuse(const std::string& what, const std::string& path) {
    throw std::runtime_error(what + " (" + path + "); render it again");
}

std::string header_json(const FilmHeader& h) {
    Json j;
    j["scene"] = h.scene;
    j["scene_hash"] = h.scene_hash;
    j["settings"] = h.settings;
    j["version"] = h.version;
    j["instruction_set"] = h.instruction_set;
    j["exponents"] = h.exponents;
    j["width"] = h.width;
    j["height"] = h.height;
    j["unit_exponent"] = h.unit_exponent;
    j["passes"] = Json::array();
    for (const PassRange& r : h.passes) j["passes"].push_back({r.first, r.end});
    return json_text(j, -1);
}

FilmHeader parse_header(const std::string& text, const std::string& path) {
    FilmHeader h;
    try {
        const Json j = Json::parse(text);
        h.scene = j.at("scene");
        h.scene_hash = j.at("scene_hash");
        h.settings = j.at("settings");
        h.version = j.at("version");
        h.instruction_set = j.at("instruction_set");
        h.exponents = j.at("exponents").get<std::vector<double>>();
        h.width = j.at("width");
        h.height = j.at("height");
        h.unit_exponent = j.at("unit_exponent");
        for (const Json& r : j.at("passes")) h.passes.push_back({r.at(0), r.at(1)});
    } catch (const Json::exception&) {
        refuse("broken film header", path);
    }
    const bool size_ok = h.width > 0 && h.height > 0 && h.width <= 65536 && h.height <= 65536 &&
                         std::int64_t{h.width} * h.height <= most_pixels;
    const bool exponents_ok = !h.exponents.empty() && h.exponents.size() <= max_exponents;
    bool passes_ok = !h.passes.empty();
    for (size_t i = 0; i < h.passes.size(); ++i)
        passes_ok &= h.passes[i].first < h.passes[i].end &&
                     (i == 0 || h.passes[i - 1].end <= h.passes[i].first);
    if (!size_ok || !exponents_ok || !passes_ok || std::abs(h.unit_exponent) > 4000)
        refuse("impossible film header", path);
    return h;
}

void write(const std::string& path, const FilmHeader& header,
           const std::vector<const Film*>& films) {
    const std::string text = header_json(header);
    atomic_write(path, [&](std::ofstream& out) {
        const std::uint64_t length = text.size();
        std::uint64_t hash = hash_bytes(0, text.data(), text.size());
        out.write(magic.data(), magic.size());
        out.write(reinterpret_cast<const char*>(&length), sizeof length);
        out.write(text.data(), static_cast<std::streamsize>(text.size()));
        for (const Film* f : films) {
            const size_t bytes = f->words().size() * 8;
            hash = hash_bytes(hash, f->words().data(), bytes);
            out.write(reinterpret_cast<const char*>(f->words().data()),
                      static_cast<std::streamsize>(bytes));
        }
        out.write(reinterpret_cast<const char*>(&hash), sizeof hash);
    });
}

void read_exactly(std::ifstream& in, void* to, std::uint64_t n, const std::string& path) {
    in.read(static_cast<char*>(to), static_cast<std::streamsize>(n));
    if (static_cast<std::uint64_t>(in.gcount()) != n) refuse("truncated film", path);
}

std::uint64_t bytes_left(std::ifstream& in) {
    const auto here = in.tellg();
    in.seekg(0, std::ios::end);
    const auto end = in.tellg();
    in.seekg(here);
    return static_cast<std::uint64_t>(end - here);
}

// Of the sums: two words for each half and channel of a pixel, for every exponent.
std::uint64_t film_bytes(const FilmHeader& h) {
    return std::uint64_t(h.width) * std::uint64_t(h.height) * 12 * 8 * h.exponents.size();
}

}  // namespace

std::string settings_json(const RenderSettings& s) {
    Json j;
    j["technique"] = to_string(s.technique);
    j["exponents"] = s.exponents;
    j["families"] = to_string(s.families.value_or(Families{}));
    if (s.plan)
        j["plan"] = {{"families", to_string(s.plan->families)},
                     {"light_subpaths_per_pixel", s.plan->light_quarters / 4.0},
                     {"splats_direct_light", s.plan->splats_direct},
                     {"direct_light_samples", s.plan->direct_samples}};
    j["width"] = s.width;
    j["height"] = s.height;
    if (s.crop) j["crop"] = {s.crop->x0, s.crop->y0, s.crop->x1, s.crop->y1};
    j["max_bounces"] = s.max_bounces;
    j["seed"] = s.seed;
    j["sampler"] = to_string(s.sampler);
    j["filter"] = to_string(s.filter);
    if (s.clamp) j["clamp"] = *s.clamp;
    if (s.unweighted) j["unweighted"] = true;
    for (const Strategy& k : s.only) j["only"].push_back({k.s, k.t});
    return j.dump();
}

FilmHeader film_header(const PreparedScene& p, const RenderSettings& settings,
                       const ProgressiveRenderer& r) {
    FilmHeader h;
    h.scene = p.description.source;
    h.settings = settings_json(settings);
    h.version = MIDWAY_VERSION;
    h.instruction_set = MIDWAY_ARCH;
    h.scene_hash = p.hash;
    h.passes = {{r.first_pass(), r.first_pass() + r.passes()}};
    h.exponents = settings.exponents;
    h.width = r.film().width();
    h.height = r.film().height();
    h.unit_exponent = r.film().unit_exponent();
    return h;
}

void write_film(const std::string& path, const FilmFile& file) {
    std::vector<const Film*> films;
    for (const Film& f : file.films) films.push_back(&f);
    write(path, file.header, films);
}

void write_film(const std::string& path, const FilmHeader& header, const ProgressiveRenderer& r) {
    std::vector<const Film*> films;
    for (size_t i = 0; i < header.exponents.size(); ++i)
        films.push_back(&r.film(static_cast<int>(i)));
    write(path, header, films);
}

FilmFile read_film(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot open film (" + path + "); check the name");
    std::string start(magic.size(), '\0');
    read_exactly(in, start.data(), start.size(), path);
    if (start != magic) throw std::runtime_error("not a film (" + path + "); give a .film file");
    std::uint64_t length = 0;
    read_exactly(in, &length, sizeof length, path);
    if (length > longest_header) refuse("broken film header", path);
    std::string text(length, '\0');
    read_exactly(in, text.data(), length, path);
    FilmFile file;
    file.header = parse_header(text, path);
    // The header may claim any size: no memory is taken for what the file does not hold.
    if (bytes_left(in) != film_bytes(file.header) + sizeof(std::uint64_t))
        refuse("truncated film", path);
    std::uint64_t hash = hash_bytes(0, text.data(), text.size()), stored = 0;
    for (size_t i = 0; i < file.header.exponents.size(); ++i) {
        Film film(file.header.width, file.header.height, file.header.unit_exponent);
        read_exactly(in, film.words().data(), film.words().size() * 8, path);
        hash = hash_bytes(hash, film.words().data(), film.words().size() * 8);
        file.films.push_back(std::move(film));
    }
    read_exactly(in, &stored, sizeof stored, path);
    if (stored != hash) refuse("film's contents do not match their hash", path);
    return file;
}

std::string render_difference(const FilmHeader& a, const FilmHeader& b) {
    if (a.scene_hash != b.scene_hash || a.settings != b.settings || a.exponents != b.exponents ||
        a.unit_exponent != b.unit_exponent || a.width != b.width || a.height != b.height)
        return "films come from different scenes or settings (" + b.scene +
               "); use films of one render";
    if (a.version != b.version || a.instruction_set != b.instruction_set)
        return "films were made by different programs (" + b.version + ", " + b.instruction_set +
               "); use one build on all machines";
    return {};
}

void check_same_render(const FilmHeader& a, const FilmHeader& b) {
    const std::string difference = render_difference(a, b);
    if (!difference.empty()) throw std::runtime_error(difference);
}

void merge_film(FilmFile& into, const FilmFile& from) {
    FilmHeader& a = into.header;
    const FilmHeader& b = from.header;
    check_same_render(a, b);
    std::vector<PassRange> all = a.passes;
    all.insert(all.end(), b.passes.begin(), b.passes.end());
    std::sort(all.begin(), all.end(),
              [](const PassRange& x, const PassRange& y) { return x.first < y.first; });
    for (size_t i = 1; i < all.size(); ++i)
        if (all[i].first < all[i - 1].end)
            throw std::runtime_error("films hold the same samples (" + b.scene +
                                     "); merge each shard once");
    a.passes.clear();
    for (const PassRange& r : all) {
        if (!a.passes.empty() && a.passes.back().end == r.first)
            a.passes.back().end = r.end;
        else
            a.passes.push_back(r);
    }
    for (size_t i = 0; i < into.films.size(); ++i) into.films[i].merge(from.films[i]);
}

PassCounts pass_counts(const FilmHeader& h) {
    PassCounts n;
    for (const PassRange& r : h.passes) {
        const PassCounts k = pass_counts(r.first, r.end);
        n.a += k.a;
        n.b += k.b;
    }
    return n;
}

}  // namespace midway
