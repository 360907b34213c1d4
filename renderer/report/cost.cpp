#include "report/cost.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "integrator/facts.h"
#include "math/student.h"
#include "render/leave_outs.h"
#include "render/pilot.h"

namespace midway {
namespace {

// One thing, and how it is turned on.
struct Case {
    LeaveOut left_out;
    RenderSettings settings;
    NeedlessWork work;
    bool own_scene = false;  // `work` is not empty
    RendererOptions options;
};

std::optional<NeedlessWork> work_of(const std::string& what) {
    if (what == "textures") return NeedlessWork{.attributes = true, .textures = true};
    if (what == "normal maps") return NeedlessWork{.attributes = true, .normal_maps = true};
    if (what == "texture coordinates") return NeedlessWork{.attributes = true};
    if (what == "transparency") return NeedlessWork{.coverage = true};
    if (what == "lights") return NeedlessWork{.lights = true};
    if (what == "black lights") return NeedlessWork{.black_lights = true};
    if (what == "lights at infinity") return NeedlessWork{.sky = true};
    if (what == "transmission") return NeedlessWork{.transmission = true};
    return {};
}

// The family that a line about one is about.
std::optional<Families> family_of_line(const std::string& what) {
    for (const char* word : {"emitter", "next-event", "light", "connect"})
        if (what == word) return parse_families(word);
    return {};
}

// The light subpaths that a plan with more families than it was made for goes with.
void complete(Plan& plan) {
    if (plan.families.needs_light_subpaths() && plan.light_quarters == 0) plan.light_quarters = 4;
}

void add_scene(const PreparedScene& p, const Case& usual, std::vector<Case>& cases) {
    for (const LeaveOut& line : leave_outs(*p.scene)) {
        Case c = usual;
        c.left_out = line;
        if (const auto work = work_of(line.what)) {
            c.work = *work;
            c.own_scene = true;
        } else if (const auto families = family_of_line(line.what)) {
            const Families asked =
                families_of(c.settings.technique) & c.settings.families.value_or(Families{});
            if ((asked & *families) == Families{false, false, false, false}) continue;
            c.settings.needless = *families;
            if (c.settings.plan && families->needs_light_subpaths())
                c.settings.plan->light_quarters = 4;
        } else {
            continue;
        }
        cases.push_back(std::move(c));
    }
}

// What the pilot decided against, one by one and all together.
void add_plan(const PreparedScene& p, const Case& usual, std::vector<Case>& cases) {
    if (usual.settings.technique != Technique::automatic || !usual.settings.plan) return;
    RenderSettings unplanned = usual.settings;
    unplanned.plan.reset();
    const Families full = make_estimator(*p.scene, p.camera, unplanned).families;
    const Plan chosen = *usual.settings.plan;
    const auto add = [&](const char* what, const std::string& why, Plan plan) {
        complete(plan);
        const auto same = [&](const Case& c) { return c.settings.plan == plan; };
        if (plan == chosen || std::any_of(cases.begin(), cases.end(), same)) return;
        Case c = usual;
        c.left_out = {what, why};
        c.settings.plan = plan;
        cases.push_back(std::move(c));
    };
    const std::string why = "the plan of auto is " + describe(chosen);
    Plan more = chosen;
    more.families.connection = full.connection;
    add("connections", why, more);
    more = chosen;
    more.families.light_tracing = full.light_tracing;
    add("light tracing", why, more);
    more = chosen;
    more.light_quarters =
        std::max(more.light_quarters, more.families.needs_light_subpaths() ? 4 : 0);
    add("light subpaths", why, more);
    more = chosen;
    more.splats_direct = true;
    add("direct light's splats", why, more);
    more.families = full;
    more.light_quarters = std::max(chosen.light_quarters, 4);
    add("all that auto leaves out", why, more);
}

// What the code of a pass knows beforehand.
void add_code(const PreparedScene& p, const Case& usual, std::vector<Case>& cases) {
    const Facts facts = facts_of(make_estimator(*p.scene, p.camera, usual.settings));
    if (facts == no_facts) return;
    Case c = usual;
    c.left_out = {"code for other passes",
                  facts.path_tracer ? "the only exponent is 2, and there are no light subpaths"
                                    : "the only exponent is 2"};
    c.options.general = true;
    cases.push_back(std::move(c));
}

std::vector<Case> find_cases(const PreparedScene& p, const RenderSettings& settings, int threads) {
    Case usual;
    usual.settings = settings;
    usual.options.threads = threads;
    std::vector<Case> cases;
    add_plan(p, usual, cases);
    add_scene(p, usual, cases);
    add_code(p, usual, cases);
    Case images = usual;
    images.left_out = {"strategy images", "nobody asked for them"};
    images.options.layer_edges = 8;
    images.options.statistics = true;
    cases.push_back(images);
    return cases;
}

double sum_of(const Film& film) {
    double sum = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x)
            for (const int half : {0, 1})
                for (const Int128 v : film.sum(half, x, y))
                    sum += from_fixed(v, film.unit_exponent());
    return sum;
}

// One of the two that take turns.
class Side {
  public:
    explicit Side(std::unique_ptr<ProgressiveRenderer> r) : renderer_(std::move(r)) {}

