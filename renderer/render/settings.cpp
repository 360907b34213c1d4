#include "render/settings.h"

#include <stdexcept>

#include "render/coverage.h"

namespace midway {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& where,
                         const std::string& remedy) {
    throw std::invalid_argument(what + " (" + where + "); " + remedy);
}

template <class T, size_t N>
T parse_word(std::string_view text, const std::pair<std::string_view, T> (&words)[N],
             const std::string& option) {
    std::string known;
    for (const auto& [word, value] : words) {
        if (word == text) return value;
        known += (known.empty() ? "" : ", ") + std::string(word);
    }
    refuse("unknown word \"" + std::string(text) + "\"", option, "use one of " + known);
}

template <class T, size_t N>
std::string_view word_of(T value, const std::pair<std::string_view, T> (&words)[N]) {
    for (const auto& [word, v] : words)
        if (v == value) return word;
    return "";
}

constexpr std::pair<std::string_view, Technique> techniques[] = {{"path", Technique::path},
                                                                 {"light", Technique::light},
                                                                 {"bdpt", Technique::bdpt},
                                                                 {"auto", Technique::automatic}};
constexpr std::pair<std::string_view, SamplerKind> samplers[] = {
    {"sobol", SamplerKind::sobol}, {"independent", SamplerKind::independent}};
constexpr std::pair<std::string_view, FilterKind> filters[] = {
    {"box", FilterKind::box},
    {"gaussian", FilterKind::gaussian},
    {"blackman-harris", FilterKind::blackman_harris}};

// Families that cannot find anything in this scene cost nothing and weigh nothing.
void leave_out(const SceneFeatures& features, Families& f) {
    f.emitter_hit &= features.hittable_lights;
    const bool connects = features.rough && features.lit;
    f.next_event &= connects;
    f.light_tracing &= connects;
    f.connection &= connects;
}

// At least one: it is a divisor.
std::uint64_t light_subpaths(const Plan& plan, std::uint64_t pixels) {
    const int quarters = plan.light_quarters;
    const int least = plan.families.connection ? 1 : 0;
    if (quarters < least || quarters > 8)
        refuse("impossible number of light subpaths", "plan", "let auto decide");
    return std::max<std::uint64_t>(1, pixels * quarters / 4);
}

int direct_samples(const Plan& plan) {
    if (plan.direct_samples < 1 || plan.direct_samples > 2)
        refuse("impossible number of next events", "plan", "let auto decide");
    return plan.direct_samples;
}

}  // namespace

std::string_view to_string(Technique t) { return word_of(t, techniques); }
std::string_view to_string(SamplerKind k) { return word_of(k, samplers); }
std::string_view to_string(FilterKind k) { return word_of(k, filters); }
Technique parse_technique(std::string_view s) { return parse_word(s, techniques, "--technique"); }
SamplerKind parse_sampler(std::string_view s) { return parse_word(s, samplers, "--sampler"); }
FilterKind parse_filter(std::string_view s) { return parse_word(s, filters, "--filter"); }

Families families_of(Technique t) {
    switch (t) {
        case Technique::path:
            return {true, true, false, false};
        case Technique::light:
            return {false, false, true, false};
        case Technique::bdpt:
        case Technique::automatic:
            return {true, true, true, true};
    }
    return {};
}

Roulette roulette_of(const Families& families) {
    // Measured on the project's scenes: connections make long subpaths dear (their number is the
    // product of the lengths), and early roulette lowers error x time of bdpt by 2 to 40 %, a
    // camera walk's a little later than a light's by 1 to 7 % more; a path tracer's error grows by
    // as much where light is indirect.
    return families.connection ? Roulette{1, 0.8f} : Roulette{};
}

double direct_share(const Scene& scene, const Families& f) {
    if (!f.next_event || !f.light_tracing) return 1;
    return std::max(least_direct_share, 1 - scene.same_lamp);
}

Estimator make_estimator(const Scene& scene, const CameraDescription& camera,
                         const RenderSettings& s) {
    if (s.width < 1 || s.height < 1 || s.width > 65536 || s.height > 65536)
        refuse("image size out of range", "--size", "use 1x1 to 65536x65536");
    if (s.exponents.empty() || s.exponents.size() > max_exponents)
        refuse("wrong number of exponents", "--exponent",
               "give 1 to " + std::to_string(max_exponents));
    for (const double b : s.exponents)
        if (!(b >= 0 && b <= 32)) refuse("exponent out of range", "--exponent", "use 0 to 32");
    if (s.max_bounces < 0 || s.max_bounces > 10000)
        refuse("number of bounces out of range", "--max-bounces", "use 0 to 10000");
    Estimator e;
    e.scene = &scene;
    e.camera = make_camera(camera, scene.geometry->normalisation, s.width, s.height);
    e.filter = make_filter(s.filter);
    e.crop = s.crop.value_or(PixelRect{0, 0, s.width, s.height});
    if (e.crop.x0 < 0 || e.crop.y0 < 0 || e.crop.x1 > s.width || e.crop.y1 > s.height ||
        e.crop.width() < 1 || e.crop.height() < 1)
        refuse("crop does not lie inside the image", "--crop",
               "use X0,Y0,X1,Y1 with 0 <= X0 < X1 <= width, and the same for Y");
    e.families = families_of(s.technique);
    if (s.families) e.families = e.families & *s.families;
    const Families asked_for = e.families;
    const bool planned = s.technique == Technique::automatic && s.plan;
    if (planned) e.families = e.families & s.plan->families;
    leave_out(scene_features(scene), e.families);
    e.roulette = roulette_of(e.families);
    e.families = e.families | (asked_for & s.needless);
    e.weighed.fill(e.families);
    e.direct_lamps = s.technique == Technique::light;
    e.exponent_count = static_cast<int>(s.exponents.size());
    std::copy(s.exponents.begin(), s.exponents.end(), e.exponents.begin());
    if (e.families.connection) {
        const auto end = e.exponents.begin() + e.exponent_count;
        e.deciding =
            static_cast<int>(std::find(e.exponents.begin(), end, 2.0) - e.exponents.begin());
        e.exponents[static_cast<size_t>(e.deciding)] = 2;
    }
    e.max_bounces = s.max_bounces;
    e.seed = s.seed;
    e.sampler = s.sampler;
    const auto pixels = static_cast<std::uint64_t>(e.crop.area());
    e.light_subpaths = planned ? light_subpaths(*s.plan, pixels) : pixels;
    e.connection_share = std::min(1.0, double(e.light_subpaths) / double(pixels));
    // A plan may be older than the families; without next event splats are all there is.
    const bool spared = planned && !s.plan->splats_direct && e.families.next_event;
    e.direct_share = spared ? 0 : direct_share(scene, e.families);
    if (planned) e.direct_samples = direct_samples(*s.plan);
    return e;
}

}  // namespace midway
