#include "script_set.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <span>
#include <stdexcept>

#include "strategy_view.h"

namespace midway {
namespace {

using Text = const std::string&;

[[noreturn]] void refuse(Text key, Text value, const std::string& remedy) {
    throw std::invalid_argument("wrong value \"" + value + "\" (" + key + "); " + remedy);
}

double number(Text key, Text value, double low, double high) {
    double x = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), x);
    if (error != std::errc() || end != value.data() + value.size() || !(x >= low && x <= high))
        refuse(key, value, fmt::format("give a number from {:g} to {:g}", low, high));
    return x;
}

template <size_t count>
std::array<double, count> numbers(Text key, Text value) {
    std::array<double, count> list{};
    size_t start = 0;
    for (size_t i = 0; i < count; ++i) {
        const size_t comma = i + 1 < count ? value.find(',', start) : value.size();
        if (comma == std::string::npos) refuse(key, value, fmt::format("give {} numbers", count));
        list[i] = number(key, value.substr(start, comma - start), -1e300, 1e300);
        start = comma + 1;
    }
    return list;
}

std::uint64_t whole(Text key, Text value, std::uint64_t low, std::uint64_t high) {
    std::uint64_t n = 0;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), n);
    if (error != std::errc() || end != value.data() + value.size() || n < low || n > high)
        refuse(key, value, fmt::format("give a whole number from {} to {}", low, high));
    return n;
}

bool on_off(Text key, Text value) {
    if (value == "on") return true;
    if (value == "off") return false;
    refuse(key, value, "use on or off");
}

template <class T, size_t N>
T word(Text key, Text value, const std::pair<const char*, T> (&words)[N]) {
    std::string known;
    for (const auto& [name, meaning] : words) {
        if (value == name) return meaning;
        known += (known.empty() ? "" : ", ") + std::string(name);
    }
    refuse(key, value, "use one of " + known);
}

constexpr std::pair<const char*, Curve> curves[] = {
    {"srgb", Curve::srgb}, {"filmic", Curve::filmic}, {"agx", Curve::agx}};
constexpr std::pair<const char*, Channel> channels[] = {
    {"image", Channel::image},    {"albedo", Channel::albedo}, {"normal", Channel::normal},
    {"depth", Channel::depth},    {"object", Channel::object}, {"error", Channel::error},
    {"samples", Channel::samples}};

constexpr std::pair<const char*, CompareView> compare_views[] = {
    {"b", CompareView::live},
    {"a", CompareView::kept},
    {"wipe", CompareView::wipe},
    {"difference", CompareView::difference}};
constexpr std::pair<const char*, ErrorMetric> metrics[] = {{"relmse", ErrorMetric::relmse},
                                                           {"trimmed", ErrorMetric::trimmed},
                                                           {"bias", ErrorMetric::bias},
                                                           {"estimate", ErrorMetric::estimate}};
constexpr std::pair<const char*, bool> weights[] = {{"weighted", false}, {"bare", true}};
constexpr std::pair<const char*, bool> thumbnail_exposures[] = {{"image", false}, {"own", true}};
constexpr std::pair<const char*, PyramidShare> shares[] = {
    {"light", PyramidShare::light}, {"noise", PyramidShare::noise}, {"rays", PyramidShare::rays}};

template <class T, size_t N>
std::string name_of(T value, const std::pair<const char*, T> (&words)[N]) {
    for (const auto& [name, meaning] : words)
        if (meaning == value) return name;
    return "";
}

constexpr Change display{.display = true}, camera{.camera = true}, settings{.settings = true},
    scene{.scene = true};

struct Key {
    const char* name;
    Change (*set)(App&, Text key, Text value);
};

Change set_technique(App& app, Text, Text value) {
    const size_t colon = value.find(':');
    app.render.settings.technique = parse_technique(value.substr(0, colon));
    if (colon != std::string::npos) set_value(app, "exponent", value.substr(colon + 1));
    return settings;
}

