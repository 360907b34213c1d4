// The workers behind the path inspector: one replays samples and searches for bright ones, one
// tells which parts of the lines are in sight. The UI thread waits for neither.
#pragma once

#include <functional>

#include "newest.h"
#include "state.h"

namespace midway {

struct Engine;

struct InspectTask {
    InspectWish wish;
    Inspectable what;
    ivec2 of{0};  // whose sample it is, for Find::sample
    size_t exponent = 0;
    std::uint64_t passes = 1;
    int threads = 0;
    // For Find::brightest_pixel, of the crop.
    std::shared_ptr<const Image> image, variance;
};

struct InspectNews {
    std::uint64_t wish = 0;
    std::shared_ptr<const Inspection> inspection;  // the best so far
    std::optional<float> progress;                 // absent: this is the end
    std::string note;                              // in words, where there is nothing to show
};

// Carries out a task; calls `publish` whenever there is something new.
void inspect(const InspectTask& task, const RenderControl& control,
             const std::function<void(InspectNews)>& publish);

struct SightTask {
    std::shared_ptr<const Inspection> inspection;
    int picked = -1;
    Camera camera;
};

struct InspectEngine {
    explicit InspectEngine(const std::function<void()>& wake);

    NewestWorker<InspectTask, InspectNews> sampler;
    NewestWorker<SightTask, std::shared_ptr<const PathDrawing>> sight;

    // What the workers were asked for last.
    std::uint64_t wish = 0;
    std::uint64_t job = 0;  // that was looked at
    std::string path;       // of its file
    std::shared_ptr<const Inspection> sight_of;
    int sight_picked = -1;
    std::uint64_t sight_job = 0;
};

// Brings in what the workers have found, and from where the image is seen that is shown now; true
// where something looks different.
bool collect_inspection(App& app, Engine& engine);

// Asks them for what the panel wants of the image that is shown. An inspected sample outlives a
// move of the camera (it stays where it is in space); after any other change the same sample of the
// same pixel is computed anew, and forgotten where the image has become another one.
void follow_inspection(App& app, Engine& engine);

}  // namespace midway
