// Code made for facts (integrator/facts.h) against the code that holds always: the same integers in
// the film and the same rays, for all kinds of lights and surfaces, and that passes get it at all.
#include <gtest/gtest.h>

#include "math/float_mode.h"
#include "render/renderer.h"
#include "support/agreement_scenes.h"

namespace midway::test {
namespace {

constexpr std::uint64_t passes = 6;

struct Setting {
    std::string name;
    RenderSettings settings;
    Facts facts;  // that are expected to be made use of
};

RenderSettings small(Technique technique) {
    RenderSettings s;
    s.technique = technique;
    s.width = 14;
    s.height = 11;
    s.max_bounces = 6;
    return s;
}

RenderSettings with_families(const std::string& words) {
    RenderSettings s = small(Technique::bdpt);
    s.families = parse_families(words);
    return s;
}

RenderSettings planned(const std::string& words, int quarters, bool splats_direct = true,
                       int direct_samples = 1) {
    RenderSettings s = small(Technique::automatic);
    s.plan = Plan{parse_families(words), quarters, splats_direct, direct_samples};
    return s;
}

RenderSettings with_exponents(Technique technique, std::vector<double> exponents) {
    RenderSettings s = small(technique);
    s.exponents = std::move(exponents);
    return s;
}

// What the film does not simply add.
RenderSettings clamped(float largest) {
    RenderSettings s = small(Technique::bdpt);
    s.clamp = largest;
    return s;
}
RenderSettings unweighted() {
    RenderSettings s = small(Technique::bdpt);
    s.unweighted = true;
    return s;
}

std::vector<Setting> all_settings() {
    return {
        {"path", small(Technique::path), path_tracer_facts},
        {"emitter hits", with_families("emitter"), path_tracer_facts},
        {"next event", with_families("next-event"), path_tracer_facts},
        {"plan of a path tracer", planned("emitter,next-event", 0), path_tracer_facts},
        {"bdpt", small(Technique::bdpt), power2_facts},
        {"light", small(Technique::light), power2_facts},
        {"bdpt without connections", with_families("emitter,next-event,light"), power2_facts},
        {"bdpt without light tracing", with_families("emitter,next-event,connect"), power2_facts},
        {"plan with few light subpaths", planned("emitter,next-event,light", 1), power2_facts},
        {"plan with few connections", planned("emitter,next-event,light,connect", 1), power2_facts},
        {"plan without direct splats", planned("emitter,next-event,light,connect", 4, false),
         power2_facts},
        {"plan of a path tracer, direct light twice", planned("emitter,next-event", 0, true, 2),
         path_tracer_facts},
        {"plan with direct light twice", planned("emitter,next-event,light,connect", 4, true, 2),
         power2_facts},
        {"plan with many", planned("emitter,next-event,light,connect", 8), power2_facts},
        {"clamped", clamped(0.02f), power2_facts},
        {"bare", unweighted(), power2_facts},
        {"balance", with_exponents(Technique::path, {1}), no_facts},
        {"list", with_exponents(Technique::bdpt, {2, 1}), no_facts},
    };
}

struct Outcome {
    std::vector<FilmWords> words;
    std::uint64_t closest = 0, shadow = 0, not_finite = 0;
    bool operator==(const Outcome&) const = default;
};

Outcome render_always(const AgreementScene& a, const RenderSettings& settings) {
    const ScopedFlushToZero flush;
    const Estimator e = make_estimator(*a.scene, a.camera, settings);
    const int unit = film_unit_exponent(a.scene->total_power);
    std::vector<Film> films(static_cast<size_t>(e.exponent_count),
                            Film(e.crop.width(), e.crop.height(), unit));
    FilmTargets targets;
    targets.films = &films;
    targets.crop = e.crop;
    targets.recording = make_recording(settings);
    WorkerSums sums;
    LightSubpaths light;
    {
        FilmRecord<false> record(targets, sums);
        const auto go_on = [] { return true; };
        for (std::uint64_t pass = 0; pass < passes; ++pass)
            for (int y = e.crop.y0; y < e.crop.y1; ++y)
                for (int n = 0; n < group_count(e.crop); ++n)
                    estimate<no_facts>(e, group_at(e.crop, n, y), pass, light, record, sums.rays,
                                       go_on);
    }
    Outcome o{{}, sums.rays.closest, sums.rays.shadow, sums.nonfinite.count};
    for (const Film& film : films) o.words.push_back(film.words());
    return o;
}

Outcome render_by_facts(const AgreementScene& a, const RenderSettings& settings, bool statistics) {
    ProgressiveRenderer r(a.scene, a.camera, settings, {.threads = 1, .statistics = statistics});
    r.render_passes(passes);
    const RenderStatistics s = r.statistics();
    Outcome o{{}, s.rays.closest, s.rays.shadow, s.nonfinite.count};
    for (int i = 0; i < r.estimator().exponent_count; ++i) o.words.push_back(r.film(i).words());
    return o;
}

TEST(Facts, DoNotChangeABit) {
    for (const std::string& name : oracle_scene_names()) {
        const AgreementScene a = make_agreement_scene(name);
        for (const Setting& k : all_settings()) {
            SCOPED_TRACE(name + ", " + k.name);
            const Outcome always = render_always(a, k.settings);
            ASSERT_GT(always.closest, 0u);
            EXPECT_TRUE(always == render_by_facts(a, k.settings, false));
            EXPECT_TRUE(always == render_by_facts(a, k.settings, true));
        }
    }
}

TEST(Facts, AreFound) {
    const AgreementScene a = make_agreement_scene("five_lights");
    for (const Setting& k : all_settings()) {
        SCOPED_TRACE(k.name);
        const Facts found = facts_of(make_estimator(*a.scene, a.camera, k.settings));
        EXPECT_TRUE(found == k.facts);
        EXPECT_TRUE(with_facts(found, []<Facts F> { return F; }) == k.facts);
    }
}

void expect_same_statistics(const RenderStatistics& a, const RenderStatistics& b) {
    EXPECT_EQ(a.clamped, b.clamped);
    EXPECT_EQ(a.fixed.inexact, b.fixed.inexact);
    ASSERT_EQ(a.strategies.size(), b.strategies.size());
    for (size_t i = 0; i < a.strategies.size(); ++i) {
        const StrategyStatistics &x = a.strategies[i], &y = b.strategies[i];
        SCOPED_TRACE(describe(x.strategy));
        EXPECT_TRUE(x.strategy == y.strategy);
        EXPECT_EQ(x.samples, y.samples);
        EXPECT_EQ(x.rays, y.rays);
        EXPECT_EQ(x.energy, y.energy);
        EXPECT_EQ(x.second_moment, y.second_moment);
    }
}

TEST(Facts, NeedNotBeMadeUseOf) {
    const AgreementScene a = make_agreement_scene("five_lights");
    for (const Setting& k : all_settings()) {
        SCOPED_TRACE(k.name);
        for (const bool statistics : {false, true}) {
            RendererOptions options{.threads = 1, .statistics = statistics};
            ProgressiveRenderer usual(a.scene, a.camera, k.settings, options);
            options.general = true;
            ProgressiveRenderer general(a.scene, a.camera, k.settings, options);
            EXPECT_TRUE(usual.facts() == k.facts);
            EXPECT_TRUE(general.facts() == no_facts);
            usual.render_passes(2), general.render_passes(2);
            EXPECT_TRUE(usual.film().words() == general.film().words());
            expect_same_statistics(usual.statistics(), general.statistics());
        }
    }
}

// A pilot weighs paths without light subpaths as if there were some.
TEST(Facts, OfTheWeightsCountToo) {
    const AgreementScene a = make_agreement_scene("area");
    Estimator e = make_estimator(*a.scene, a.camera, small(Technique::path));
    e.weighed[0].connection = true;
    EXPECT_TRUE(facts_of(e) == power2_facts);
    e.weighed[0] = e.families;
    EXPECT_TRUE(facts_of(e) == path_tracer_facts);
    e.exponents[0] = 2.5;
    EXPECT_TRUE(facts_of(e) == no_facts);
}

}  // namespace
}  // namespace midway::test