Change set_exponent_value(App& app, Text key, Text value) {
    const double b = app.render.exponent = number(key, value, 0, 32);
    if (b != 0 && b != 1 && b != 2) app.render.free_exponent = b;
    return settings;
}

Change set_size(App& app, Text key, Text value) {
    app.render.fit_window = value == "fit";
    if (app.render.fit_window) return settings;
    const size_t x = value.find('x');
    if (x == std::string::npos) refuse(key, value, "give WxH, or fit");
    RenderSettings& s = app.render.settings;
    s.width = static_cast<int>(whole(key, value.substr(0, x), 1, 65536));
    s.height = static_cast<int>(whole(key, value.substr(x + 1), 1, 65536));
    s.crop.reset();
    return settings;
}

Change set_crop(App& app, Text key, Text value) {
    if (value == "off") {
        app.render.settings.crop.reset();
        return settings;
    }
    const auto n = numbers<4>(key, value);
    app.render.settings.crop = PixelRect{int(n[0]), int(n[1]), int(n[2]), int(n[3])};
    return settings;
}

Change set_exposure(App& app, Text key, Text value) {
    app.display.auto_exposure = value == "auto";
    if (!app.display.auto_exposure)
        app.display.exposure_ev = static_cast<float>(number(key, value, -64, 64));
    return display;
}

Change set_stops(App& app, Text key, Text value) {
    const auto n = numbers<2>(key, value);
    if (!(n[0] < n[1])) refuse(key, value, "give LOW,HIGH");
    app.display.stop_low = static_cast<float>(n[0]);
    app.display.stop_high = static_cast<float>(n[1]);
    return display;
}

// The kept image of this name or number (counted from 1) is A, or the reference.
Change set_compare_with(App& app, Text key, Text value) {
    CompareState& c = app.compare;
    if (value == "reference") {
        c.chosen = reference_id;
        return display;
    }
    for (size_t i = 0; i < c.kept.size(); ++i)
        if (value == c.kept[i].name || value == std::to_string(i + 1)) {
            c.chosen = c.kept[i].id;
            return display;
        }
    refuse(key, value, "give the name or number of a kept image, or reference");
}

// absolute, relative, or either with the end of its scale: "relative:0.5".
Change set_difference(App& app, Text key, Text value) {
    const size_t colon = value.find(':');
    const std::string kind = value.substr(0, colon);
    if (kind != "absolute" && kind != "relative") refuse(key, value, "use absolute or relative");
    CompareState& c = app.compare;
    c.relative = kind == "relative";
    if (colon != std::string::npos)
        (c.relative ? c.relative_range : c.range) =
            static_cast<float>(number(key, value.substr(colon + 1), 1e-6, 1e6));
    return display;
}

// Opens a section of the columns by its title and closes all others.
Change open_section(App& app, Text, Text value) {
    Arrangement& a = app.ui.panel.arrangement;
    for (const auto& [title, place] : app.ui.panel.section_places) a.sections[title] = false;
    a.sections[value] = true;
    return display;
}

// Views to come back to: eye, target and field of view (radians) of each, parted by semicolons.
Change set_views(App& app, Text key, Text value) {
    app.camera.bookmarks.clear();
    for (size_t start = 0; start < value.size() && app.camera.bookmarks.size() < 100;) {
        const size_t end = std::min(value.find(';', start), value.size());
        const auto n = numbers<7>(key, value.substr(start, end - start));
        const View view{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n[6]};
        if (view.eye == view.target || !(view.yfov > 0 && view.yfov < pi))
            refuse(key, value, "give eye, target and field of view");
        app.camera.bookmarks.push_back(
            {fmt::format("View {}", app.camera.bookmarks.size() + 1), view});
        start = end + 1;
    }
    return display;
}

std::string views_of(const App& app) {
    std::string text;
    for (const CameraChoices::Bookmark& b : app.camera.bookmarks)
        text += fmt::format("{}{},{},{},{},{},{},{}", text.empty() ? "" : ";", b.view.eye.x,
                            b.view.eye.y, b.view.eye.z, b.view.target.x, b.view.target.y,
                            b.view.target.z, b.view.yfov);
    return text;
}

