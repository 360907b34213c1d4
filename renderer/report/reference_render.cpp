#include "report/reference_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "image/file.h"
#include "math/hash.h"
#include "render/film_file.h"
#include "report/reference_pilot.h"

namespace midway {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

// Eight halves: enough to know the error of the mean, and its own spread.
constexpr int reference_seeds = 4;
constexpr double longest_slice_seconds = 0.5;
constexpr double keep_every_seconds = 60;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// What is remembered of a reference beside its films.
struct Record {
    std::string label, pilot;
    double seconds = 0;
};

// Folder and name of all files of a reference, without ending.
std::string path_of(const ReferencePlan& plan) {
    RenderSettings s = plan.settings;
    s.technique = Technique::bdpt;
    s.exponents = {2};
    const std::string text = settings_json(s) + "\n" + MIDWAY_VERSION + "\n" + MIDWAY_ARCH + "\n";
    const std::uint64_t hash = hash_bytes(plan.scene->hash, text.data(), text.size());
    return (std::filesystem::path(plan.folder) /
            fmt::format("{}-{:016x}", file_label(plan.name), hash))
        .string();
}

std::string film_path(const std::string& path, int i) { return fmt::format("{}-{}.film", path, i); }

// Empty where there is none, or where this plan would not take the technique that it names.
std::optional<Record> read_record(const std::string& path, const ReferencePlan& plan) {
    std::ifstream in(path + ".json", std::ios::binary);
    if (!in) return {};
    try {
        const Json j = Json::parse(in);
        Record r{j.at("technique"), j.at("pilot"), j.at("seconds")};
        for (const TechniqueChoice* t : best_covering(plan))
            if (t->label == r.label) return r;
    } catch (const Json::exception&) {
    }
    return {};
}

void write_record(const std::string& path, const Record& r) {
    Json j;
    j["technique"] = r.label;
    j["pilot"] = r.pilot;
    j["seconds"] = r.seconds;
    atomic_write(path + ".json", j.dump(2) + "\n");
}

RenderSettings settings_of(const ReferencePlan& plan, const std::string& label, int seed) {
    RenderSettings s = plan.settings;
    for (const TechniqueChoice& t : plan.candidates)
        if (t.label == label) s = t.settings;
    // Far from the seeds of the curves, which count from the settings' own.
    s.seed = hash_combine(plan.settings.seed, 0x7265666572656e63 + std::uint64_t(seed));
    return s;
}

struct Part {
    RenderSettings settings;
    std::unique_ptr<ProgressiveRenderer> renderer;
};

// All films as they were kept; false where one is missing or of another render (where `auto` has
// been taught to choose another plan, say) or damaged.
bool adopt_all(const ReferencePlan& plan, const std::string& path, std::vector<Part>& parts) {
    std::vector<FilmFile> films;
    for (int i = 0; i < int(parts.size()); ++i) {
        try {
            films.push_back(read_film(film_path(path, i)));
        } catch (const std::runtime_error&) {
            return false;
        }
        const FilmHeader own = film_header(*plan.scene, parts[i].settings, *parts[i].renderer);
        if (!render_difference(own, films.back().header).empty()) return false;
    }
    for (int i = 0; i < int(parts.size()); ++i) {
        const std::uint64_t passes = pass_counts(films[i].header).total();
        parts[i].renderer->adopt(std::move(films[i].films), passes);
    }
    return true;
}

// Not before every seed has a pass: a film holds one at least.
void keep(const ReferencePlan& plan, const std::string& path, const std::vector<Part>& parts,
          const Record& record) {
    for (const Part& p : parts)
        if (p.renderer->passes() == 0) return;
    for (int i = 0; i < int(parts.size()); ++i)
        write_film(film_path(path, i),
                   film_header(*plan.scene, parts[i].settings, *parts[i].renderer),
                   *parts[i].renderer);
    write_record(path, record);
}

// Passes for all seeds in turn until the time is over; false where it was stopped.
bool render_all(const ReferencePlan& plan, const CompareHooks& hooks, const std::string& path,
                std::vector<Part>& parts, Record& record) {
    auto kept = Clock::now();
    while (true) {
        const auto least =
            std::min_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
                return a.renderer->passes() < b.renderer->passes();
            });
        const bool begun = least->renderer->passes() > 0;
        if (begun && record.seconds >= plan.seconds) return true;
        if (hooks.stop()) return false;
        std::uint64_t passes = 0;
        for (const Part& p : parts) passes += p.renderer->passes();
        std::uint64_t wave = 1;
        if (begun) {
            const double room = std::min(longest_slice_seconds,
                                         (plan.seconds - record.seconds) / double(parts.size()));
            const double fits = room * double(passes) / record.seconds;
            wave = std::uint64_t(std::clamp(fits, 1.0, double(least->renderer->passes())));
        }
        const auto start = Clock::now();
        least->renderer->render_passes(wave);
        const double seconds = seconds_since(start);
        hooks.progress("reference, " + record.label,
                       std::max(0.0, std::min(seconds, plan.seconds - record.seconds)));
        record.seconds += seconds;
        if (seconds_since(kept) > keep_every_seconds) {
            keep(plan, path, parts, record);
            kept = Clock::now();
        }
    }
}

}  // namespace

std::optional<RenderedReference> render_reference(const ReferencePlan& plan,
                                                  const CompareHooks& hooks) {
    std::filesystem::create_directories(plan.folder);
    const std::string path = path_of(plan);
    std::optional<Record> record = read_record(path, plan);
    const bool known = record.has_value();
    if (!known) {
        const std::optional<PilotResult> pilot = run_pilot(plan, hooks);
        if (!pilot) return {};
        record = Record{pilot->label, pilot->text, 0};
    } else {
        hooks.skip(plan.pilot_seconds * double(plan.candidates.size()));
    }
    std::vector<Part> parts(reference_seeds);
    RendererOptions options;
    options.threads = plan.threads;
    for (int i = 0; i < reference_seeds; ++i) {
        parts[i].settings = settings_of(plan, record->label, i);
        parts[i].renderer = std::make_unique<ProgressiveRenderer>(
            plan.scene->scene, plan.scene->camera, parts[i].settings, options);
    }
    if (!known || !adopt_all(plan, path, parts)) record->seconds = 0;
    const double before = record->seconds;
    hooks.skip(std::min(before, plan.seconds));
    const bool whole = render_all(plan, hooks, path, parts, *record);
    if (!known || record->seconds != before) keep(plan, path, parts, *record);
    if (!whole) return {};

    std::vector<FilmPart> films;
    for (const Part& p : parts) films.push_back({&p.renderer->film(), p.renderer->counts()});
    RenderedReference r;
    r.reference = reference_of_films(films);
    r.info.source = "rendered";
    r.info.technique = record->label;
    r.info.spp = r.reference.spp;
    r.info.seconds = record->seconds;
    r.info.why = record->pilot;
    return r;
}

}  // namespace midway
