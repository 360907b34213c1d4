// References that a comparison renders itself: the technique that converges best in a pilot, with
// seeds of their own. A reference is kept as films, one for each of its seeds, named by scene and
// settings; a later run that asks for more time goes on from them. Throws std::runtime_error where
// a file cannot be read or written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/comparison.h"
#include "report/convergence.h"
#include "report/reference.h"

namespace midway {

struct ReferencePlan {
    const PreparedScene* scene = nullptr;
    std::string name;  // of the scene, for file names
    RenderSettings
        settings;  // technique, exponent and seed apart, what the reference is rendered with
    std::vector<TechniqueChoice> candidates;
    double seconds = 0, pilot_seconds = 0;
    int threads = 0;
    std::string folder;
};

struct RenderedReference {
    Reference reference;
    ReferenceInfo info;  // without the floor
};

// Empty where it was stopped before its time; what was done is kept.
std::optional<RenderedReference> render_reference(const ReferencePlan& plan,
                                                  const CompareHooks& hooks);

}  // namespace midway