// Strategies that are shown instead of the image: "3,1;1,2", "longer", or "none".
Change set_strategies(App& app, Text key, Text value) {
    const auto chosen = parse_strategies(value);
    if (!chosen)
        refuse(key, value, "give S,T of paths of up to 8 edges, parted by ;, longer, or none");
    if (!chosen->empty()) open_pyramid(app, true);
    show_whole_image(app);
    for (const Strategy& k : *chosen) choose_strategy(app, k, true);
    return display;
}

// Settings of light transport, as the options of midway render.
constexpr Key render_keys[] = {
    {"technique", set_technique},
    {"exponent", set_exponent_value},
    {"same-paths",
     [](App& a, Text k, Text v) { return a.render.same_paths = on_off(k, v), settings; }},
    {"families",
     [](App& a, Text, Text v) { return a.render.settings.families = parse_families(v), settings; }},
    {"size", set_size},
    {"crop", set_crop},
    {"max-bounces",
     [](App& a, Text k, Text v) {
         return a.render.settings.max_bounces = int(whole(k, v, 0, 10000)), settings;
     }},
    {"seed", [](App& a, Text k,
                Text v) { return a.render.settings.seed = whole(k, v, 0, ~0ull), settings; }},
    {"sampler",
     [](App& a, Text, Text v) { return a.render.settings.sampler = parse_sampler(v), settings; }},
    {"filter",
     [](App& a, Text, Text v) { return a.render.settings.filter = parse_filter(v), settings; }},
    {"clamp",
     [](App& a, Text k, Text v) {
         return a.render.settings.clamp = float(number(k, v, 1e-30, 1e30)), settings;
     }},
    {"spp", [](App& a, Text k,
               Text v) { return a.render.limits.spp = whole(k, v, 1, 1ull << 40), settings; }},
    {"time", [](App& a, Text k,
                Text v) { return a.render.limits.seconds = number(k, v, 1e-6, 1e9), settings; }},
    {"threads",
     [](App& a, Text k, Text v) { return a.render.threads = int(whole(k, v, 0, 1024)), settings; }},
    {"pause", [](App& a, Text k, Text v) { return a.render.paused = on_off(k, v), settings; }},
};

constexpr Key scene_keys[] = {
    {"camera", [](App& a, Text, Text v) { return a.document.options.camera = v, camera; }},
    {"look-at",
     [](App& a, Text k, Text v) { return a.document.options.look_at = numbers<6>(k, v), camera; }},
    {"fov",
     [](App& a, Text k, Text v) {
         return a.document.options.fov_degrees = number(k, v, 0.01, 179), camera;
     }},
    {"aperture",
     [](App& a, Text k, Text v) {
         return a.document.options.aperture_radius = number(k, v, 0, 1e30), camera;
     }},
    {"focus",
     [](App& a, Text k, Text v) {
         return a.document.options.focus_distance = number(k, v, 0, 1e30), camera;
     }},
    {"sky",
     [](App& a, Text, Text v) {
         a.document.options.sky.reset();
         if (v != "file") a.document.options.sky = v;
         return scene;
     }},
    {"sky-rotation",
     [](App& a, Text k, Text v) {
         return a.document.options.sky_rotation_degrees = number(k, v, -1e9, 1e9), scene;
     }},
    {"sky-strength",
     [](App& a, Text k, Text v) {
         return a.document.options.sky_strength = float(number(k, v, 0, 1e30)), scene;
     }},
    {"lamp-strength",
     [](App& a, Text k, Text v) {
         return a.document.options.lamp_strength = float(number(k, v, 0, 1e30)), scene;
     }},
};

