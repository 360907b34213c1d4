#include "offscreen.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/osmesa.h>
#include <dlfcn.h>
#include <imgui.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>

namespace midway {
namespace {

using Clock = std::chrono::steady_clock;

// A context and its end.
struct Context {
    std::shared_ptr<void> life;
    GlLookup lookup = nullptr;
    std::string failure;
};

Context failed(std::string why) { return {{}, nullptr, std::move(why)}; }

Context egl_context() {
    const EGLDisplay display =
        eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
        return failed("EGL has no surfaceless platform");
    const std::shared_ptr<void> initialised(display, [](EGLDisplay d) { eglTerminate(d); });
    eglBindAPI(EGL_OPENGL_API);
    const EGLint wishes[] = {EGL_CONTEXT_MAJOR_VERSION,
                             3,
                             EGL_CONTEXT_MINOR_VERSION,
                             3,
                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                             EGL_NONE};
    const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wishes);
    if (context == EGL_NO_CONTEXT) return failed("EGL makes no OpenGL 3.3 context");
    const std::shared_ptr<void> life(context, [initialised](EGLContext c) {
        eglMakeCurrent(initialised.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(initialised.get(), c);
    });
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
        return failed("EGL needs a surface");
    return {life, [](const char* name) -> GlAddress { return eglGetProcAddress(name); }, {}};
}

// OSMesa's own entry points; loaded when needed, since it brings a compiler along.
struct OsMesa {
    void* library = nullptr;
    decltype(&OSMesaCreateContextAttribs) create = nullptr;
    decltype(&OSMesaMakeCurrent) make_current = nullptr;
    decltype(&OSMesaDestroyContext) destroy = nullptr;
    decltype(&OSMesaGetProcAddress) lookup = nullptr;
};

OsMesa load_osmesa() {
    OsMesa m;
    m.library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
    if (!m.library) return m;
    const auto find = [&](auto& function, const char* name) {
        function =
            reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(m.library, name));
    };
    find(m.create, "OSMesaCreateContextAttribs");
    find(m.make_current, "OSMesaMakeCurrent");
    find(m.destroy, "OSMesaDestroyContext");
    find(m.lookup, "OSMesaGetProcAddress");
    return m;
}

Context osmesa_context() {
    const OsMesa m = load_osmesa();
    if (!m.create || !m.make_current || !m.destroy || !m.lookup)
        return failed("libOSMesa.so.8 is not there");
    const int wishes[] = {OSMESA_FORMAT,
                          OSMESA_RGBA,
                          OSMESA_PROFILE,
                          OSMESA_CORE_PROFILE,
                          OSMESA_CONTEXT_MAJOR_VERSION,
                          3,
                          OSMESA_CONTEXT_MINOR_VERSION,
                          3,
                          0};
    const OSMesaContext context = m.create(wishes, nullptr);
    if (!context) return failed("OSMesa makes no OpenGL 3.3 context");
    // It wants a framebuffer of its own; the window is drawn into another one.
    auto pixels = std::make_shared<std::vector<std::uint8_t>>(16 * 16 * 4);
    const std::shared_ptr<void> life(context, [m, pixels](void* c) {
        m.make_current(nullptr, nullptr, 0, 0, 0);
        m.destroy(static_cast<OSMesaContext>(c));
    });
    if (!m.make_current(context, pixels->data(), GL_UNSIGNED_BYTE, 16, 16))
        return failed("OSMesa's context cannot be used");
    return {life, reinterpret_cast<GlLookup>(reinterpret_cast<void (*)()>(m.lookup)), {}};
}

Context make_context(OffscreenKind kind) {
    Context c;
    if (kind != OffscreenKind::osmesa) c = egl_context();
    const std::string first = c.failure;
    if (!c.lookup && kind != OffscreenKind::egl) c = osmesa_context();
    if (!c.lookup)
        throw std::runtime_error("no OpenGL without a display (" + first +
                                 (first.empty() || first == c.failure ? "" : "; ") +
                                 (first == c.failure ? "" : c.failure) +
                                 "); install libegl1 with Mesa's drivers, or libosmesa6");
    return c;
}

// What the window is drawn into.
struct Surface {
    Context context;
    std::shared_ptr<const Gl> gl;
    GlHandle framebuffer, colours;
    ivec2 size{1};
    Clock::time_point last_frame = Clock::now();
    std::mutex mutex;
    std::condition_variable woken;
    bool awake = false, event = true;

    void resize(ivec2 pixels) {
        size = glm::max(pixels, ivec2(1));
        event = true;
        gl->BindTexture(GL_TEXTURE_2D, *colours);
        gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.x, size.y, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                       nullptr);
        gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        gl->BindFramebuffer(GL_FRAMEBUFFER, *framebuffer);
        gl->FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, *colours, 0);
        if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
            throw std::runtime_error("the window cannot be drawn (" + std::to_string(size.x) + "x" +
                                     std::to_string(size.y) + "); choose a smaller size");
    }

    void begin_frame() {
        ImGuiIO& io = ImGui::GetIO();
        const auto now = Clock::now();
        const float seconds = std::chrono::duration<float>(now - last_frame).count();
        last_frame = now;
        io.DeltaTime = std::max(seconds, 1e-5f);
        io.DisplaySize = {static_cast<float>(size.x), static_cast<float>(size.y)};
    }

    void wait(double seconds) {
        std::unique_lock lock(mutex);
        if (seconds < 0)
            woken.wait(lock, [this] { return awake; });
        else
            woken.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return awake; });
        awake = false;
    }

    void wake() {
        const std::lock_guard lock(mutex);
        awake = true;
        woken.notify_one();
    }
};

}  // namespace

Host make_offscreen(ivec2 size, float scale, OffscreenKind kind) {
    auto surface = std::make_shared<Surface>();
    surface->context = make_context(kind);
    surface->gl = std::make_shared<Gl>(load_gl(surface->context.lookup));
    surface->framebuffer = make_framebuffer(*surface->gl);
    surface->colours = make_texture(*surface->gl);
    // As on X11, a monitor of scale 2 gets a window of twice the pixels.
    surface->resize(ivec2(vec2(size) * scale));

    Host host;
    host.gl = surface->gl;
    host.begin_frame = [surface] { surface->begin_frame(); };
    host.target = [surface] { return Display::Target{*surface->framebuffer, surface->size, 1}; };
    host.end_frame = [surface] { surface->gl->Finish(); };
    host.wait = [surface](double seconds) { surface->wait(seconds); };
    host.wake = [surface] { surface->wake(); };
    host.had_event = [surface] { return std::exchange(surface->event, false); };
    host.closing = [] { return false; };
    host.resize = [surface](ivec2 pixels) { surface->resize(pixels); };
    host.set_title = [](const std::string&) {};
    host.dropped = [] { return std::vector<std::string>(); };
    host.scale = scale;
    return host;
}

}  // namespace midway
