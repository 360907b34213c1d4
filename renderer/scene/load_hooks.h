// What the loading of a scene tells those who wait for it. Empty functions are not called.
#pragma once

#include <functional>
#include <string>

namespace midway {

enum class LoadStage { reading, parsing, meshes, sky, geometry, tree, lights };

struct LoadHooks {
    // The share of the stage that is done, 0 to 1. Throwing LoadCancelled ends the load.
    std::function<void(LoadStage, double)> progress;
    // Called with every file that the scene names, before it is opened.
    std::function<void(const std::string& path)> opens;
};

// Thrown through a load by its hooks; no std::exception, since it is no failure.
struct LoadCancelled {};

}  // namespace midway
