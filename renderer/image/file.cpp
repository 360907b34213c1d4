#include "image/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace midway {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& why) {
    throw std::runtime_error("cannot write file: " + one_line(why) + " (" + one_line(path) +
                             "); choose a folder that exists, can be written and has free space");
}

void write_stream(const std::string& path, const fs::path& file,
                  const std::function<void(std::ofstream&)>& write) {
    errno = 0;
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    if (!out) fail(path, std::strerror(errno));
    write(out);
    out.close();
    if (!out) fail(path, errno ? std::strerror(errno) : "not all bytes could be written");
}

// Creates an empty file that no other process or thread uses. The name does not grow with the
// target's, so a target of the longest allowed name still works.
fs::path create_beside(const std::string& path, const fs::path& target) {
    for (int i = 0; i < 1000; ++i) {
        fs::path file = target.parent_path() / (".midway-" + std::to_string(::getpid()) + "-" +
                                                std::to_string(i) + ".tmp");
        int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            ::close(descriptor);
            return file;
        }
        if (errno != EEXIST) fail(path, std::strerror(errno));
    }
    fail(path, "the folder is full of unfinished .midway-*.tmp files");
}

}  // namespace

void atomic_write(const std::string& path, const std::function<void(std::ofstream&)>& write) {
    std::error_code error;
    fs::path target(path);
    if (!target.has_filename()) fail(path, "that names no file");
    fs::file_status status = fs::status(target, error);
    if (fs::is_directory(status)) fail(path, std::strerror(EISDIR));
    if (fs::exists(status) && !fs::is_regular_file(status))
        return write_stream(path, target, write);
    if (fs::is_symlink(fs::symlink_status(target, error))) {
        fs::path real = fs::weakly_canonical(target, error);
        if (!error) target = real;
    }

    fs::path beside = create_beside(path, target);
    try {
        write_stream(path, beside, write);
        fs::rename(beside, target, error);
        if (error) fail(path, error.message());
    } catch (...) {
        fs::remove(beside, error);
        throw;
    }
}

void atomic_write(const std::string& path, std::string_view bytes) {
    atomic_write(path, [&](std::ofstream& out) {
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    });
}

std::string one_line(std::string_view text) {
    std::string line(text);
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
    return line;
}

}  // namespace midway
