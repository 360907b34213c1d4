#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "image/file.h"
#include "image/image.h"
#include "image/png.h"
#include "unit/image_test_files.h"

namespace midway {
namespace {

using test::file_bytes;
using test::one_line_error;
using test::put_bytes;
using test::TempFolder;

// A full disk, for as long as this lives: no file may grow past 1000 bytes.
struct FullDisk {
    rlimit before{};
    FullDisk() {
        ::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &before);
        rlimit small{1000, before.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &small);
    }
    ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before); }
};

// Root may write anywhere, so the test is somebody else for as long as this lives.
struct OrdinaryUser {
    OrdinaryUser() {
        if (::geteuid() == 0) {
            EXPECT_EQ(::seteuid(65534), 0);
        }
    }
    ~OrdinaryUser() {
        if (::getuid() == 0) {
            EXPECT_EQ(::seteuid(0), 0);
        }
    }
};

Image noise_image() {
    Image image(64, 64);
    uint32_t state = 1;
    for (vec3& p : image.pixels)
        for (int c = 0; c < 3; ++c) {
            state = state * 1664525u + 1013904223u;
            p[c] = static_cast<float>(state >> 8) / 16777216.0f;
        }
    return image;
}

TEST(AtomicWrite, CreatesAndReplaces) {
    TempFolder folder;
    const std::string bytes("a\0b\r\n", 5);
    atomic_write(folder.file("x"), "something longer than what follows");
    atomic_write(folder.file("x"), bytes);
    EXPECT_EQ(file_bytes(folder.file("x")), bytes);
    EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicWrite, HonoursTheUmask) {
    TempFolder folder;
    const mode_t before = ::umask(022);
    atomic_write(folder.file("x"), "1");
    ::umask(before);
    struct stat status {};
    ASSERT_EQ(::stat(folder.file("x").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0644u);
}

TEST(AtomicWrite, TakesTheLongestName) {
    TempFolder folder;
    const std::string path = folder.file(std::string(255, 'n'));
    atomic_write(path, "1");
    EXPECT_EQ(file_bytes(path), "1");
}

TEST(AtomicWrite, TakesARelativeName) {
    TempFolder folder;
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.dir.path());
    atomic_write("x", "1");
    std::filesystem::current_path(before);
    EXPECT_EQ(file_bytes(folder.file("x")), "1");
}

TEST(AtomicWrite, FollowsALink) {
    TempFolder folder;
    put_bytes(folder.file("real"), "old");
    std::filesystem::create_symlink("real", folder.file("link"));
    atomic_write(folder.file("link"), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
    EXPECT_EQ(file_bytes(folder.file("real")), "new");
}

TEST(AtomicWrite, LeavesDevicesInPlace) {
    atomic_write("/dev/null", "1");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    const std::string message = one_line_error([] { atomic_write("/dev/full", "1"); });
    EXPECT_NE(message.find("/dev/full"), std::string::npos) << message;
}

TEST(AtomicWrite, RefusesFoldersAndMissingFolders) {
    TempFolder folder;
    for (const std::string& path : {folder.dir.path().string(), folder.dir.path().string() + "/",
                                    folder.file("missing/x"), std::string()}) {
        const std::string message = one_line_error([&] { atomic_write(path, "1"); });
        EXPECT_NE(message.find(path), std::string::npos) << message;
    }
    EXPECT_EQ(folder.entries(), 0);
}

TEST(AtomicWrite, AFailingWriterKeepsTheOldFile) {
    TempFolder folder;
    put_bytes(folder.file("x"), "old");
    EXPECT_THROW(atomic_write(folder.file("x"),
                              [](std::ofstream& out) {
                                  out << "half";
                                  throw std::runtime_error("stop");
                              }),
                 std::runtime_error);
    EXPECT_EQ(file_bytes(folder.file("x")), "old");
    EXPECT_EQ(folder.entries(), 1);
}

TEST(AtomicWrite, AFullDiskKeepsTheOldFile) {
    TempFolder folder;
    const Image image = noise_image();
    for (const char* name : {"x.bin", "x.exr", "x.png"}) put_bytes(folder.file(name), "old");
    {
        FullDisk full;
        one_line_error([&] { atomic_write(folder.file("x.bin"), std::string(5000, 'a')); });
        one_line_error([&] { write_exr(folder.file("x.exr"), {{"", image}}, {}); });
        one_line_error([&] { write_png(folder.file("x.png"), image, {}); });
    }
    for (const char* name : {"x.bin", "x.exr", "x.png"})
        EXPECT_EQ(file_bytes(folder.file(name)), "old") << name;
    EXPECT_EQ(folder.entries(), 3);
}

TEST(AtomicWrite, AReadOnlyFolderStaysEmpty) {
    TempFolder folder;
    const Image image = noise_image();
    std::filesystem::permissions(folder.dir.path(), std::filesystem::perms(0555));
    {
        OrdinaryUser user;
        one_line_error([&] { atomic_write(folder.file("x.bin"), "1"); });
        one_line_error([&] { write_exr(folder.file("x.exr"), {{"", image}}, {}); });
        one_line_error([&] { write_png(folder.file("x.png"), image, {}); });
    }
    std::filesystem::permissions(folder.dir.path(), std::filesystem::perms(0755));
    EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace midway
