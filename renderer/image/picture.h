// Eight-bit pictures for a user interface: PNG and JPEG as they are stored, encoded RGBA. Scenes
// have their own reader (io/gltf_images.h), and measurements belong in EXR. Throws
// std::runtime_error with one line "WHAT (WHERE); REMEDY".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace midway {

struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // rows from the top, width * height * 4
};

// At most 4096 pixels a side.
Picture read_picture(const std::string& path);

}  // namespace midway
