// Sessions come back to the bit, and nothing that a stranger wrote into one is believed; the
// command line says the same as the settings.
#include "render/session.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "render/command_line.h"
#include "render/film_file.h"
#include "support/temp_dir.h"

namespace midway::test {
namespace {

namespace fs = std::filesystem;

Session rich_session() {
    Session s;
    s.scene.path = "/nowhere/scene with spaces.glb";
    s.scene.sky = "0.1,0.2,0.30000001";
    s.scene.sky_rotation_degrees = 1.0 / 3;
    s.scene.sky_strength = 0.1f;
    s.scene.lamp_strength = 1e-7f;
    s.scene.camera = "the \"main\" one";
    s.scene.look_at = {-0.1, 1e-300, 2.0 / 3, -5e17, 0.30000000000000004, -0.0};
    s.scene.fov_degrees = 33.3;
    s.scene.aperture_radius = 0.01;
    s.scene.focus_distance = 12345.678901234567;
    s.scene.edits.sky = {false, vec3(0.1f, 2, 1e-30f)};
    s.scene.edits.lights = {{.name = "bulb \"one\"",
                             .index = 3,
                             .on = false,
                             .kind = PunctualKind::spot,
                             .color = vec3(1.0f / 3, 0, 7),
                             .strength = 1e20f,
                             .inner_angle = 0.1f,
                             .outer_angle = 0.3f},
                            {.name = "", .index = 0, .kind = PunctualKind::directional}};
    s.scene.edits.materials = {{.name = "wood",
                                .index = 12,
                                .on = false,
                                .emission_color = vec3(0.1f),
                                .emission_strength = 0.7f,
                                .base_color = vec3(0.3f, 0.2f, 1.0f / 7),
                                .alpha = 0.5f,
                                .metallic = 1.0f / 3,
                                .roughness = 0.1f,
                                .ior = 1.33f,
                                .transmission = 1.0f,
                                .specular = 0.0f,
                                .double_sided = true}};
    s.settings.technique = Technique::path;
    s.settings.exponents = {0, 1, 2, 1.0 / 7};
    s.settings.families = Families{true, false, true, false};
    s.settings.width = 1280;
    s.settings.height = 720;
    s.settings.crop = PixelRect{1, 2, 300, 400};
    s.settings.max_bounces = 7;
    s.settings.seed = ~std::uint64_t{0} - 4;
    s.settings.sampler = SamplerKind::independent;
    s.settings.filter = FilterKind::box;
    s.settings.clamp = 0.7f;
    s.settings.only = {{2, 0}, {1, 3}, {4, 2}};
    s.settings.unweighted = true;
    s.limits.spp = std::uint64_t{1} << 40;
    s.limits.seconds = 0.1;
    s.window = {{"exposure", "1.5"}, {"curve", "agx"}};
    return s;
}

void expect_same(const Session& a, const Session& b) {
    EXPECT_EQ(a.scene.sky, b.scene.sky);
    EXPECT_EQ(a.scene.sky_rotation_degrees, b.scene.sky_rotation_degrees);
    EXPECT_EQ(a.scene.sky_strength, b.scene.sky_strength);
    EXPECT_EQ(a.scene.lamp_strength, b.scene.lamp_strength);
    EXPECT_EQ(a.scene.camera, b.scene.camera);
    EXPECT_EQ(a.scene.look_at, b.scene.look_at);
    EXPECT_EQ(a.scene.fov_degrees, b.scene.fov_degrees);
    EXPECT_EQ(a.scene.aperture_radius, b.scene.aperture_radius);
    EXPECT_EQ(a.scene.focus_distance, b.scene.focus_distance);
    EXPECT_EQ(a.scene.edits, b.scene.edits);
    EXPECT_EQ(settings_json(a.settings), settings_json(b.settings));
    EXPECT_EQ(a.settings.families, b.settings.families);
    EXPECT_EQ(a.limits, b.limits);
    EXPECT_EQ(a.window, b.window);
}

TEST(Session, ComesBackToTheBit) {
    const TempDir folder;
    for (const Session& s : {rich_session(), Session{{"a.glb"}, {}, {}, {}}}) {
        write_session(folder / "s.midway", s);
        const LoadedSession read = read_session(folder / "s.midway");
        expect_same(read.session, s);
        EXPECT_TRUE(read.warnings.empty());
    }
}

TEST(Session, EveryDoubleComesBack) {
    const TempDir folder;
    std::mt19937_64 random(1);
    for (int i = 0; i < 100; ++i) {
        Session s;
        s.scene.path = "a.glb";
        s.scene.look_at.emplace();
        for (double& x : *s.scene.look_at) {
            do x = std::bit_cast<double>(random());
            while (!std::isfinite(x));
        }
        write_session(folder / "s.midway", s);
        EXPECT_EQ(read_session(folder / "s.midway").session.scene.look_at, s.scene.look_at);
    }
}

TEST(Session, PathsMoveWithTheFolder) {
    const TempDir folder;
    fs::create_directories(folder / "work/sessions");
    fs::create_directories(folder / "work/scenes");
    Session s;
    s.scene.path = folder / "work/scenes/a.glb";
    s.scene.sky = folder / "work/sessions/sky.hdr";
    write_session(folder / "work/sessions/s.midway", s);
    fs::rename(folder / "work", folder / "moved");
    const Session read = read_session(folder / "moved/sessions/s.midway").session;
    EXPECT_EQ(fs::weakly_canonical(read.scene.path),
              fs::weakly_canonical(folder / "moved/scenes/a.glb"));
    EXPECT_EQ(fs::weakly_canonical(*read.scene.sky),
              fs::weakly_canonical(folder / "moved/sessions/sky.hdr"));
}

TEST(Session, PathsLeadThroughLinks) {
    const TempDir folder;
    fs::create_directories(folder / "real/deep");
    fs::create_directory_symlink(folder / "real/deep", folder / "link");
    std::ofstream(folder / "a.glb") << "x";
    Session s;
    s.scene.path = folder / "a.glb";
    write_session(folder / "link/s.midway", s);
    EXPECT_TRUE(fs::exists(read_session(folder / "link/s.midway").session.scene.path));
}

std::string error_of(const std::string& path) {
    try {
        read_session(path);
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return {};
}

TEST(Session, EveryFieldIsChecked) {
    const TempDir folder;
    const std::string path = folder / "s.midway";
    write_session(path, rich_session());
    const nlohmann::json good = nlohmann::json::parse(std::ifstream(path));
    const nlohmann::json flat = good.flatten();
    const std::vector<nlohmann::json> wrong = {nullptr,
                                               -1,
                                               0.5,
                                               1e39,
                                               "\n",
                                               true,
                                               nlohmann::json::object(),
                                               nlohmann::json::array({1}),
                                               std::string(5000, 'x')};
    int refused = 0;
    for (const auto& [pointer, value] : flat.items())
        for (const nlohmann::json& w : wrong) {
            nlohmann::json bad = good;
            bad[nlohmann::json::json_pointer(pointer)] = w;
            std::ofstream(path) << bad;
            const std::string error = error_of(path);
            if (error.empty()) continue;
            ++refused;
            EXPECT_EQ(error.find('\n'), std::string::npos) << error;
            EXPECT_LT(error.size(), 600u);
            EXPECT_NE(error.find("); "), std::string::npos) << error;
        }
    EXPECT_GT(refused, int(flat.size() * wrong.size() / 2));
    for (const char* pointer : {"/version", "/scene", "/render/width", "/render/seed",
                                "/camera/look_at/0", "/render/technique", "/limits/spp"}) {
        nlohmann::json bad = good;
        bad[nlohmann::json::json_pointer(pointer)] = nlohmann::json::object();
        std::ofstream(path) << bad;
        EXPECT_NE(error_of(path), "") << pointer;
    }
}

TEST(Session, OlderOnesAreReadAndPlainOnesStayReadable) {
    const TempDir folder;
    const std::string path = folder / "s.midway";
    Session s = rich_session();
    s.scene.edits = {};
    write_session(path, s);
    EXPECT_EQ(nlohmann::json::parse(std::ifstream(path))["version"], 1);
    expect_same(read_session(path).session, s);
    write_session(path, rich_session());
    EXPECT_EQ(nlohmann::json::parse(std::ifstream(path))["version"], 2);
}

TEST(Session, EditsOfStrangersAreChecked) {
    const TempDir folder;
    const std::string path = folder / "s.midway";
    write_session(path, rich_session());
    const nlohmann::json good = nlohmann::json::parse(std::ifstream(path));
    const std::pair<const char*, nlohmann::json> wrong[] = {
        {"/edits/materials/0/roughness", 1.5},
        {"/edits/materials/0/ior", 0.5},
        {"/edits/materials/0/base_color", {0, 0}},
        {"/edits/materials/0/base_color/2", 1.01},
        {"/edits/materials/0/emission_strength", -1},
        {"/edits/materials/0/emission_strength", 1e39},
        {"/edits/materials/0/index", -1},
        {"/edits/materials/0/index", 1e12},
        {"/edits/materials/0/double_sided", 1},
        {"/edits/lights/0/kind", "area"},
        {"/edits/lights/0/outer_angle", 1.6},
        {"/edits/lights/0/outer_angle", 0},
        {"/edits/lights/1/index", 3},  // the same as the first one's
        {"/edits/lights/0/name", std::string("a\0b", 3)},
        {"/edits/sky/on", "no"},
        {"/edits/sky/color", "red"},
        {"/edits", 3},
        {"/edits/lights", nlohmann::json::object()}};
    for (const auto& [pointer, value] : wrong) {
        nlohmann::json bad = good;
        bad[nlohmann::json::json_pointer(pointer)] = value;
        std::ofstream(path) << bad;
        EXPECT_NE(error_of(path).find("edits"), std::string::npos) << pointer << " " << value;
    }
}

TEST(Session, UnknownFieldsAreNamed) {
    const TempDir folder;
    const std::string path = folder / "s.midway";
    write_session(path, rich_session());
    nlohmann::json j = nlohmann::json::parse(std::ifstream(path));
    j["colour"] = 1;
    j["camera"]["roll"] = 2;
    std::ofstream(path) << j;
    const LoadedSession read = read_session(path);
    ASSERT_EQ(read.warnings.size(), 2u);
    EXPECT_NE(read.warnings[0].find("camera.roll"), std::string::npos);
    EXPECT_NE(read.warnings[1].find("colour"), std::string::npos);
    expect_same(read.session, rich_session());
}

TEST(Session, WhatIsNoSessionIsRefused) {
    const TempDir folder;
    const std::string path = folder / "s.midway";
    write_session(path, rich_session());
    std::ifstream in(path);
    const std::string good{std::istreambuf_iterator<char>(in), {}};
    for (size_t n = 0; n + 2 < good.size(); n += 7) {
        std::ofstream(path) << good.substr(0, n);
        EXPECT_NE(error_of(path), "") << n;
    }
    for (const std::string& text :
         {std::string("[]"), std::string("{}"), std::string(3 << 20, '['),
          std::string(5 << 20, ' ') + good, std::string("{\"format\": 3}"),
          std::string("\xff\xfe{}"),
          std::string("{\"format\": \"midway session\", \"version\": 3}"),
          std::string(
              "{\"format\": \"midway session\", \"version\": 1, \"scene\": \"b.midway\"}")}) {
        std::ofstream(path) << text;
        EXPECT_NE(error_of(path), "") << text.substr(0, 50);
    }
    EXPECT_NE(error_of(folder / "nowhere.midway"), "");
    EXPECT_NE(error_of(folder.path()), "");
}

TEST(Session, NamesThatAreNoTextAreRefusedWhenSaved) {
    const TempDir folder;
    Session s;
    s.scene.path = "\xff.glb";
    EXPECT_THROW(write_session(folder / "s.midway", s), std::runtime_error);
    EXPECT_FALSE(fs::exists(folder / "s.midway"));
}

TEST(CommandLine, SaysOnlyWhatDiffers) {
    Session s;
    s.scene.path = "idol.glb";
    EXPECT_EQ(command_line(s.scene, s.settings, s.limits, "out.exr"),
              "midway render idol.glb -o out.exr --technique bdpt");
    s.settings.technique = Technique::automatic;  // what render takes where nothing is said
    EXPECT_EQ(command_line(s.scene, s.settings, s.limits, "out.exr"),
              "midway render idol.glb -o out.exr");
    s.settings.width = 640;
    s.limits.spp = 16;
    EXPECT_EQ(command_line(s.scene, s.settings, s.limits, "out.exr"),
              "midway render idol.glb -o out.exr --size 640x512 --spp 16");
}

TEST(CommandLine, QuotesForTheShell) {
    EXPECT_EQ(shell_quoted("plain-1.5,+_/x"), "plain-1.5,+_/x");
    EXPECT_EQ(shell_quoted(""), "''");
    EXPECT_EQ(shell_quoted("a b"), "'a b'");
    EXPECT_EQ(shell_quoted("it's $HOME"), "'it'\\''s $HOME'");
    Session s;
    s.settings.technique = Technique::automatic;
    s.scene.path = "-rf.glb";
    s.scene.look_at = {-1, 0, 0, 0, 0, 0};
    EXPECT_EQ(command_line(s.scene, s.settings, s.limits, "--x.exr"),
              "midway render ./-rf.glb -o ./--x.exr --look-at=-1,0,0,0,0,0");
}

// Numbers are read back by way of long double (CLI11); the text must survive that.
TEST(CommandLine, NumbersComeBackToTheBit) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 20000; ++i) {
        double x = std::bit_cast<double>(random());
        if (!std::isfinite(x)) continue;
        SceneOptions o;
        o.path = "a.glb";
        o.fov_degrees = x;
        RenderSettings settings;
        settings.technique = Technique::automatic;
        const std::string word = command_words(o, settings, {}, "o.exr").back();
        const std::string text = word.substr(word.find('=') == std::string::npos ? 0 : 6);
        EXPECT_EQ(static_cast<double>(std::strtold(text.c_str(), nullptr)), x) << word;
    }
}

}  // namespace
}  // namespace midway::test
