#include "inspector_engine.h"

#include <algorithm>
#include <array>
#include <exception>
#include <tuple>
#include <utility>

#include "engine.h"
#include "render/film_file.h"

namespace midway {
namespace {

std::shared_ptr<const Inspection> make_inspection(const InspectTask& task, ivec2 watched, ivec2 of,
                                                  std::uint64_t pass) {
    auto i = std::make_shared<Inspection>();
    i->what = task.what;
    i->watched = watched;
    i->exponent = task.exponent;
    i->searched = task.wish.find != Find::sample;
    i->sample = inspect_sample(task.what, of.x, of.y, pass);
    const std::vector<InspectedPath>& paths = i->sample.paths;
    for (size_t k = 0; k < paths.size(); ++k) i->order.push_back(static_cast<int>(k));
    const auto rank = [&](int k) {
        const InspectedPath& p = paths[static_cast<size_t>(k)];
        const bool elsewhere = p.x != watched.x || p.y != watched.y;
        const float light = luminance(given(*i, p));
        return std::tuple(elsewhere, p.usable, std::isnan(light) ? 0.0f : -light, k);
    };
    std::sort(i->order.begin(), i->order.end(), [&](int a, int b) { return rank(a) < rank(b); });
    return i;
}

// The own samples of a pixel are soon looked through; then come the splats of all others.
void search(const InspectTask& task, ivec2 pixel, const RenderControl& control,
            const std::function<void(InspectNews)>& publish) {
    const BrightestSearch search{task.what,   pixel.x,       pixel.y,     0,
                                 task.passes, task.exponent, task.threads};
    InspectNews news{task.wish.number, nullptr, 0.0f, {}};
    std::optional<BrightSample> shown;
    const auto show = [&](const std::optional<BrightSample>& best) {
        if (!best || (shown && !(best->luminance > shown->luminance))) return;
        shown = best;
        news.inspection = make_inspection(task, pixel, {best->x, best->y}, best->pass);
    };
    show(brightest_own_sample(search, control));
    publish(news);
    show(brightest_sample(search, control,
                          [&](double done, const std::optional<BrightSample>& best) {
                              news.progress = static_cast<float>(done);
                              show(best);
                              publish(news);
                          }));
    news.progress.reset();
    if (!news.inspection) news.note = "no sample gave anything to this pixel";
    publish(news);
}

void carry_out(const InspectTask& task, const RenderControl& control,
               const std::function<void(InspectNews)>& publish) {
    const InspectWish& wish = task.wish;
    if (wish.find == Find::sample) {
        publish({wish.number, make_inspection(task, wish.pixel, task.of, wish.pass), {}, {}});
        return;
    }
    ivec2 pixel = wish.pixel;
    if (wish.find == Find::brightest_pixel) {
        std::optional<ivec2> outlier;
        if (task.image && task.variance) outlier = brightest_outlier(*task.image, *task.variance);
        if (!outlier) {
            publish({wish.number, nullptr, {}, "no pixel stands out from its neighbours"});
            return;
        }
        const PixelRect crop = task.what.settings.crop.value_or(PixelRect{});
        pixel = *outlier + ivec2(crop.x0, crop.y0);
    }
    search(task, pixel, control, publish);
}

bool same_camera(const CameraDescription& a, const CameraDescription& b) {
    return a.yfov == b.yfov && a.aperture_radius == b.aperture_radius &&
           a.focus_distance == b.focus_distance && a.to_world == b.to_world;
}

bool same_pixels(const RenderSettings& a, const RenderSettings& b) {
    const auto crop = [](const RenderSettings& s) {
        const PixelRect r = s.crop.value_or(PixelRect{0, 0, s.width, s.height});
        return std::array{s.width, s.height, r.x0, r.y0, r.x1, r.y1};
    };
    return crop(a) == crop(b);
}

void forget(InspectorState& s, InspectEngine& workers) {
    workers.sampler.cancel();
    workers.sight.cancel();
    workers.sight_of.reset();
    workers.wish = s.wish.number;
    s.shown.reset();
    s.drawing.reset();
    s.lines_ready = false;
    s.progress.reset();
    s.note.clear();
    s.picked = -1;
    s.camera_moved = false;
}

InspectTask task_of(const App& app, const SubmittedJob& job) {
    const Snapshot& snapshot = *app.snapshot;
    const InspectWish& wish = app.ui.panel.inspector.wish;
    const size_t exponent = shown_exponent(app);
    InspectTask t{wish, {job.prepared->scene, job.prepared->camera, job.settings}, wish.pixel};
    t.exponent = exponent;
    t.passes = snapshot.passes;
    t.threads = app.render.threads;
    if (wish.find == Find::brightest_pixel && exponent < snapshot.images.size()) {
        t.image = snapshot.images[exponent];
        if (exponent < snapshot.variances.size()) t.variance = snapshot.variances[exponent];
    }
    return t;
}

// Before `auto` has its plan, nobody knows which paths the image's samples are made of.
bool is_undecided(const RenderSettings& s) {
    return s.technique == Technique::automatic && !s.plan;
}

// A new wish of the panel, once the image can answer it.
void take_wish(App& app, InspectEngine& workers, const SubmittedJob& job) {
    InspectorState& s = app.ui.panel.inspector;
    const Snapshot& snapshot = *app.snapshot;
    // The samples of a coarse image are none of the image's own.
    if (s.wish.find != Find::sample && snapshot.scale != 1) return;
    if (is_undecided(job.settings)) return;
    workers.wish = s.wish.number;
    workers.job = job.number;
    workers.path = job.prepared->options.path;
    s.camera_moved = false;
    const ivec2 p = s.wish.pixel;
    if (s.wish.find != Find::brightest_pixel && !snapshot.crop.contains(p.x, p.y)) {
        forget(s, workers);
        s.answered = s.wish.number;
        s.note = "this pixel is not rendered";
        return;
    }
    if (s.wish.find != Find::sample) s.progress = 0.0f;
    workers.sampler.submit(task_of(app, job));
}

// What a sample taken before is inspected with now. A plan of `auto` belongs to the camera it was
// decided for, and so does the sample.
RenderSettings settings_for(const InspectorState& s, const RenderSettings& now) {
    const RenderSettings& was = s.shown->what.settings;
    RenderSettings settings = now;
    if (s.camera_moved && was.plan && now.plan) settings.plan = was.plan;
    return settings;
}

// The same sample again, with what is rendered now, seen by the camera it was taken with.
void inspect_again(App& app, InspectEngine& workers, const SubmittedJob& job) {
    InspectorState& s = app.ui.panel.inspector;
    const InspectedSample& sample = s.shown->sample;
    InspectTask t = task_of(app, job);
    t.what.camera = s.shown->what.camera;
    t.what.settings = settings_for(s, job.settings);
    t.of = {sample.x, sample.y};
    t.wish.find = Find::sample;
    t.wish.pixel = s.shown->watched;
    t.wish.pass = sample.pass;
    workers.sampler.submit(t);
}

void follow_job(App& app, InspectEngine& workers, const SubmittedJob& job) {
    InspectorState& s = app.ui.panel.inspector;
    const bool new_job = workers.job != job.number;
    if (s.shown) s.camera_moved = !same_camera(s.shown->what.camera, job.prepared->camera);
    if (is_undecided(job.settings)) return;
    workers.job = job.number;
    if (!s.shown) {
        // The search goes on in what is rendered now.
        if (new_job && s.answered != s.wish.number) workers.wish = 0;
        return;
    }
    const Inspectable& was = s.shown->what;
    if (new_job && s.progress) {
        workers.sampler.cancel();
        s.progress.reset();
    }
    if (new_job &&
        (workers.path != job.prepared->options.path || !same_pixels(was.settings, job.settings))) {
        forget(s, workers);
        return;
    }
    const bool another_scene = was.scene != job.prepared->scene;
    if (new_job && (another_scene ||
                    settings_json(was.settings) != settings_json(settings_for(s, job.settings))))
        inspect_again(app, workers, job);
    else if (s.shown->exponent != shown_exponent(app) && !workers.sampler.busy())
        inspect_again(app, workers, job);
}

void follow_sight(InspectorState& s, InspectEngine& workers, const SubmittedJob& job) {
    if (!s.shown || (workers.sight_of == s.shown && workers.sight_picked == s.picked &&
                     workers.sight_job == job.number))
        return;
    workers.sight_of = s.shown;
    workers.sight_picked = s.picked;
    workers.sight_job = job.number;
    s.lines_ready = false;
    workers.sight.submit({s.shown, s.picked, *s.camera});
}

}  // namespace

void inspect(const InspectTask& task, const RenderControl& control,
             const std::function<void(InspectNews)>& publish) {
    try {
        carry_out(task, control, publish);
    } catch (const std::exception& e) {
        publish({task.wish.number, nullptr, {}, e.what()});
    }
}

InspectEngine::InspectEngine(const std::function<void()>& wake)
    : sampler(inspect, wake),
      sight(
          [](const SightTask& task, const RenderControl& control, const auto& publish) {
              const Scene& scene = *task.inspection->what.scene;
              const PathDrawing drawing =
                  drawing_of(task.inspection->sample, task.picked,
                             scene.radius / scene.geometry->normalisation.scale);
              publish(std::make_shared<const PathDrawing>(
                  seen_from(scene, task.camera, drawing, control)));
          },
          wake) {}

bool collect_inspection(App& app, Engine& engine) {
    InspectorState& s = app.ui.panel.inspector;
    InspectEngine& workers = engine.inspector;
    bool visible = false;
    if (const SubmittedJob* job = shown_job(app, engine); job && !app.snapshot->images.empty()) {
        s.normalisation = job->prepared->scene->geometry->normalisation;
        s.camera = make_camera(job->prepared->camera, s.normalisation, job->settings.width,
                               job->settings.height);
        s.passes = app.snapshot->scale == 1 ? app.snapshot->passes : 0;
    }
    if (std::optional<InspectNews> news = workers.sampler.take();
        news && news->wish == s.wish.number) {
        visible = true;
        if (news->inspection && news->inspection != s.shown) {
            s.shown = std::move(news->inspection);
            s.picked = s.shown->order.empty() ? -1 : s.shown->order.front();
            s.wish.pixel = s.shown->watched;
        }
        if (!news->note.empty()) s.shown.reset();
        s.progress = news->progress;
        s.note = news->note;
        if (!s.progress) s.answered = s.wish.number;
    }
    if (auto drawing = workers.sight.take()) {
        s.drawing = std::move(*drawing);
        s.lines_ready = true;
        visible = true;
    }
    return visible;
}

void follow_inspection(App& app, Engine& engine) {
    InspectorState& s = app.ui.panel.inspector;
    InspectEngine& workers = engine.inspector;
    if (app.ui.panel.navigation.tool != ViewTool::inspect) {
        if (s.shown || s.progress || !s.note.empty()) forget(s, workers);
        s.answered = workers.wish = s.wish.number;
        return;
    }
    const SubmittedJob* job = shown_job(app, engine);
    if (!job || app.snapshot->images.empty()) return;
    if (std::exchange(s.stop_search, false) && s.progress) {
        workers.sampler.cancel();
        s.progress.reset();
        s.answered = s.wish.number;
    }
    if (s.wish.number != workers.wish)
        take_wish(app, workers, *job);
    else
        follow_job(app, workers, *job);
    follow_sight(s, workers, *job);
}

}  // namespace midway
