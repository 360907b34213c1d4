#include "image/image.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "image/exr.h"
#include "image/file.h"
#include "image/hdr.h"

namespace midway {

LoadedImage read_image(const std::string& path) {
    std::error_code error;
    std::filesystem::file_status status = std::filesystem::status(path, error);
    errno = 0;
    std::ifstream in(path, std::ios::binary);
    if (!in || (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))) {
        std::string why = errno ? std::strerror(errno) : "not a regular file";
        throw std::runtime_error("cannot open image: " + why + " (" + one_line(path) +
                                 "); check the name and that it may be read");
    }
    char magic[4] = {};
    in.read(magic, sizeof magic);
    if (in && std::memcmp(magic, "\x76\x2f\x31\x01", 4) == 0) return read_exr(path);
    if (in && std::memcmp(magic, "#?R", 3) == 0) return read_hdr(path);
    throw std::runtime_error("not an image of a kind that can be read (" + one_line(path) +
                             "); give an OpenEXR or a Radiance HDR file");
}

}  // namespace midway
