#include "window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>

#include <cstdlib>
#include <deque>
#include <stdexcept>

#include "image/file.h"

namespace midway {
namespace {

struct KeyPress {
    int key = 0, modifiers = 0;
};

struct DesktopWindow {
    GLFWwindow* handle = nullptr;
    bool event = true;
    std::deque<KeyPress> presses;  // since the last frame
    int shown = 0;                 // the key whose press ImGui saw in the last frame
    std::vector<std::string> dropped;

    DesktopWindow() = default;
    DesktopWindow(const DesktopWindow&) = delete;
    DesktopWindow& operator=(const DesktopWindow&) = delete;
    ~DesktopWindow() {
        if (handle) {
            ImGui_ImplGlfw_Shutdown();
            glfwDestroyWindow(handle);
        }
        glfwTerminate();
    }
};

DesktopWindow& window_of(GLFWwindow* handle) {
    return *static_cast<DesktopWindow*>(glfwGetWindowUserPointer(handle));
}

std::string last_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? one_line(text) : "unknown reason";
}

// Every event marks the window; ImGui chains its own handlers behind these.
void watch_events(GLFWwindow* w) {
    glfwSetCursorPosCallback(w, [](GLFWwindow* h, double, double) { window_of(h).event = true; });
    glfwSetMouseButtonCallback(w, [](GLFWwindow* h, int, int, int) { window_of(h).event = true; });
    glfwSetScrollCallback(w, [](GLFWwindow* h, double, double) { window_of(h).event = true; });
    glfwSetKeyCallback(w, [](GLFWwindow* h, int key, int, int action, int modifiers) {
        window_of(h).event = true;
        if (action == GLFW_PRESS && key >= 0) window_of(h).presses.push_back({key, modifiers});
    });
    glfwSetCharCallback(w, [](GLFWwindow* h, unsigned) { window_of(h).event = true; });
    glfwSetCursorEnterCallback(w, [](GLFWwindow* h, int) { window_of(h).event = true; });
    glfwSetWindowFocusCallback(w, [](GLFWwindow* h, int) { window_of(h).event = true; });
    glfwSetWindowRefreshCallback(w, [](GLFWwindow* h) { window_of(h).event = true; });
    glfwSetWindowCloseCallback(w, [](GLFWwindow* h) { window_of(h).event = true; });
    glfwSetFramebufferSizeCallback(w, [](GLFWwindow* h, int, int) { window_of(h).event = true; });
    glfwSetDropCallback(w, [](GLFWwindow* h, int count, const char** paths) {
        DesktopWindow& window = window_of(h);
        window.event = true;
        window.dropped.insert(window.dropped.end(), paths, paths + count);
    });
}

// ImGui asks each frame which keys are down; here every press gets a frame of its own, with the
// modifiers of its moment, even if the key was let go before that frame began.
void show_presses(DesktopWindow& w) {
    ImGuiIO& io = ImGui::GetIO();
    const auto down = [&](int key) { return glfwGetKey(w.handle, key) == GLFW_PRESS; };
    const int before = std::exchange(w.shown, 0);
    if (before) {
        io.KeysDown[before] = down(before);
        io.KeyCtrl = down(GLFW_KEY_LEFT_CONTROL) || down(GLFW_KEY_RIGHT_CONTROL);
        io.KeyShift = down(GLFW_KEY_LEFT_SHIFT) || down(GLFW_KEY_RIGHT_SHIFT);
        io.KeyAlt = down(GLFW_KEY_LEFT_ALT) || down(GLFW_KEY_RIGHT_ALT);
        io.KeySuper = down(GLFW_KEY_LEFT_SUPER) || down(GLFW_KEY_RIGHT_SUPER);
    }
    if (w.presses.empty()) return;
    w.event = true;
    if (w.presses.front().key == before) {  // twice the same: let it go in between
        io.KeysDown[before] = false;
        return;
    }
    const KeyPress press = w.presses.front();
    w.presses.pop_front();
    for (const KeyPress& later : w.presses) io.KeysDown[later.key] = false;
    io.KeysDown[press.key] = true;
    io.KeyCtrl = press.modifiers & GLFW_MOD_CONTROL;
    io.KeyShift = press.modifiers & GLFW_MOD_SHIFT;
    io.KeyAlt = press.modifiers & GLFW_MOD_ALT;
    io.KeySuper = press.modifiers & GLFW_MOD_SUPER;
    w.shown = press.key;
}

Display::Target target_of(GLFWwindow* w) {
    int points = 1, unused = 0;
    ivec2 size(1);
    glfwGetWindowSize(w, &points, &unused);
    glfwGetFramebufferSize(w, &size.x, &size.y);
    return {0, glm::max(size, ivec2(1)), float(size.x) / float(std::max(points, 1))};
}

GLFWwindow* create(const ivec2& size, const std::string& title) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    GLFWwindow* w = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
    if (!w)
        throw std::runtime_error("no window with OpenGL 3.3 (" + last_error() +
                                 "); use --offscreen, or midway render");
    return w;
}

}  // namespace

bool have_display(std::string& reason) {
    const char* x11 = std::getenv("DISPLAY");
    if (!x11 || !*x11) {
        reason = "DISPLAY is not set";
        return false;
    }
    if (!glfwInit()) {
        reason = last_error();
        return false;
    }
    return true;
}

Host make_window(ivec2 size, const std::string& title) {
    std::string reason;
    if (!have_display(reason))
        throw std::runtime_error("there is no display (" + reason +
                                 "); use midway-view --offscreen, or midway render");
    auto window = std::make_shared<DesktopWindow>();
    GLFWwindow* w = window->handle = create(size, title);
    glfwSetWindowUserPointer(w, window.get());
    glfwMakeContextCurrent(w);
    glfwSwapInterval(1);
    watch_events(w);
    ImGui_ImplGlfw_InitForOpenGL(w, true);

    Host host;
    host.gl = std::make_shared<Gl>(load_gl(glfwGetProcAddress));
    host.begin_frame = [window] {
        ImGui_ImplGlfw_NewFrame();
        show_presses(*window);
    };
    host.target = [w] { return target_of(w); };
    host.end_frame = [w] { glfwSwapBuffers(w); };
    host.wait = [](double seconds) {
        if (seconds < 0)
            glfwWaitEvents();
        else if (seconds == 0)
            glfwPollEvents();
        else
            glfwWaitEventsTimeout(seconds);
    };
    host.wake = [] { glfwPostEmptyEvent(); };
    host.had_event = [window] { return std::exchange(window->event, false); };
    host.closing = [w] { return glfwWindowShouldClose(w) != 0; };
    host.resize = [w](ivec2 points) { glfwSetWindowSize(w, points.x, points.y); };
    host.set_title = [w](const std::string& text) { glfwSetWindowTitle(w, text.c_str()); };
    host.dropped = [window] { return std::exchange(window->dropped, {}); };
    float across = 1, down = 1;
    glfwGetWindowContentScale(w, &across, &down);
    host.scale = std::max(across, down);
    return host;
}

}  // namespace midway
