#include "report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "comparison.h"
#include "edits.h"
#include "image/file.h"
#include "strategy_view.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t longest_list = 100000;

float quantile(std::vector<float> values, double share) {
    const auto place =
        static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size())) - 1);
    const auto nth = values.begin() + std::max<std::ptrdiff_t>(place, 0);
    std::nth_element(values.begin(), nth, values.end());
    return *nth;
}

Json summary(const std::vector<float>& values) {
    if (values.empty()) return {{"count", 0}};
    return {{"count", values.size()},
            {"median", quantile(values, 0.5)},
            {"p95", quantile(values, 0.95)},
            {"max", *std::max_element(values.begin(), values.end())}};
}

Json strategies_json(const Inspection& i, const InspectedPath& path) {
    Json list = Json::array();
    for (const InspectedStrategy& s : path.strategies)
        list.push_back({{"s", s.strategy.s},
                        {"t", s.strategy.t},
                        {"feasible", s.feasible},
                        {"log10_pdf", s.feasible ? Json(s.log10_pdf) : Json()},
                        {"weight", s.weights[i.exponent]},
                        {"direct", s.direct[i.exponent]}});
    return list;
}

Json vertices_json(const std::vector<InspectedVertex>& vertices) {
    Json list = Json::array();
    for (const InspectedVertex& v : vertices)
        list.push_back({{"kind", to_string(v.kind)},
                        {"object", v.object_name},
                        {"material", v.material_name},
                        {"position", {v.position.x, v.position.y, v.position.z}},
                        {"delta", v.delta}});
    return list;
}

// The pixel whose light subpath a path connects to, where it is not its own.
Json neighbour_json(const InspectedSample& sample, const InspectedPath& p) {
    if (!p.neighbour) return nullptr;
    const NeighbourSubpath& n = sample.neighbours[*p.neighbour];
    return {n.x, n.y};
}

Json inspector_json(const InspectorState& s) {
    Json j{{"searching", s.progress.has_value()},
           {"note", s.note},
           {"camera_moved", s.camera_moved},
           {"picked", s.picked}};
    if (s.drawing)
        j["lines"] = {{"visible", std::count_if(s.drawing->lines.begin(), s.drawing->lines.end(),
                                                [](const PathLine& l) { return !l.hidden; })},
                      {"all", s.drawing->lines.size()}};
    if (!s.shown) return j;
    const Inspection& i = *s.shown;
    const vec3 gave = recorded_in(i.sample, i.watched.x, i.watched.y)[i.exponent];
    j["pixel"] = {i.watched.x, i.watched.y};
    j["sample"] = {i.sample.x, i.sample.y, i.sample.pass};
    j["exponent"] = i.sample.exponents[i.exponent];
    j["gave"] = {gave.x, gave.y, gave.z};
    j["camera"] = vertices_json(i.sample.camera);
    j["light"] = vertices_json(i.sample.light);
    j["paths"] = Json::array();
    for (const int k : i.order) {
        const InspectedPath& p = i.sample.paths[static_cast<size_t>(k)];
        const vec3 v = given(i, p);
        j["paths"].push_back({{"strategy", describe(p.contribution.strategy)},
                              {"pixel", {p.x, p.y}},
                              {"gave", {v.x, v.y, v.z}},
                              {"neighbour", neighbour_json(i.sample, p)},
                              {"strategies", strategies_json(i, p)}});
    }
    return j;
}

Json comparison_json(const App& app) {
    const CompareState& c = app.compare;
    constexpr const char* views[] = {"b", "a", "wipe", "difference"};
    Json j{{"asked", views[static_cast<int>(c.view)]},
           {"shown", views[static_cast<int>(view_in_use(app))]},
           {"wipe", c.wipe},
           {"a", caption_a(app)},
           {"b", caption_b(app)},
           {"refusal", view_refusal(app)},
           {"remark", a_remark(app)},
           {"bytes", kept_bytes(c)},
           {"kept", Json::array()},
           {"reference", nullptr}};
    for (const KeptImage& k : c.kept) j["kept"].push_back(k.name);
    if (c.reference)
        j["reference"] = {{"path", c.reference->path}, {"refusal", c.reference->refusal}};
    return j;
}

