// What a person chooses about a render. All of it goes into films and image headers, so that every
// picture says how it was made.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "integrator/walk.h"

namespace midway {

// `automatic` ("auto") is bdpt with what a scene does not need left out (render/pilot.h).
enum class Technique : std::uint8_t { path, light, bdpt, automatic };

// What `auto` renders with.
struct Plan {
    Families families;
    int light_quarters = 4;  // light subpaths for four pixels: 0, 1, 2, 4 or 8
    // Whether light tracing makes paths of two edges too, which next event always finds.
    bool splats_direct = true;
    int direct_samples = 1;  // from the first surface, as in Estimator
    bool operator==(const Plan&) const = default;
};

struct RenderSettings {
    Technique technique = Technique::bdpt;
    std::vector<double> exponents{2};
    std::optional<Families> families;  // of the technique where absent
    std::optional<Plan> plan;          // of `auto`; absent: not decided yet
    int width = 512, height = 512;
    std::optional<PixelRect> crop;
    int max_bounces = 16;
    std::uint64_t seed = 0;
    SamplerKind sampler = SamplerKind::sobol;
    FilterKind filter = FilterKind::blackman_harris;
    std::optional<float> clamp;  // largest component of a weighted contribution
    std::vector<Strategy> only;  // where not empty: record these strategies alone
    bool unweighted = false;     // record bare estimates
    // Families that the scene does not need and that are gone through all the same: they find
    // nothing, and the time it takes can be measured (report/cost.h). No file says so.
    Families needless{false, false, false, false};
};

std::string_view to_string(Technique t);
std::string_view to_string(SamplerKind k);
std::string_view to_string(FilterKind k);

// Throw std::invalid_argument with one line for unknown words.
Technique parse_technique(std::string_view text);
SamplerKind parse_sampler(std::string_view text);
FilterKind parse_filter(std::string_view text);

// The families that a technique stands for.
Families families_of(Technique t);

Roulette roulette_of(const Families& families);

// Estimator::direct_share. Next event that always asks the same lamp knows its samples' values
// beforehand but for shadows, and stratification does the rest; where it asks one of many, each
// lamp's light comes by chance as it does in light tracing. For a place that one lamp lights alone,
// picked with probability q, the second moment of next event is 1 / (1 - q) times its variance; q
// is taken at its mean, by power. Never below least_direct_share: shadows and highlights are not
// known. What is left at that share lowers no error that could be measured, and `auto` spares it.
inline constexpr double least_direct_share = 0.1;
double direct_share(const Scene& scene, const Families& families);

// Checks the settings against each other (std::invalid_argument with one line) and binds them to a
// scene and a camera. Light subpaths per pass are as many as the crop has pixels, but for a plan;
// `auto` without a plan is bdpt with all families.
Estimator make_estimator(const Scene& scene, const CameraDescription& camera,
                         const RenderSettings& settings);

}  // namespace midway
