#include "script_inspect.h"

#include <charconv>
#include <stdexcept>

#include "panels/parts.h"

namespace midway {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw std::invalid_argument("cannot inspect \"" + text + "\"");
}

std::uint64_t number(const std::string& text) {
    std::uint64_t n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || end != text.data() + text.size()) refuse(text);
    return n;
}

int coordinate(const std::string& text) {
    const std::uint64_t n = number(text);
    if (n > 65535) refuse(text);
    return static_cast<int>(n);
}

void wish_for_pixel(const std::string& text, InspectorState& s) {
    const size_t first = text.find(','), second = text.find(',', first + 1);
    if (first == std::string::npos) refuse(text);
    const ivec2 pixel(coordinate(text.substr(0, first)),
                      coordinate(text.substr(first + 1, second - first - 1)));
    const std::string which = second == std::string::npos ? "0" : text.substr(second + 1);
    if (which == "brightest")
        wish_for(s, Find::brightest, pixel, 0);
    else
        wish_for(s, Find::sample, pixel, number(which));
}

void pick(const std::string& text, InspectorState& s) {
    const std::uint64_t n = number(text);
    if (!s.shown || n >= s.shown->order.size()) refuse("path " + text);
    s.picked = s.shown->order[n];
}

}  // namespace

void inspect_by_script(const std::vector<std::string>& words, App& app) {
    InspectorState& s = app.ui.panel.inspector;
    const std::string& what = words[0];
    if ((what == "path") != (words.size() == 2)) refuse(what);
    app.ui.panel.navigation.tool = what == "off" ? ViewTool::orbit : ViewTool::inspect;
    if (what == "off") return;
    if (what == "path") {
        pick(words[1], s);
    } else if (what == "brightest") {
        wish_for(s, Find::brightest_pixel, s.wish.pixel, 0);
    } else if (what == "nonfinite") {
        if (!inspect_nonfinite(app)) refuse(what);
    } else {
        wish_for_pixel(what, s);
    }
}

bool inspected(const App& app, const Engine& engine) {
    const InspectorState& s = app.ui.panel.inspector;
    if (s.wish.number == 0 || s.answered != s.wish.number || s.progress ||
        engine.inspector.sampler.busy())
        return false;
    return !s.shown || (s.lines_ready && !engine.inspector.sight.busy());
}

}  // namespace midway
