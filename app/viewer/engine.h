// What works beside the window, and how the window's state reaches it: loading, changes of the
// scene, the render. Nothing here waits. collect() brings in what is new, apply() acts on what was
// changed; both once a frame, by the UI thread.
#pragma once

#include <chrono>
#include <deque>

#include "comparing.h"
#include "inspector_engine.h"
#include "render/loader.h"
#include "state.h"
#include "tasks.h"
#include "update.h"

namespace midway {

// A job of the render, as long as its image may be on the screen: what a file of it must say.
struct SubmittedJob {
    std::uint64_t number = 0;
    std::shared_ptr<const PreparedScene> prepared;  // null once its image is no longer shown
    RenderSettings settings;
    std::chrono::steady_clock::time_point edited;  // when the change was made
    bool shown = false;
};

struct Engine {
    using Clock = std::chrono::steady_clock;

    Waker waker;  // first: outlives the threads
    LiveRender live{[this] { waker.wake(); }};
    Loader loader{[this] { waker.wake(); }};
    SceneUpdater updater{[this] { waker.wake(); }};
    Tasks tasks{[this] { waker.wake(); }};
    InspectEngine inspector{[this] { waker.wake(); }};
    ComparingEngine comparing{[this] { waker.wake(); }};

    std::deque<SubmittedJob> jobs;             // the last few, oldest first
    RenderChoices applied;                     // to the newest job
    std::shared_ptr<const Scene> coverage_of;  // what document.not_covered was found for
    std::string opening_path;                  // of what is being loaded
    std::optional<Session> opening;            // taken over when its scene is loaded
    bool reloading = false;                    // the same file again: camera and lights stay
    std::string save_later;                    // image to save at the first whole pass
    bool refit = true;          // with fit_window: make the image as large as the view
    std::optional<Clock::time_point> scene_edited;  // when the change was made that just arrived
    Clock::time_point resized;                      // the window
    Clock::time_point looked;   // at the files' stamp
};

struct News {
    bool visible = false;  // something looks different
    Change change;         // to be applied
};
News collect(App& app, Engine& engine);

// `edited`: when the frame began whose panels made the change.
void apply(App& app, Engine& engine, const Change& change, Engine::Clock::time_point edited);

// The one way to start a render: the newest scene, camera and settings.
void restart_render(App& app, Engine& engine, Engine::Clock::time_point edited);

// The settings of a render with these choices: the list of exponents is made here.
RenderSettings job_settings(const RenderChoices& choices);

// The job whose image is shown; null where none is.
const SubmittedJob* shown_job(const App& app, const Engine& engine);

// Starts loading a .gltf, .glb or .midway beside what is shown; errors go to the document.
void open_document(App& app, Engine& engine, const std::string& path);
// The same file again, as it is on the disk now.
void reload_document(App& app, Engine& engine);
// Reloads once the files have changed on the disk; looks at most once a second.
void watch_files(App& app, Engine& engine);

}  // namespace midway
