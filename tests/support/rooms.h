// Rooms that need little of what a render can do, and somebody who looks at them.
#pragma once

#include "support/scenes.h"

namespace midway::test {

inline CameraDescription eye() { return camera_at({0, 1, 4}, {0, 0.5f, 0}, 0.8); }

// A floor, a ball, a lamp above; every kind of lobe, nothing textured.
inline SceneDescription plain_room() {
    SceneDescription s;
    add(s, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 2), lambert(vec3(0.6f)));
    add(s, make_quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    add(s, make_icosphere({0.7f, 0.5f, 0}, 0.5f, 2, false, true), glass(0.1f));
    add(s, make_icosphere({-0.7f, 0.5f, 0}, 0.5f, 2, false, true), plastic(0.2f));
    return s;
}

// Only mirrors and clear glass, and a lamp that is seen in the floor: nothing to connect.
inline SceneDescription mirror_room() {
    SceneDescription s;
    add(s, make_quad({-2, 0, 3.5f}, {4, 0, 0}, {0, 0, -6}, 2), metal(0, vec3(0.7f)));
    add(s, make_quad({-0.5f, 2, -2.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    add(s, make_icosphere({0.7f, 0.5f, 0}, 0.5f, 2, false, true), glass(0));
    return s;
}

// A floor, a lamp over it, and another that the camera sees and nothing else.
inline SceneDescription room_with_a_sign() {
    SceneDescription d = plain_room();
    add(d, make_quad({-3, -1, 2}, {6, 0, 0}, {0, 0.4f, 0}), lamp(vec3(9)));
    return d;
}

}  // namespace midway::test