// How it is shown.
constexpr Key display_keys[] = {
    {"exposure", set_exposure},
    {"curve", [](App& a, Text k, Text v) { return a.display.curve = word(k, v, curves), display; }},
    {"false-colour",
     [](App& a, Text k, Text v) { return a.display.false_colour = on_off(k, v), display; }},
    {"stops", set_stops},
    {"channel",
     [](App& a, Text k, Text v) { return a.display.channel = word(k, v, channels), display; }},
    {"zoom",
     [](App& a, Text k, Text v) {
         return a.display.zoom = v == "fit" ? 0 : float(number(k, v, 1.0 / 16, 256)), display;
     }},
    {"pan",
     [](App& a, Text k, Text v) {
         const auto n = numbers<2>(k, v);
         return a.display.pan = vec2(n[0], n[1]), display;
     }},
    {"pixel-values",
     [](App& a, Text k, Text v) { return a.display.pixel_values = on_off(k, v), display; }},
    {"compare",
     [](App& a, Text k, Text v) { return a.compare.view = word(k, v, compare_views), display; }},
    {"compare-with", set_compare_with},
    {"wipe",
     [](App& a, Text k, Text v) { return a.compare.wipe = float(number(k, v, 0, 1)), display; }},
    {"difference", set_difference},
    {"plot", [](App& a, Text k, Text v) { return a.compare.large_plot = on_off(k, v), display; }},
    {"metric",
     [](App& a, Text k, Text v) { return a.compare.metric = word(k, v, metrics), display; }},
    {"section", open_section},
    {"views", set_views},
    {"pyramid", [](App& a, Text k, Text v) { return open_pyramid(a, on_off(k, v)), display; }},
    {"pyramid-weights",
     [](App& a, Text k, Text v) { return a.display.pyramid.bare = word(k, v, weights), display; }},
    {"pyramid-exposure",
     [](App& a, Text k, Text v) {
         return a.display.pyramid.own_exposure = word(k, v, thumbnail_exposures), display;
     }},
    {"pyramid-share",
     [](App& a, Text k, Text v) { return a.display.pyramid.share = word(k, v, shares), display; }},
    {"strategies", set_strategies},
    {"panels", [](App& a, Text k, Text v) { return a.ui.panels = on_off(k, v), display; }},
    {"keys", [](App& a, Text k, Text v) { return a.ui.keys = on_off(k, v), display; }},
    {"gallery", [](App& a, Text k, Text v) { return a.ui.gallery = on_off(k, v), display; }},
    {"tour",
     [](App& a, Text k, Text v) {
         return a.ui.tour_step = v == "off" ? -1 : int(whole(k, v, 0, 99)), display;
     }},
};

const Key* find(const std::string& name) {
    for (const std::span<const Key> keys :
         {std::span<const Key>(render_keys), std::span<const Key>(scene_keys),
          std::span<const Key>(display_keys)})
        for (const Key& key : keys)
            if (name == key.name) return &key;
    return nullptr;
}

}  // namespace

bool is_value_key(const std::string& key) { return find(key) != nullptr; }

Change set_value(App& app, const std::string& key, const std::string& value) {
    const Key* k = find(key);
    if (!k) throw std::invalid_argument("unknown key (" + key + "); see app/viewer/script_set.cpp");
    return k->set(app, key, value);
}

std::map<std::string, std::string> window_values(const App& app) {
    const DisplayChoices& d = app.display;
    return {{"exposure", d.auto_exposure ? "auto" : fmt::format("{}", d.exposure_ev)},
            {"curve", name_of(d.curve, curves)},
            {"false-colour", d.false_colour ? "on" : "off"},
            {"stops", fmt::format("{},{}", d.stop_low, d.stop_high)},
            {"channel", name_of(d.channel, channels)},
            {"views", views_of(app)},
            {"pyramid", d.pyramid.open ? "on" : "off"},
            {"pyramid-weights", name_of(d.pyramid.bare, weights)},
            {"pyramid-exposure", name_of(d.pyramid.own_exposure, thumbnail_exposures)},
            {"pyramid-share", name_of(d.pyramid.share, shares)},
            {"strategies", strategies_text(d.pyramid.selected)}};
}

}  // namespace midway
