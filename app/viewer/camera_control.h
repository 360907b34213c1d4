// Moving the camera by hand: pure functions from a view and a gesture to the next view. Lengths are
// in the file's units, +y is up, angles in radians; pixels are continuous image coordinates with
// (0, 0) at the upper left corner. Nothing depends on how often it is called: a second of flight is
// the same in one step or in a hundred. Throws nothing.
#pragma once

#include <optional>

#include "render/prepare.h"

namespace midway {

struct View {
    dvec3 eye{0, 0, 1}, target{0};
    double yfov = 0.7;  // vertical
};

// Size of the image that pixels refer to.
struct Viewport {
    double width = 1, height = 1;
};

// Unit vectors of a view, the same that the renderer's look_at() makes.
struct ViewBasis {
    dvec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
};
ViewBasis view_basis(const View& view);

// The view of a camera whose target lies at `distance`. Roll is lost: +y is up.
View view_of(const CameraDescription& camera, double distance);

// Where the wishes put the camera; what they leave open is as in `camera`, and the target then as
// far as the pivot is.
View view_in(const SceneOptions& options, const CameraDescription& camera, const dvec3& pivot);

// Writes the view into the wishes; the field of view only where it differs from the one in use.
void use_view(const View& view, const CameraDescription& camera, SceneOptions& options);

// Direction through a pixel, of length one along the view axis.
dvec3 pixel_direction(const View& view, const Viewport& viewport, const dvec2& pixel);

// Where a point appears; empty behind the eye.
std::optional<dvec2> project(const View& view, const Viewport& viewport, const dvec3& point);

// Distance along the view axis: what a thin lens is focused to.
double depth_of(const View& view, const dvec3& point);

// What is seen at a pixel, in the file's units; empty where the sky is.
std::optional<dvec3> surface_at(const Scene& scene, const View& view, const Viewport& viewport,
                                const dvec2& pixel);

// The object seen at a pixel: its index in the geometry, and the point of it in the file's units.
struct PickedObject {
    int object = -1;
    dvec3 point{0};
};
std::optional<PickedObject> object_at(const Scene& scene, const View& view,
                                      const Viewport& viewport, const dvec2& pixel);

// Where the view axis meets the scene, or passes nearest to its centre: a first pivot.
dvec3 natural_pivot(const Scene& scene, const View& view);

// Radius of the scene in the file's units.
double scene_radius(const Scene& scene);

// Turns eye and target about `pivot`, which keeps its place in the image: half a turn for a drag
// over the image's height. Never over the poles.
View orbit(const View& view, const dvec3& pivot, const dvec2& drag, const Viewport& viewport);

// Turns the target about the eye, towards where the mouse goes.
View look_around(const View& view, const dvec2& drag, const Viewport& viewport);

// Moves in the image plane so that `held` appears at `pixel`.
View pan(const View& view, const Viewport& viewport, const dvec3& held, const dvec2& pixel);

// Scales the view about `towards`, which keeps its place in the image; factor < 1 approaches. Stops
// a ten-thousandth of the scene's radius before the point, and a thousand radii away.
View dolly(const View& view, const dvec3& towards, double factor, double radius);

// Moves back or forth along the view's direction until the bounds just fill the image.
View frame(const View& view, const Bounds& bounds, double aspect);

// What a wheel still has to do.
struct DollyGlide {
    dvec3 towards{0};
    double log_factor = 0;
};
// Does the share of it that belongs to `seconds`; half of the rest every 40 ms.
View advance(DollyGlide& glide, const View& view, double radius, double seconds);

// From view to view in a quarter of a second, starting and ending gently.
struct ViewGlide {
    View from, to;
    double elapsed = 0;
};
inline constexpr double glide_seconds = 0.25;
View glide_view(const ViewGlide& glide);
inline bool finished(const ViewGlide& glide) { return glide.elapsed >= glide_seconds; }

// Wishes of a pilot, each in -1..1, and the speed that one stands for, in units per second.
struct FlyInput {
    double forward = 0, right = 0, up = 0;
    double speed = 1;
};
// Moves eye and target; the velocity follows the wish with a half-life of 60 ms.
View fly(const View& view, dvec3& velocity, const FlyInput& input, double seconds);
bool is_moving(const dvec3& velocity, const FlyInput& input);

}  // namespace midway
