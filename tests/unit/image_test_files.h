// What the image tests share: a folder of their own that goes away, files as bytes, and the check
// that a failure is one line "WHAT (WHERE); REMEDY".
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "support/temp_dir.h"

namespace midway::test {

struct TempFolder {
    TempDir dir;

    std::string file(const std::string& name) const { return (dir / name).string(); }
    int entries() const {
        return static_cast<int>(std::distance(std::filesystem::directory_iterator(dir.path()), {}));
    }
};

inline std::string file_bytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void put_bytes(const std::string& path, const std::string& bytes) {
    std::filesystem::remove(path);  // some file systems flush a file that is cut to nothing
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// The message of the std::runtime_error that f throws; empty (and a failure) where it throws none.
template <class F>
std::string one_line_error(F f) {
    std::string message;
    try {
        f();
    } catch (const std::runtime_error& error) {
        message = error.what();
    }
    EXPECT_FALSE(message.empty()) << "nothing was thrown";
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find(" ("), std::string::npos) << message;
    EXPECT_NE(message.find("); "), std::string::npos) << message;
    return message;
}

}  // namespace midway::test
