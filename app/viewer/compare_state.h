// A and B: images that are kept, the one that the live image is compared with, the reference, and
// the curves of the error. All of it stays in memory only, and nothing here restarts a render.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "report/reference.h"
#include "viewer/error_curves.h"
#include "viewer/subject.h"

namespace midway {

// B is the live image.
enum class CompareView { live, kept, wipe, difference };

struct KeptImage {
    std::uint64_t id = 0;
    std::string name;     // "path, 128 samples, 3.1 s", or what a person called it
    std::string caption;  // short, for the picture: "path, 128 samples"
    Subject subject;
    std::shared_ptr<const Image> image;
    PixelRect place;  // in the whole image
    float mean = 0;   // luminance
};

inline constexpr size_t most_kept = 8;
inline constexpr std::uint64_t reference_id = 0;

// A file that errors are measured against.
struct LoadedReference {
    std::string path;
    std::shared_ptr<const Reference> reference;
    std::optional<KeptImage> shown;  // as A, and what it is of; absent until an image fits it
    bool fits = false;               // the size of the live image
    std::string refusal;             // why the live image is not measured against it; empty: it is
};

struct CompareState {
    std::vector<KeptImage> kept;  // oldest first
    std::uint64_t next_id = 1;
    std::optional<std::uint64_t> chosen;  // which is A: an id, or reference_id
    CompareView view = CompareView::live;
    CompareView before_flip = CompareView::live;  // where the flip goes back to
    double flip_pressed = -1;                     // in ImGui::GetTime() while the key is down
    float wipe = 0.5f;                            // share of the image's width that shows A
    bool relative = false;                        // difference over A
    float range = 0.25f, relative_range = 0.5f;   // of the colour scale, either way
    std::optional<LoadedReference> reference;

    std::optional<Subject> live;  // what the snapshot is of
    std::uint64_t live_job = 0;
    CurveMaker maker;  // of the snapshot, but for the exponent

    std::vector<LiveCurve> curves;
    std::optional<Subject> curves_subject;
    std::uint64_t curves_since = 0;  // the first job of that subject
    std::string dropped;             // why the curves before were dropped
    ErrorMetric metric = ErrorMetric::relmse;
    bool large_plot = false;
    bool watched = false;  // somebody sees the curves: their ends follow the image

    // Field of the panel.
    std::string reference_path;
};

}  // namespace midway
