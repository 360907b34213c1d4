// The command line that a window copies makes the window's bits: every set of choices is rendered
// by LiveRender, then by the program through a real shell.
#include "render/command_line.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <thread>

#include "render/live_render.h"
#include "support/temp_dir.h"

namespace midway::test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t passes = 3;

std::shared_ptr<const Snapshot> render_live(const PreparedScene& prepared,
                                            const RenderSettings& settings) {
    LiveRender live;
    LiveJob job;
    job.scene = prepared.scene;
    job.camera = prepared.camera;
    job.settings = settings;
    job.threads = 2;
    job.stop_passes = passes;
    live.submit(job);
    for (int i = 0; i < 6000; ++i) {
        const auto s = live.snapshot();
        if (s && s->finished) return s;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {};
}

// The image of an exponent: several exponents make several files (out.b2.exr).
Image read_exponent(const fs::path& out, const RenderSettings& s, size_t i) {
    if (s.exponents.size() == 1) return read_image(out.string()).image;
    char ending[32];
    std::snprintf(ending, sizeof ending, ".b%g.exr", s.exponents[i]);
    return read_image(fs::path(out).replace_extension().string() + ending).image;
}

void expect_same_bits(const SceneOptions& options, const RenderSettings& settings) {
    const TempDir folder;
    const fs::path out = folder / "a picture.exr";
    const auto live = render_live(prepare_scene(options), settings);
    ASSERT_TRUE(live);
    ASSERT_EQ(live->error, "");
    const std::string session = folder / "a session.midway";
    if (!options.edits.empty()) write_session(session, {options, settings, {}, {}});
    std::string line = options.edits.empty()
                           ? command_line(options, settings, {live->passes, {}}, out.string())
                           : session_command_line(session, {live->passes, {}}, out.string());
    ASSERT_EQ(line.rfind("midway ", 0), 0u);
    line.replace(0, 6, shell_quoted(MIDWAY_PROGRAM));
    ASSERT_EQ(std::system((line + " --quiet --threads 1").c_str()), 0) << line;
    for (size_t i = 0; i < settings.exponents.size(); ++i)
        EXPECT_TRUE(read_exponent(out, settings, i).pixels == live->images[i]->pixels)
            << line << "\nexponent " << settings.exponents[i];
}

TEST(CommandLine, MakesTheBitsOfTheWindow) {
    const TempDir folder;
    SceneOptions scene;
    scene.path = folder / "it's a $scene.glb";
    fs::copy_file(fs::path(MIDWAY_SOURCE_DIR) / "assets/cornell.glb", scene.path);
    RenderSettings usual;
    usual.width = 33;
    usual.height = 21;

    struct Choices {
        const char* what;
        void (*choose)(SceneOptions&, RenderSettings&);
    };
    const Choices sets[] = {
        {"nothing", [](SceneOptions&, RenderSettings&) {}},
        {"a camera", [](SceneOptions& o, RenderSettings&) { o.camera = "0"; }},
        {"a view of many digits",
         [](SceneOptions& o, RenderSettings&) {
             o.look_at = {-0.1 / 3, 1.0000000000000002, 2.0 / 3, 1e-17, 0.9, -0.30000000000000004};
             o.fov_degrees = 100.0 / 3;
         }},
        {"a lens",
         [](SceneOptions& o, RenderSettings&) {
             o.aperture_radius = 0.1 / 7;
             o.focus_distance = 10.0 / 7;
         }},
        {"a sky and dimmed lamps",
         [](SceneOptions& o, RenderSettings&) {
             o.sky = "0.1,0.25,1e-1";
             o.sky_rotation_degrees = -33.3;
             o.sky_strength = 1.0f / 3;
             o.lamp_strength = 0.1f;
         }},
        {"path", [](SceneOptions&, RenderSettings& s) { s.technique = Technique::path; }},
        {"light", [](SceneOptions&, RenderSettings& s) { s.technique = Technique::light; }},
        {"exponents",
         [](SceneOptions&, RenderSettings& s) {
             s.exponents = {0, 1, 2, 1.1 / 3};
         }},
        {"an exponent", [](SceneOptions&, RenderSettings& s) { s.exponents = {3.3333}; }},
        {"families",
         [](SceneOptions&, RenderSettings& s) {
             s.families = Families{true, false, true, false};
         }},
        {"no families",
         [](SceneOptions&, RenderSettings& s) {
             s.families = Families{false, false, false, false};
         }},
        {"a crop and a large seed",
         [](SceneOptions&, RenderSettings& s) {
             s.crop = PixelRect{3, 2, 30, 20};
             s.seed = ~std::uint64_t{0};
         }},
        {"samplers and filters",
         [](SceneOptions&, RenderSettings& s) {
             s.sampler = SamplerKind::independent;
             s.filter = FilterKind::gaussian;
             s.max_bounces = 2;
         }},
        {"strategies alone, bare and clamped",
         [](SceneOptions&, RenderSettings& s) {
             s.only = {{2, 1}, {3, 0}, {1, 3}};
             s.unweighted = true;
             s.clamp = 0.1f;
         }},
        {"edits of lights and materials",
         [](SceneOptions& o, RenderSettings& s) {
             o.look_at = {-0.1 / 3, 1.0000000000000002, 2.0 / 3, 1e-17, 0.9, -0.30000000000000004};
             o.sky = "0.1,0.25,1e-1";
             o.edits.sky.color = vec3(1.0f / 3);
             const PreparedScene p = prepare_scene({.path = o.path});
             for (int k = 0; k < static_cast<int>(p.file->materials.size()); ++k) {
                 MaterialEdit e = edit_of(o.edits, p.file->materials, k);
                 e.roughness = 0.1f + 0.07f * static_cast<float>(k);
                 e.base_color = vec3(0.1f, 1.0f / 3, 0.7f);
                 e.emission_strength = k == 0 ? 0.3f : 1.0f / 7;
                 set_edit(o.edits, p.file->materials, k, e);
             }
             s.exponents = {1};
         }},
    };
    for (const Choices& c : sets) {
        SCOPED_TRACE(c.what);
        SceneOptions o = scene;
        RenderSettings s = usual;
        c.choose(o, s);
        expect_same_bits(o, s);
    }
}

}  // namespace
}  // namespace midway::test
