// Which paths a scene can have, which families of strategies can make them, and which no strategy
// of a technique can (a technique covers a path if one of its strategies is
// feasible). Found from what is in the scene, before any sample.
#pragma once

#include <string>
#include <vector>

#include "render/settings.h"

namespace midway {

struct SceneFeatures {
    bool rough = false;            // surfaces that can be connected to
    bool smooth = false;           // surfaces with a delta lobe
    bool transparent = false;      // alpha below one
    bool lit = false;              // a light reaches a surface
    bool hittable_lights = false;  // also such as shine on nothing: the camera sees them
    bool delta_lights = false;
    std::string delta_light_names;  // kinds, for messages: "point, spot"
};

SceneFeatures scene_features(const Scene& scene);

struct FamilyNeed {
    std::string family;
    bool needed = false;
    std::string why;
};
std::vector<FamilyNeed> family_needs(const SceneFeatures& features);

// A kind of path: its surfaces from the camera on, 'R' where one can be connected to, 'S' where a
// delta lobe scatters, and whether its light can be hit.
struct PathKind {
    std::string surfaces;
    bool hittable = false;
    bool operator==(const PathKind&) const = default;
};

// All kinds of up to four surfaces that these families cannot make although the scene may have
// them, the short ones first: to be counted and compared.
std::vector<PathKind> kinds_not_covered(const SceneFeatures& features, const Families& families,
                                        bool direct_lamps);

// The same in words, without those that contain a shorter one.
std::vector<std::string> not_covered(const SceneFeatures& features, const Families& families,
                                     bool direct_lamps);

// Why a strategy takes no part in images with these settings, in words that fit after "left out:";
// empty where it does. `e` binds the settings to the scene (make_estimator).
std::string why_left_out(const Strategy& k, const SceneFeatures& features, const Estimator& e,
                         const RenderSettings& settings);

}  // namespace midway
