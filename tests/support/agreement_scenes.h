// Small scenes for the tests that set techniques against each other: one per kind of light and of
// surface. All objects float apart from each other, since where two surfaces meet the connections
// of naive weights have no finite variance and no z-test could judge them. Lamps are out of view.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace midway::test {

struct AgreementScene {
    std::string name;
    std::shared_ptr<const Scene> scene;
    CameraDescription camera;
    // What the camera's first edges may meet; tells what light tracing covers.
    bool sees_smooth = false;
    // A caustic that only light subpaths find well: `path` and `light` are held to less.
    bool caustic = false;
    int max_bounces = 5;
};

// The names of all scenes; make_agreement_scene() builds one. Throws for unknown names.
std::vector<std::string> agreement_scene_names();
// Those and a few with lobes nearly as narrow as rough ones get, whose images are too noisy to be
// set against each other by naive weights, but whose weights can be checked path by path.
std::vector<std::string> oracle_scene_names();
AgreementScene make_agreement_scene(const std::string& name);

// A scene file as a batch render sees it, with its first camera; `sky` as in `--sky`, may be empty.
AgreementScene load_agreement_scene(const std::string& path, const std::string& sky);

}  // namespace midway::test