Json curves_json(const CompareState& c) {
    Json list = Json::array();
    for (const LiveCurve& curve : c.curves) {
        Json points = Json::array();
        for (const CurvePoint& p : curve.points) {
            Json point{{"seconds", p.seconds}, {"spp", p.spp}, {"estimate", p.estimate}};
            if (p.measured) {
                point["relmse"] = p.measured->relmse;
                point["relmse_trimmed"] = p.measured->relmse_trimmed;
                point["bias"] = p.measured->bias;
            }
            points.push_back(std::move(point));
        }
        list.push_back({{"label", curve.label}, {"points", std::move(points)}});
    }
    return list;
}

// The strategy pyramid: what is chosen, and where a hand finds each cell.
Json pyramid(const App& app) {
    const PyramidChoices& p = app.display.pyramid;
    Json j{{"open", p.open}, {"bare", p.bare}, {"selected", Json::array()}};
    for (const Strategy& k : p.selected) j["selected"].push_back({k.s, k.t});
    const auto strategies = app.snapshot ? app.snapshot->strategies : nullptr;
    j["passes"] = strategies ? strategies->passes : 0;
    j["full_size"] = strategies_at_full_size(app);
    j["shares"] = Json::array();
    if (strategies)
        for (const CellSnapshot& c : strategies->cells)
            j["shares"].push_back({{"s", c.found.strategy.s},
                                   {"t", c.found.strategy.t},
                                   {"samples", c.found.samples},
                                   {"rays", c.found.rays},
                                   {"energy", c.found.energy},
                                   {"second_moment", c.found.second_moment},
                                   {"variance", c.variance}});
    j["cells"] = Json::array();
    for (const PyramidPanel::Cell& c : app.ui.panel.pyramid.cells)
        j["cells"].push_back(
            {{"s", c.s}, {"t", c.t}, {"x", c.x}, {"y", c.y}, {"left_out", c.left_out}});
    return j;
}

}  // namespace

ReportMark mark_now(App& app) {
    app.timings.frames.clear();
    app.timings.edit_to_image.clear();
    app.timings.stops.clear();
    ReportMark mark;
    if (app.snapshot) {
        mark.samples = double(app.snapshot->passes);
        mark.job = app.snapshot->job;
    }
    return mark;
}

void write_report(const std::string& path, const App& app, const ReportMark& mark) {
    const ReportMark now;
    const double wall = std::chrono::duration<double>(now.time - mark.time).count();
    Json j;
    j["scene"] = app.document.path;
    j["error"] = app.document.error;
    j["warnings"] = app.document.warnings;
    j["left_out"] = app.document.left_out;
    j["notice"] = app.ui.notice;
    j["first_pixels"] = app.timings.first_pixels;
    j["frames"] = summary(app.timings.frames);
    j["edit_to_image"] = summary(app.timings.edit_to_image);
    j["stops"] = summary(app.timings.stops);
    j["seconds"] = wall;
    j["cpu_seconds"] = now.cpu_seconds - mark.cpu_seconds;
    for (const auto& [title, place] : app.ui.panel.section_places) j["sections"][title] = place;
    j["compare"] = comparison_json(app);
    j["curves"] = curves_json(app.compare);
    j["edits"] = edits_in_words(app.document.options.edits);
    j["lights"] = Json::array();
    for (const Lamp& lamp : lamps(app))
        j["lights"].push_back({{"name", lamp_name(app, lamp)}, {"on", lamp_is_on(app, lamp)}});
    j["undo"] = app.undo.past.size();
    j["redo"] = app.undo.future.size();
    const Selection& selection = app.ui.panel.selection;
    if (selection.material >= 0)
        j["selected"] = {{"object", selection.object}, {"material", selection.material_name}};
    j["pyramid"] = pyramid(app);
    if (app.snapshot) {
        const Snapshot& s = *app.snapshot;
        j["job"] = s.job;
        j["scale"] = s.scale;
        j["size"] = {s.width, s.height};
        j["spp"] = s.passes;
        j["finished"] = s.finished;
        j["exponents"] = s.exponents;
        j["seconds_render"] = s.seconds;
        j["samples_per_second"] =
            s.seconds > 0 ? double(s.passes) * s.crop.area() / s.seconds : 0.0;
        j["rays_closest"] = s.statistics.rays.closest;
        j["rays_shadow"] = s.statistics.rays.shadow;
    }
    if (app.ui.panel.navigation.tool == ViewTool::inspect)
        j["inspector"] = inspector_json(app.ui.panel.inspector);
    atomic_write(path, j.dump(2) + "\n");
}

void note_time(std::vector<float>& list, double seconds) {
    if (list.size() >= longest_list) list.erase(list.begin(), list.begin() + longest_list / 2);
    list.push_back(static_cast<float>(seconds));
}

}  // namespace midway
