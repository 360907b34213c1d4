// The subpaths of an inspected sample as lines in space, and which parts of them the camera sees.
// Positions are in the file's units. Sight is told by rays from the lens's centre, so it is exact
// at every zoom and for every lens; glass hides what is behind it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/render_control.h"
#include "report/inspect.h"

namespace midway {

enum class LineKind { camera, light, connection };

struct PathLine {
    dvec3 a{0}, b{0};
    LineKind kind = LineKind::camera;
    bool picked = false;  // belongs to the full path that is looked at
    bool hidden = false;  // behind something
};

// A vertex with its name in the table: "C0" is the lens, "L0" the light.
struct PathMark {
    dvec3 at{0};
    std::string name;
    LineKind kind = LineKind::camera;
    bool picked = false, hidden = false;
};

struct PathDrawing {
    std::vector<PathLine> lines;
    std::vector<PathMark> marks;
};

// All edges of both subpaths, and those of the full path of that number once more (below 0: none).
// What comes from infinitely far is drawn as long as `far`.
PathDrawing drawing_of(const InspectedSample& sample, int picked, double far);

// Cuts the lines where they come into sight or leave it, and tells which marks are hidden. Ends
// early where `control` says so.
PathDrawing seen_from(const Scene& scene, const Camera& camera, const PathDrawing& drawing,
                      const RenderControl& control);

// Where a point of the file's space appears on the image, in pixels; empty behind the lens.
std::optional<vec2> place_on_image(const Camera& camera, const Normalisation& normalisation,
                                   const dvec3& point);

// The part of a segment that lies before the lens, on the image; empty where none does.
struct ImageLine {
    vec2 a{0}, b{0};
};
std::optional<ImageLine> place_on_image(const Camera& camera, const Normalisation& normalisation,
                                        const dvec3& a, const dvec3& b);

}  // namespace midway
