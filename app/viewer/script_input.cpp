#include "script_input.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <charconv>
#include <stdexcept>

namespace midway {
namespace {

constexpr int drag_frames = 12;

float coordinate(const std::string& text) {
    float x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error != std::errc() || end != text.data() + text.size())
        throw std::invalid_argument("not a number: \"" + text + "\"");
    return x;
}

constexpr std::pair<const char*, int> named_keys[] = {{"Tab", GLFW_KEY_TAB},
                                                      {"Escape", GLFW_KEY_ESCAPE},
                                                      {"Enter", GLFW_KEY_ENTER},
                                                      {"Space", GLFW_KEY_SPACE},
                                                      {"Left", GLFW_KEY_LEFT},
                                                      {"Right", GLFW_KEY_RIGHT},
                                                      {"Up", GLFW_KEY_UP},
                                                      {"Down", GLFW_KEY_DOWN},
                                                      {"Home", GLFW_KEY_HOME},
                                                      {"End", GLFW_KEY_END},
                                                      {"PageUp", GLFW_KEY_PAGE_UP},
                                                      {"PageDown", GLFW_KEY_PAGE_DOWN},
                                                      {"Delete", GLFW_KEY_DELETE},
                                                      {"Backspace", GLFW_KEY_BACKSPACE},
                                                      {"minus", GLFW_KEY_MINUS},
                                                      {"equal", GLFW_KEY_EQUAL},
                                                      {"comma", GLFW_KEY_COMMA},
                                                      {"period", GLFW_KEY_PERIOD},
                                                      {"slash", GLFW_KEY_SLASH},
                                                      {"bracketleft", GLFW_KEY_LEFT_BRACKET},
                                                      {"bracketright", GLFW_KEY_RIGHT_BRACKET}};

int key_code(const std::string& name) {
    for (const auto& [known, code] : named_keys)
        if (name == known) return code;
    if (name.size() == 1 && std::isalnum(static_cast<unsigned char>(name[0])))
        return std::toupper(static_cast<unsigned char>(name[0]));
    if (name.size() >= 2 && name[0] == 'F') {
        const float n = coordinate(name.substr(1));
        if (n >= 1 && n <= 12) return GLFW_KEY_F1 + static_cast<int>(n) - 1;
    }
    throw std::invalid_argument("unknown key \"" + name + "\"");
}

void add_key(ScriptPlayer& p, std::string name) {
    InputStep step;
    for (size_t plus; (plus = name.find('+')) != std::string::npos && plus + 1 < name.size();) {
        const std::string modifier = name.substr(0, plus);
        if (modifier != "ctrl" && modifier != "shift")
            throw std::invalid_argument("unknown modifier \"" + modifier + "\"");
        (modifier == "ctrl" ? step.ctrl : step.shift) = true;
        name = name.substr(plus + 1);
    }
    step.key = key_code(name);
    p.input.push_back(step);
    p.input.push_back({});
}

int button_of(const std::string& name) {
    if (name == "left" || name == "double") return 0;
    if (name == "right") return 1;
    if (name == "middle") return 2;
    throw std::invalid_argument("unknown button \"" + name + "\"");
}

void add_click(ScriptPlayer& p, vec2 at, const std::string& button) {
    p.input.push_back({.mouse = at});
    for (int i = 0; i < (button == "double" ? 2 : 1); ++i) {
        p.input.push_back({.mouse = at, .button = button_of(button)});
        p.input.push_back({.mouse = at});
    }
}

void add_drag(ScriptPlayer& p, vec2 from, vec2 to, const std::string& button) {
    const int held = button_of(button);
    p.input.push_back({.mouse = from});
    for (int i = 0; i <= drag_frames; ++i)
        p.input.push_back(
            {.mouse = glm::mix(from, to, static_cast<float>(i) / drag_frames), .button = held});
    p.input.push_back({.mouse = to});
}

}  // namespace

void add_input(ScriptPlayer& p, const std::vector<std::string>& w) {
    const auto point = [&](size_t i) { return vec2(coordinate(w[i]), coordinate(w[i + 1])); };
    if (w[0] == "key")
        add_key(p, w[1]);
    else if (w[0] == "type")
        p.input.push_back({.text = w[1]});
    else if (w[0] == "move")
        p.input.push_back({.mouse = point(1)});
    else if (w[0] == "click")
        add_click(p, point(1), w.size() > 3 ? w[3] : "left");
    else if (w[0] == "drag")
        add_drag(p, point(1), point(3), w.size() > 5 ? w[5] : "left");
    else
        p.input.push_back({.mouse = point(1), .scroll = coordinate(w[3])});
    p.input.push_back({});  // the hands rest for a frame
}

void give_input(ScriptPlayer& p) {
    if (!p.hands && p.input.empty()) return;
    ImGuiIO& io = ImGui::GetIO();
    InputStep step;
    if (!p.input.empty()) {
        step = p.input.front();
        p.input.pop_front();
    }
    if (step.mouse) p.mouse = *step.mouse;
    io.MousePos = {p.mouse.x, p.mouse.y};
    for (int i = 0; i < 3; ++i) io.MouseDown[i] = step.button == i;
    io.MouseWheel = step.scroll;
    for (bool& down : io.KeysDown) down = false;
    if (step.key) io.KeysDown[step.key] = true;
    io.KeyCtrl = step.ctrl;
    io.KeyShift = step.shift;
    if (!step.text.empty()) io.AddInputCharactersUTF8(step.text.c_str());
}

}  // namespace midway
