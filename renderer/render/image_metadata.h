// The header of an image file: how the picture was made, in program, window and shards alike.
#pragma once

#include <string>

#include "render/prepare.h"
#include "render/settings.h"

namespace midway {

// Settings, seed, samples, scene hash and version. `passes` are samples per pixel.
Metadata image_metadata(const PreparedScene& prepared, const RenderSettings& settings,
                        std::uint64_t passes, std::uint64_t clamped);

// Which of the settings' exponents the image belongs to.
void set_exponent(Metadata& metadata, double exponent);

std::string hex_hash(std::uint64_t hash);

}  // namespace midway