    // Processor seconds.
    double render(std::uint64_t passes) {
        const double before = renderer_->cpu_seconds();
        renderer_->render_passes(passes);
        return renderer_->cpu_seconds() - before;
    }
    // What has been added since the last call.
    double take_sum() {
        const double sum = sum_of(renderer_->film());
        return sum - std::exchange(sum_, sum);
    }
    const Film& film() const { return renderer_->film(); }

  private:
    std::unique_ptr<ProgressiveRenderer> renderer_;
    double sum_ = 0;
};

// The ratio of the means of series that belong together, by their differences.
void compare_means(const std::vector<double>& usual, const std::vector<double>& done,
                   LeaveOutCost& row) {
    double sum = 0;
    std::vector<double> differences;
    for (size_t i = 0; i < usual.size(); ++i) {
        sum += usual[i];
        differences.push_back(done[i] - usual[i]);
    }
    if (!(sum > 0) || usual.size() < 2) return;
    const double mean = sum / double(usual.size());
    const MeanInterval d = mean_interval(differences, 0.999);
    row.mean_ratio = 1 + d.mean / mean;
    row.mean_low = 1 + d.lower / mean;
    row.mean_high = 1 + d.upper / mean;
}

LeaveOutCost measure(const PreparedScene& p, const RenderSettings& settings, const Case& c,
                     const CostOptions& options) {
    std::shared_ptr<const Scene> scene = p.scene;
    if (c.own_scene) {
        std::vector<std::string> warnings;
        scene = std::make_shared<Scene>(
            build_scene(p.description, warnings, {.previous = p.scene.get(), .needless = c.work}));
    }
    const auto side = [&](const std::shared_ptr<const Scene>& of, const RenderSettings& s,
                          const RendererOptions& o) {
        return Side(std::make_unique<ProgressiveRenderer>(of, p.camera, s, o));
    };
    Side usual = side(p.scene, settings, {.threads = options.threads});
    Side done = side(scene, c.settings, c.options);
    // The first passes touch new memory; the second tell how many a round needs.
    usual.render(1), done.render(1);
    const double once = std::min(usual.render(1), done.render(1));
    usual.take_sum(), done.take_sum();
    const auto passes =
        static_cast<std::uint64_t>(std::clamp(std::ceil(options.seconds / once), 1.0, 1e4));
    const double samples = double(passes) * double(usual.film().width()) * usual.film().height();
    std::vector<double> left_out, all, saving, sums, sums_done;
    for (int round = 0; round < options.rounds; ++round) {
        const double a = usual.render(passes), b = done.render(passes);
        left_out.push_back(a / samples);
        all.push_back(b / samples);
        saving.push_back(1 - a / b);
        sums.push_back(usual.take_sum());
        sums_done.push_back(done.take_sum());
    }
    LeaveOutCost row{c.left_out.what, c.left_out.why};
    row.left_out = middle_of(left_out);
    row.done = middle_of(all);
    row.saving = middle_of(saving);
    row.same_bits = usual.film().words() == done.film().words();
    if (!row.same_bits) compare_means(sums, sums_done, row);
    return row;
}

}  // namespace

std::vector<LeaveOutCost> measure_cost(const PreparedScene& p, const RenderSettings& settings,
                                       const CostOptions& options,
                                       const std::function<void(const char*, double)>& progress) {
    const std::vector<Case> cases = find_cases(p, settings, options.threads);
    std::vector<LeaveOutCost> rows;
    for (const Case& c : cases) {
        if (progress) progress(c.left_out.what.c_str(), double(rows.size()) / double(cases.size()));
        rows.push_back(measure(p, settings, c, options));
    }
    return rows;
}

}  // namespace midway
