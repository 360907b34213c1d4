// Radiance HDR (RGBE) in: rows from the top (-Y +X), flat or run-length encoded; other orientations
// and XYZE are refused. The EXPOSURE line is not applied. Decoding is stb_image's.
// Throws std::runtime_error with one line "WHAT (WHERE); REMEDY".
#pragma once

#include <string>

#include "image/image.h"

namespace midway {

LoadedImage read_hdr(const std::string& path);

}  // namespace midway
