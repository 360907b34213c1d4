// Loading beside a window: results of the newest request alone, errors in one line, and nobody
// waits. tests/run runs these cases under the thread sanitizer too.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "render/live_render.h"
#include "render/loader.h"
#include "support/temp_dir.h"
#include "support/tier.h"

namespace midway::test {
namespace {

namespace fs = std::filesystem;

// One triangle that shines; its buffer is a file of its own.
std::string write_scene(const TempDir& folder, const std::string& name, float emission = 1) {
    std::ofstream bin(folder / (name + " data.bin"), std::ios::binary);
    const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    bin.write(reinterpret_cast<const char*>(corners), sizeof corners);
    const std::string path = folder / (name + ".gltf");
    std::ofstream out(path);
    out << R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36, "uri": ")" << name
        << R"(%20data.bin"}], "bufferViews": [{"buffer": 0, "byteLength": 36}],)"
        << R"("accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",)"
        << R"("min": [0, 0, 0], "max": [1, 1, 0]}],)"
        << R"("materials": [{"emissiveFactor": [)" << emission << R"(, 1, 1]}],)"
        << R"("meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],)"
        << R"("nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})";
    return path;
}

SceneOptions options(const std::string& path) {
    SceneOptions o;
    o.path = path;
    return o;
}

// The result of the newest request; empty after a minute.
std::optional<LoadResult> wait_for(Loader& loader) {
    for (int i = 0; i < 12000; ++i) {
        if (auto result = loader.take()) return result;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return {};
}

TEST(Loader, LoadsWhatPrepareSceneDoes) {
    const TempDir folder;
    const std::string path = write_scene(folder, "a");
    std::atomic<int> news = 0;
    Loader loader([&] { ++news; });
    const std::uint64_t number = loader.load(options(path));
    const auto result = wait_for(loader);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->request, number);
    EXPECT_EQ(result->error, "");
    EXPECT_EQ(result->prepared->hash, prepare_scene(options(path)).hash);
    EXPECT_FALSE(loader.take());
    EXPECT_FALSE(loader.status().busy);
    EXPECT_GT(news, 1);
}

TEST(Loader, SaysInOneLineWhatIsBroken) {
    const TempDir folder;
    std::ofstream(folder / "broken.gltf") << "{\"asset\":\n";
    Loader loader;
    for (const std::string path : {folder / "broken.gltf", folder / "nowhere.glb"}) {
        loader.load(options(path));
        const auto result = wait_for(loader);
        ASSERT_TRUE(result);
        EXPECT_FALSE(result->prepared);
        EXPECT_NE(result->error, "");
        EXPECT_EQ(result->error.find('\n'), std::string::npos);
        EXPECT_EQ(result->files, std::vector<std::string>{path});
    }
    SceneOptions wrong = options(write_scene(folder, "a"));
    wrong.fov_degrees = 400;
    loader.load(wrong);
    const auto result = wait_for(loader);
    ASSERT_TRUE(result);
    EXPECT_NE(result->error, "");
}

TEST(Loader, KnowsTheFilesOfASceneAndSeesThemChange) {
    const TempDir folder;
    SceneOptions o = options(write_scene(folder, "a"));
    o.sky = folder / "sky.hdr";
    const std::vector<std::string> files = scene_files(o);
    EXPECT_EQ(files, (std::vector<std::string>{folder / "a.gltf", folder / "a data.bin",
                                               folder / "sky.hdr"}));
    const std::uint64_t before = file_stamp(files);
    EXPECT_EQ(file_stamp(files), before);
    for (const std::string& file : {files[2], files[1], files[0]}) {
        const std::uint64_t stamp = file_stamp(files);
        std::ofstream(file, std::ios::app) << " ";
        EXPECT_NE(file_stamp(files), stamp) << file;
    }
    const std::uint64_t stamp = file_stamp(files);
    fs::last_write_time(files[1], fs::last_write_time(files[1]) + std::chrono::seconds(2));
    EXPECT_NE(file_stamp(files), stamp);
    fs::remove(files[1]);
    EXPECT_NE(file_stamp(files), stamp);
}

TEST(Loader, GivesTheNewestRequestAlone) {
    const TempDir folder;
    std::vector<std::string> paths;
    for (int i = 0; i < 3; ++i) paths.push_back(write_scene(folder, std::to_string(i), 1.0f + i));
    Loader loader;
    std::mt19937 random(3);
    const int rounds = by_tier(60, 400);
    for (int i = 0; i < rounds; ++i) {
        const std::string& path = paths[random() % 3];
        const std::uint64_t number = loader.load(options(path));
        if (random() % 3 == 0)
            std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
        if (random() % 4 == 0) loader.cancel();
        if (const auto result = loader.take()) {
            EXPECT_EQ(result->request, number);
            EXPECT_EQ(result->options.path, path);
            EXPECT_TRUE(result->prepared);
        }
    }
    loader.cancel();
    EXPECT_FALSE(loader.status().busy);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_FALSE(loader.take());
    loader.load(options(paths[1]));
    const auto last = wait_for(loader);
    ASSERT_TRUE(last);
    EXPECT_EQ(last->options.path, paths[1]);
}

// Load, edit, render and look at once, as a window does.
TEST(Loader, LoadsWhileJobsAreRenderedAndEdited) {
    const TempDir folder;
    std::vector<std::string> paths;
    for (int i = 0; i < 3; ++i) paths.push_back(write_scene(folder, std::to_string(i), 1.0f + i));
    Loader loader;
    LiveRender live;
    std::mt19937 random(5);
    std::shared_ptr<const PreparedScene> open;
    const int rounds = by_tier(100, 500);
    for (int i = 0; i < rounds; ++i) {
        if (random() % 8 == 0 && !loader.status().busy) loader.load(options(paths[random() % 3]));
        if (auto result = loader.take()) open = result->prepared;
        if (open) {
            SceneOptions edited = open->options;
            edited.look_at = {0.3, 0.2, 2 + 0.01 * i, 0.3, 0.3, 0};
            if (random() % 2) edited.lamp_strength = 1.0f + 0.1f * static_cast<float>(random() % 5);
            open = std::make_shared<PreparedScene>(update_scene(*open, edited));
            LiveJob job;
            job.scene = open->scene;
            job.camera = open->camera;
            job.settings.width = job.settings.height = 64;
            job.threads = 2;
            live.submit(job);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 6));
    }
    EXPECT_TRUE(open || wait_for(loader));
}

}  // namespace
}  // namespace midway::test
