#include "remember.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "image/file.h"

namespace midway {
namespace {

namespace fs = std::filesystem;

constexpr const char* our_section = "[Midway][Window]";

fs::path settings_folder() {
    const char* xdg = std::getenv("XDG_CONFIG_HOME");
    if (xdg && fs::path(xdg).is_absolute()) return fs::path(xdg) / "midway";
    const char* home = std::getenv("HOME");
    return home && *home ? fs::path(home) / ".config" / "midway" : fs::path();
}

void take_line(const std::string& line, App& app, Memory& memory) {
    const size_t equals = line.find('=');
    if (equals == std::string::npos) return;
    const std::string key = line.substr(0, equals), value = line.substr(equals + 1);
    Arrangement& a = app.ui.panel.arrangement;
    if (key == "Size") {
        ivec2 size(0);
        if (std::sscanf(value.c_str(), "%d,%d", &size.x, &size.y) == 2 && size.x >= 320 &&
            size.y >= 240 && size.x <= 16384 && size.y <= 16384)
            memory.window = size;
    } else if (key == "Recent" && app.ui.recent.size() < 12) {
        app.ui.recent.push_back(value);
    } else if (key == "Columns") {
        a.left = value.find("left") != std::string::npos;
        a.right = value.find("right") != std::string::npos;
    } else if (key.rfind("Section ", 0) == 0) {
        a.sections[key.substr(8)] = value == "open";
    }
}

}  // namespace

Memory recall(App& app) {
    Memory memory;
    const fs::path folder = settings_folder();
    std::error_code failure;
    if (folder.empty() || (fs::create_directories(folder, failure), failure)) return memory;
    memory.path = (folder / "imgui.ini").string();
    std::ifstream file(memory.path);
    std::ostringstream text;
    if (!file || !(text << file.rdbuf())) return memory;
    memory.read = true;
    ImGui::LoadIniSettingsFromMemory(text.str().c_str(), text.str().size());
    std::istringstream lines(text.str());
    std::string line;
    for (bool ours = false; std::getline(lines, line);) {
        if (!line.empty() && line[0] == '[')
            ours = line == our_section;
        else if (ours)
            take_line(line, app, memory);
    }
    return memory;
}

void keep(const App& app, Memory& memory) {
    if (memory.path.empty()) return;
    const Arrangement& a = app.ui.panel.arrangement;
    std::string text = ImGui::SaveIniSettingsToMemory();
    text += fmt::format("\n{}\nSize={},{}\nColumns={}{}\n", our_section, memory.window.x,
                        memory.window.y, a.left ? "left" : "", a.right ? " right" : "");
    for (const auto& [title, open] : a.sections)
        text += fmt::format("Section {}={}\n", one_line(title), open ? "open" : "closed");
    for (const std::string& path : app.ui.recent) text += "Recent=" + one_line(path) + "\n";
    try {
        atomic_write(memory.path, text);
    } catch (const std::exception&) {
        memory.path.clear();  // a full disk must not keep the window from going on
    }
}

}  // namespace midway
