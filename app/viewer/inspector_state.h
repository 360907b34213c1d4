// What the path inspector shows and what a person asked of it (panels/inspector.cpp). The workers
// behind it are in inspector_engine.h.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "path_lines.h"
#include "report/brightest.h"

namespace midway {

// Which sample of a pixel.
enum class Find {
    sample,          // the one of that number
    brightest,       // that gave most to the pixel, whosever it was
    brightest_pixel  // first the pixel that stands out most, then as before
};

struct InspectWish {
    std::uint64_t number = 0;  // 0: nothing was asked for yet
    Find find = Find::sample;
    ivec2 pixel{0};          // of the whole image
    std::uint64_t pass = 0;  // for Find::sample
};

// An inspected sample. Never changed once it is here.
struct Inspection {
    Inspectable what;
    InspectedSample sample;
    ivec2 watched{0};     // the pixel that was asked about; a splat comes from another one's sample
    size_t exponent = 0;  // of the settings: the one that is shown
    std::vector<int> order;  // of the paths, by what they gave to `watched`, then elsewhere
    bool searched = false;   // the sample is the brightest of those looked at
};

struct InspectorState {
    InspectWish wish;
    bool stop_search = false;  // asked for by a button

    // Of the image that is shown; absent where there is none.
    std::optional<Camera> camera;
    Normalisation normalisation;
    std::uint64_t passes = 0;

    std::shared_ptr<const Inspection> shown;
    std::uint64_t answered = 0;     // number of the wish that `shown` belongs to
    std::optional<float> progress;  // of a search under way
    std::string note;               // why there is nothing
    bool camera_moved = false;      // since: the path is seen from elsewhere
    int picked = -1;                // of shown->sample.paths

    // The lines, as the camera sees them, and what they were asked for.
    std::shared_ptr<const PathDrawing> drawing;
    bool lines_ready = false;
};

// What a path gave, to the film of the exponent that is shown.
inline vec3 given(const Inspection& i, const InspectedPath& path) {
    return path.recorded[i.exponent];
}

// Asks for a sample; the answer comes some frames later.
inline void wish_for(InspectorState& s, Find find, ivec2 pixel, std::uint64_t pass) {
    s.wish = {s.wish.number + 1, find, pixel, pass};
    s.stop_search = false;
}

}  // namespace midway
