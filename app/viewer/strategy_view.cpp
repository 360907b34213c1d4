#include "strategy_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace midway {
namespace {

constexpr size_t most_seen = 8;

void remember(std::vector<Strategy>& seen, const Strategy& k) {
    std::erase(seen, k);
    seen.insert(seen.begin(), k);
    if (seen.size() > most_seen) seen.resize(most_seen);
}

const StrategySnapshot* strategies_of(const App& app) {
    return app.snapshot ? app.snapshot->strategies.get() : nullptr;
}

// The exposure at which the brightest of the chosen cells looks right.
float own_exposure(const App& app, const StrategySnapshot& s) {
    const PyramidChoices& p = app.display.pyramid;
    float ev = 64;
    for (const Strategy& k : p.selected)
        if (const CellSnapshot* cell = s.find(k); cell && cell->found.energy > 0)
            ev = std::min(ev, p.bare ? cell->bare_ev : cell->weighted_ev);
    return ev < 64 ? ev : app.display.exposure_ev;
}

std::shared_ptr<const Image> sum_of_thumbnails(const PyramidChoices& p, const StrategySnapshot& s) {
    auto sum = std::make_shared<Image>(s.tile_width, s.tile_height);
    for (size_t i = 0; i < s.cells.size(); ++i) {
        if (std::ranges::find(p.selected, s.cells[i].found.strategy) == p.selected.end()) continue;
        const Image tile = thumbnail(s, i, p.bare);
        for (size_t k = 0; k < tile.pixels.size(); ++k) sum->pixels[k] += tile.pixels[k];
    }
    return sum;
}

}  // namespace

void open_pyramid(App& app, bool open) {
    PyramidChoices& p = app.display.pyramid;
    p.open = open;
    if (open) return;
    p.selected.clear();
    p.seen.clear();
}

void choose_strategy(App& app, const Strategy& k, bool add) {
    PyramidChoices& p = app.display.pyramid;
    const bool was_in = std::ranges::find(p.selected, k) != p.selected.end();
    const std::vector<Strategy> before = p.selected;
    if (add && was_in) {
        std::erase(p.selected, k);
    } else if (add) {
        p.selected.push_back(k);
    } else {
        // A click on what is shown alone is the way back.
        p.selected = before == std::vector{k} ? std::vector<Strategy>{} : std::vector{k};
    }
    for (const Strategy& old : before)
        if (std::ranges::find(p.selected, old) == p.selected.end()) remember(p.seen, old);
    for (const Strategy& chosen : p.selected) std::erase(p.seen, chosen);
    app.display.channel = Channel::image;
}

void show_whole_image(App& app) {
    PyramidChoices& p = app.display.pyramid;
    for (const Strategy& k : p.selected) remember(p.seen, k);
    p.selected.clear();
}

bool shows_strategies(const App& app) {
    const PyramidChoices& p = app.display.pyramid;
    return p.open && !p.selected.empty() && app.display.channel == Channel::image;
}

StrategyRequest strategy_request(const App& app) {
    const PyramidChoices& p = app.display.pyramid;
    if (!p.open) return {};
    return {true, app.render.exponent, p.selected, p.seen};
}

bool strategies_at_full_size(const App& app) {
    const StrategySnapshot* s = strategies_of(app);
    return s && s->selected_weighted && s->selected == app.display.pyramid.selected;
}

void show_strategies(const App& app, ShownImage& shown) {
    const PyramidChoices& p = app.display.pyramid;
    if (!shows_strategies(app)) return;
    const StrategySnapshot* s = strategies_of(app);
    if (strategies_at_full_size(app)) {
        shown.image = p.bare ? s->selected_bare : s->selected_weighted;
    } else if (s && s->weighted) {
        shown.image = sum_of_thumbnails(p, *s);
        shown.placement = s->placement;
        shown.scale = s->box;
    } else {
        shown.image = std::make_shared<Image>(1, 1);  // nothing is known yet
    }
    if (s && p.own_exposure) shown.maths.scale = std::exp2(own_exposure(app, *s));
}

std::optional<std::vector<Strategy>> parse_strategies(const std::string& text) {
    std::vector<Strategy> list;
    for (size_t start = 0; text != "none" && start <= text.size() && list.size() < 64;) {
        const size_t end = std::min(text.find(';', start), text.size());
        const std::string one = text.substr(start, end - start);
        Strategy k = longer_paths;
        int length = 0;
        if (one != "longer" && (std::sscanf(one.c_str(), "%2d,%2d%n", &k.s, &k.t, &length) != 2 ||
                                static_cast<size_t>(length) != one.size() || k.s < 1 || k.t < 0 ||
                                k.edges() < 1 || k.edges() > cell_edges))
            return {};
        list.push_back(k);
        start = end + 1;
    }
    return list;
}

std::string strategies_text(const std::vector<Strategy>& strategies) {
    std::string text;
    for (const Strategy& k : strategies)
        text += (text.empty() ? "" : ";") +
                (k == longer_paths ? "longer" : std::to_string(k.s) + "," + std::to_string(k.t));
    return text.empty() ? "none" : text;
}

std::string strategy_name(const Strategy& k) {
    return k == longer_paths ? "longer paths, all strategies together" : describe(k);
}

}  // namespace midway
