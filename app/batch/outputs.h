// What a render leaves behind: images, layers, statistics.
#pragma once

#include <string>
#include <vector>

#include "render/prepare.h"
#include "render/renderer.h"

namespace midway {

// How the render went, beside what the renderer itself counts.
struct RunFigures {
    double seconds_render = 0, cpu_seconds = 0;
    bool interrupted = false;
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

std::string hex_hash(std::uint64_t hash);

void write_outputs(const OutputOptions& options, const PreparedScene& prepared,
                   const RenderSettings& settings, const ProgressiveRenderer& renderer,
                   const RunFigures& figures);

void write_stats(const std::string& path, const PreparedScene& prepared,
                 const RenderSettings& settings, const ProgressiveRenderer& renderer,
                 const RunFigures& figures);

// Settings, seed, samples, scene hash and version: the header of every image.
Metadata image_metadata(const PreparedScene& prepared, const RenderSettings& settings,
                        const ProgressiveRenderer& renderer);

}  // namespace midway
