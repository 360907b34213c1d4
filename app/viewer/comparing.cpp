#include "comparing.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "comparison.h"
#include "engine.h"
#include "image/file.h"
#include "report/error_log.h"

namespace midway {
namespace {

// Between two measurements that only move the ends of the curves.
constexpr double shortest_rest = 0.25;  // seconds
constexpr double rest_per_cost = 15;    // of what measuring takes

std::string seconds_text(double s) {
    if (s < 60) return fmt::format("{:.1f} s", s);
    const auto whole = static_cast<long long>(s);
    return fmt::format("{}:{:02} min", whole / 60, whole % 60);
}

KeptImage kept_now(const App& app) {
    const Snapshot& s = *app.snapshot;
    const size_t i = std::min(shown_exponent(app), s.images.size() - 1);
    CurveMaker maker = app.compare.maker;
    maker.exponent = s.exponents[i];
    KeptImage k;
    k.caption =
        fmt::format("{}, {} sample{}", curve_label(maker), s.passes, s.passes == 1 ? "" : "s");
    k.name = k.caption + ", " + seconds_text(s.seconds);
    k.subject = *app.compare.live;
    k.image = s.images[i];
    k.place = s.crop;
    k.mean = static_cast<float>(mean_luminance(*k.image));
    return k;
}

// Where the reference lies in the image that is rendered; empty where it does not fit.
std::optional<PixelRect> place_of(const Reference& r, const Subject& now) {
    const ivec2 size(r.image.width, r.image.height);
    if (size == ivec2(now.crop.width(), now.crop.height())) return now.crop;
    if (size == ivec2(now.width, now.height)) return PixelRect{0, 0, now.width, now.height};
    return {};
}

std::string size_refusal(const LoadedReference& r, const Subject& now) {
    return fmt::format(
        "reference is of another size: {}x{} ({}); the image is {}x{}: render at "
        "the reference's size",
        r.reference->image.width, r.reference->image.height, r.path, now.crop.width(),
        now.crop.height());
}

// Says whether the reference can serve the image in view; binds it to the first that it fits.
void follow_reference(App& app) {
    CompareState& c = app.compare;
    if (!c.reference || !c.live) return;
    LoadedReference& r = *c.reference;
    const auto place = place_of(*r.reference, *c.live);
    r.fits = place.has_value();
    r.refusal.clear();
    if (!place) {
        r.refusal = "it is of another size";
    } else if (!r.shown) {
        use_reference_here(app);
    } else {
        // A region is part of what a reference of the whole image shows.
        Subject then = r.shown->subject;
        if (r.shown->place.area() == std::int64_t{then.width} * then.height)
            then.crop = c.live->crop;
        r.refusal = other_image(then, *c.live);
    }
}

bool take_reference(App& app, Engine& engine) {
    std::optional<LoadedReference> loaded;
    {
        const std::lock_guard lock(engine.comparing.inbox->mutex);
        loaded.swap(engine.comparing.inbox->loaded);
    }
    if (!loaded) return false;
    CompareState& c = app.compare;
    c.reference = std::move(loaded);
    for (LiveCurve& curve : c.curves)
        for (CurvePoint& p : curve.points) p.measured.reset();
    c.metric = ErrorMetric::relmse;
    follow_reference(app);
    if (c.live && !place_of(*c.reference->reference, *c.live))
        app.document.error = size_refusal(*c.reference, *c.live);
    return true;
}

std::shared_ptr<const Reference> usable_reference(const CompareState& c) {
    return c.reference && c.reference->refusal.empty() ? c.reference->reference : nullptr;
}

bool take_measurements(App& app, Engine& engine) {
    bool news = false;
    CompareState& c = app.compare;
    while (const std::optional<Measurement> m = engine.comparing.meter.take()) {
        engine.comparing.cost = m->seconds;
        if (!m->error.empty()) app.document.error = m->error;
        news = true;
        const auto job = std::find_if(engine.jobs.begin(), engine.jobs.end(),
                                      [&](const SubmittedJob& j) { return j.number == m->job; });
        if (job == engine.jobs.end() || m->job < c.curves_since) continue;
        for (size_t i = 0; i < m->points.size(); ++i) {
            CurvePoint p = m->points[i];
            if (!c.reference || m->reference != c.reference->reference) p.measured.reset();
            const RenderSettings& s = job->settings;
            add_point(c.curves, {s.technique, s.exponents[i], s.sampler, s.seed}, m->job, p);
        }
    }
    return news;
}

// Takes note of what the snapshot is of; curves of another image are dropped, and it is said why.
void follow_job(App& app, const SubmittedJob& job) {
    CompareState& c = app.compare;
    if (c.live && c.live_job == job.number) return;
    c.live_job = job.number;
    c.live = subject_of(*job.prepared, job.settings);
    const RenderSettings& s = job.settings;
    c.maker = {s.technique, s.exponents.front(), s.sampler, s.seed};
    const std::string why = c.curves_subject ? other_image(*c.curves_subject, *c.live) : "";
    if (c.curves_subject && why.empty()) return;
    if (!c.curves.empty()) c.dropped = why;
    c.curves.clear();
    c.curves_subject = c.live;
    c.curves_since = job.number;
}

// Whether the snapshot shall be measured now: at the end, at times evenly spaced on a logarithmic
// scale, and now and then while somebody watches.
bool is_due(const App& app, const ComparingEngine& e) {
    const Snapshot& s = *app.snapshot;
    if (s.job != e.job || e.reference != usable_reference(app.compare)) return true;
    if (s.passes == e.passes) return false;
    if (s.finished || s.paused || s.seconds >= e.render_seconds * curve_spacing) return true;
    if (!app.compare.watched) return false;
    const double since =
        std::chrono::duration<double>(ComparingEngine::Clock::now() - e.submitted).count();
    return since >= std::max(shortest_rest, rest_per_cost * e.cost);
}

bool is_measurable(const App& app) {
    if (!app.snapshot || app.snapshot->scale != 1 || app.snapshot->images.empty()) return false;
    return app.snapshot->passes % 2 == 0 || usable_reference(app.compare);
}

void feed_meter(const App& app, ComparingEngine& e) {
    if (!is_measurable(app) || !is_due(app, e)) return;
    const Snapshot& s = *app.snapshot;
    e.job = s.job;
    e.passes = s.passes;
    e.render_seconds = s.seconds;
    e.reference = usable_reference(app.compare);
    e.submitted = ComparingEngine::Clock::now();
    e.meter.submit({app.snapshot, e.reference});
}

bool has_whole_pass(const App& app) {
    return app.snapshot && app.snapshot->scale == 1 && !app.snapshot->images.empty() &&
           app.compare.live && app.compare.live_job == app.snapshot->job;
}

void check_finite(const Reference& r, const std::string& path) {
    for (const vec3& p : r.image.pixels)
        if (!is_finite(p))
            throw std::runtime_error("a pixel of the reference is not finite (" + path +
                                     "); render it again");
}

}  // namespace

void keep_image(App& app, Engine& engine, const std::string& name) {
    CompareState& c = app.compare;
    if (!app.document.prepared)
        throw std::runtime_error("nothing to keep (window); open a scene first");
    if (c.kept.size() >= most_kept)
        throw std::runtime_error(
            fmt::format("{} images are kept already (Compare); delete one of them", most_kept));
    if (!has_whole_pass(app)) {
        engine.comparing.keep_later = name;
        return;
    }
    KeptImage k = kept_now(app);
    k.id = c.next_id++;
    if (!name.empty()) k.name = one_line(name);
    c.chosen = k.id;
    c.kept.push_back(std::move(k));
}

void forget_image(CompareState& c, std::uint64_t id) {
    std::erase_if(c.kept, [&](const KeptImage& k) { return k.id == id; });
    if (c.chosen == id) c.chosen.reset();
    if (!c.chosen) c.view = CompareView::live;
}

void load_reference_file(App& app, Engine& engine, const std::string& path) {
    const std::shared_ptr<ReferenceInbox> inbox = engine.comparing.inbox;
    std::uint64_t number = 0;
    {
        const std::lock_guard lock(inbox->mutex);
        number = ++inbox->number;
        inbox->loaded.reset();
    }
    if (path.empty()) {
        CompareState& c = app.compare;
        if (c.chosen == reference_id) forget_image(c, reference_id);
        c.reference.reset();
        for (LiveCurve& curve : c.curves)
            for (CurvePoint& p : curve.points) p.measured.reset();
        return;
    }
    engine.tasks.submit([path, number, inbox] {
        auto reference = std::make_shared<Reference>(load_reference(path));
        check_finite(*reference, path);
        const std::lock_guard lock(inbox->mutex);
        if (number == inbox->number) inbox->loaded = LoadedReference{path, std::move(reference)};
        return "read reference " + path;
    });
}

void use_reference_here(App& app) {
    CompareState& c = app.compare;
    if (!c.reference || !c.live) return;
    const auto place = place_of(*c.reference->reference, *c.live);
    if (!place) return;
    LoadedReference& r = *c.reference;
    KeptImage k;
    k.id = reference_id;
    k.caption = "reference";
    k.name = r.path.substr(r.path.find_last_of('/') + 1);
    k.subject = *c.live;
    k.image = std::shared_ptr<const Image>(r.reference, &r.reference->image);
    k.place = *place;
    k.mean = static_cast<float>(r.reference->luminance.estimate.mean);
    r.shown = std::move(k);
    r.refusal.clear();
}

bool follow_comparison(App& app, Engine& engine) {
    bool news = take_measurements(app, engine);
    const SubmittedJob* job = shown_job(app, engine);
    if (job) follow_job(app, *job);
    news |= take_reference(app, engine);
    follow_reference(app);
    if (engine.comparing.keep_later && has_whole_pass(app)) {
        const std::string name = *std::exchange(engine.comparing.keep_later, {});
        try {
            keep_image(app, engine, name);
        } catch (const std::exception& e) {
            app.document.error = e.what();
        }
        news = true;
    }
    if (job) feed_meter(app, engine.comparing);
    return news;
}

bool is_measured(const App& app, const Engine& engine) {
    const ComparingEngine& e = engine.comparing;
    const std::lock_guard lock(e.inbox->mutex);
    if (e.meter.busy() || e.inbox->loaded) return false;
    return !is_measurable(app) || (e.job == app.snapshot->job && e.passes == app.snapshot->passes &&
                                   e.reference == usable_reference(app.compare));
}

void save_curves(const App& app, Engine& engine, const std::string& path) {
    if (app.compare.curves.empty())
        throw std::runtime_error("no curve to save (" + path + "); let it render for a while");
    engine.tasks.submit([path, text = curves_csv(app.compare.curves)] {
        atomic_write(path, text);
        return "saved " + path;
    });
}

}  // namespace midway
