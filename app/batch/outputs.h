// What a render leaves behind: images, layers, statistics.
#pragma once

#include <string>
#include <vector>

#include "render/image_metadata.h"
#include "render/pilot.h"
#include "render/renderer.h"

namespace midway {

// How the render went, beside what the renderer itself counts.
struct RunFigures {
    double seconds_render = 0, cpu_seconds = 0;
    bool interrupted = false;
    std::optional<PlanDecision> decision;  // of `auto`
};

struct OutputOptions {
    std::vector<std::string> images;  // .exr, .png, .film
    std::optional<std::string> aov, strategies, stats;
    std::string exposure = "0";  // EV of PNG files, or "auto"
};

// Throws at once for names that cannot be written later: unknown endings, folders that do not
// exist.
void check_outputs(const OutputOptions& options);

// One image of a list of exponents: the exponent joins the file's name where there are several.
void write_image(const std::string& path, const OutputOptions& options, const Image& image,
                 const std::vector<double>& exponents, size_t index, Metadata metadata);

void write_outputs(const OutputOptions& options, const PreparedScene& prepared,
                   const RenderSettings& settings, const ProgressiveRenderer& renderer,
                   const RunFigures& figures);

void write_stats(const std::string& path, const PreparedScene& prepared,
                 const RenderSettings& settings, const ProgressiveRenderer& renderer,
                 const RunFigures& figures);

}  // namespace midway
