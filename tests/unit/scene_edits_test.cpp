// Edits of lights and materials: they find their place again, they come back to the file's values
// to the bit, and a scene that was edited step by step is the one that is loaded with the edits.
#include "render/scene_edits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "render/prepare.h"
#include "render/renderer.h"
#include "support/assets.h"
#include "support/scenes.h"

namespace midway::test {
namespace {

std::vector<vec3> pixels(const PreparedScene& p) {
    ProgressiveRenderer r(p.scene, p.camera, settings(Technique::bdpt, 8, 4), {});
    r.render_passes(1);
    return r.image().pixels;
}

std::vector<Material> materials(const std::vector<std::string>& names) {
    std::vector<Material> list;
    for (const std::string& name : names) list.emplace_back().name = name;
    return list;
}

TEST(SceneEdits, FindTheirPlaceInAFileExportedAnew) {
    const std::vector<MaterialEdit> edits = {
        {.name = "wood", .index = 1}, {.name = "steel", .index = 2}, {.name = "", .index = 3}};
    using List = std::vector<int>;
    EXPECT_EQ(places(edits, materials({"a", "wood", "steel", ""})), (List{1, 2, 3}));
    EXPECT_EQ(places(edits, materials({"wood", "a", "b", "steel"})), (List{0, 3, -1}));
    // Which of two is meant, only the index can tell.
    EXPECT_EQ(places(edits, materials({"wood", "a", "steel", "wood"})), (List{-1, 2, -1}));
    EXPECT_EQ(places(edits, materials({"wood", "wood", "steel"})), (List{1, 2, -1}));
    EXPECT_EQ(places(edits, {}), (List{-1, -1, -1}));
    // The first edit of a place counts.
    const std::vector<MaterialEdit> twice = {{.name = "wood", .index = 0},
                                             {.name = "wood", .index = 7}};
    EXPECT_EQ(places(twice, materials({"wood"})), (List{0, -1}));
    const std::vector<MaterialEdit> far = {{.name = "wood", .index = -5},
                                           {.name = "x", .index = 1 << 30}};
    EXPECT_EQ(places(far, materials({"wood"})), (List{0, -1}));
}

TEST(SceneEdits, ValuesOfTheFileAreNoEdits) {
    std::vector<Material> file = materials({"a", "b"});
    file[1].roughness = 0.3f;
    file[1].emission = {2, 1, 0.5f};
    SceneEdits edits;
    MaterialEdit e = edit_of(edits, file, 1);
    e.roughness = 0.4f;
    e.emission_strength = 3.0f;
    set_edit(edits, file, 1, e);
    ASSERT_EQ(edits.materials.size(), 1u);
    EXPECT_EQ(edits.materials[0].name, "b");
    EXPECT_EQ(edits_in_words(edits),
              std::vector<std::string>{"material \"b\": emission_strength 3, roughness 0.4"});
    e.roughness = 0.3f;
    e.emission_strength = 2.0f;
    set_edit(edits, file, 1, e);
    EXPECT_TRUE(edits.empty());
    e.on = false;
    set_edit(edits, file, 1, e);
    EXPECT_FALSE(edits.empty());
    EXPECT_EQ(edited(file[1], edits.materials[0]).emission, vec3(0));
    EXPECT_EQ(values_of(file[1], edits.materials[0]).emission, file[1].emission);
}

TEST(SceneEdits, WhatIsNotFiniteOrOutOfRangeIsRefused) {
    const float wrong[] = {-1, std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::quiet_NaN(), 1e31f};
    int tried = 0;
    const auto refuse = [&](auto edit, auto place) {
        visit_values(edit, [&](const char* name, auto& value, float, float) {
            using T = std::remove_cvref_t<decltype(value)>;
            for (const float x : wrong) {
                if constexpr (std::is_same_v<T, std::optional<float>>)
                    value = x;
                else if constexpr (std::is_same_v<T, std::optional<vec3>>)
                    value = vec3(0.5f, 0.5f, x);
                else
                    continue;
                SceneEdits edits;
                place(edits, edit);
                EXPECT_THROW(check_edits(edits), std::invalid_argument) << name << " " << x;
                ++tried;
            }
            if constexpr (!std::is_same_v<T, bool>) value.reset();
        });
    };
    refuse(SkyEdit{}, [](SceneEdits& s, const SkyEdit& e) { s.sky = e; });
    refuse(LightEdit{}, [](SceneEdits& s, const LightEdit& e) { s.lights = {e}; });
    refuse(MaterialEdit{}, [](SceneEdits& s, const MaterialEdit& e) { s.materials = {e}; });
    EXPECT_GT(tried, 40);
    SceneOptions o = of_asset("cornell.glb");
    o.edits.materials = {{.name = "x", .index = 0, .roughness = 2.0f}};
    EXPECT_THROW(prepare_scene(o), std::invalid_argument);
}

// A random edit of anything.
void edit_something(std::mt19937& random, const FileContents& file, SceneOptions& o) {
    const auto number = [&] { return float(random() % 1000) / 1000; };
    const auto color = [&] { return vec3(number(), number(), number()); };
    if (!file.lights.empty() && random() % 3 == 0) {
        const int k = static_cast<int>(random() % file.lights.size());
        LightEdit e = edit_of(o.edits, file.lights, k);
        if (random() % 4 == 0) e.on = !e.on;
        if (random() % 3 == 0) e.kind = static_cast<PunctualKind>(random() % 3);
        if (random() % 3 == 0) e.strength = 10 * number();
        if (random() % 3 == 0) e.color = color();
        if (random() % 4 == 0) e.outer_angle = 0.1f + number();
        if (random() % 6 == 0) e = {.name = e.name, .index = e.index};
        set_edit(o.edits, file.lights, k, e);
        return;
    }
    if (random() % 12 == 0) {
        const std::string map = std::string(MIDWAY_SOURCE_DIR) + "/assets/terrace_sky.hdr";
        o.sky = random() % 3 ? std::optional<std::string>(random() % 2 ? map : "0.1,0.2,0.4")
                             : std::nullopt;
        return;
    }
    if (random() % 8 == 0) {
        o.edits.sky.on = random() % 2;
        if (random() % 2) o.edits.sky.color = color();
        if (random() % 2) o.sky_rotation_degrees = 100 * number();
        if (random() % 2) o.sky_strength = number();
        return;
    }
    const int k = static_cast<int>(random() % file.materials.size());
    MaterialEdit e = edit_of(o.edits, file.materials, k);
    if (random() % 4 == 0) e.on = !e.on;
    if (random() % 3 == 0) e.emission_strength = random() % 3 ? 4 * number() : 0;
    if (random() % 3 == 0) e.emission_color = color();
    if (random() % 3 == 0) e.base_color = color();
    if (random() % 3 == 0) e.roughness = number();
    if (random() % 4 == 0) e.metallic = number();
    if (random() % 4 == 0) e.transmission = random() % 2 ? 1.0f : 0.0f;
    if (random() % 4 == 0) e.ior = 1 + number();
    if (random() % 4 == 0) e.alpha = number();
    if (random() % 4 == 0) e.double_sided = random() % 2;
    if (random() % 6 == 0) e = {.name = e.name, .index = e.index};
    set_edit(o.edits, file.materials, k, e);
}

TEST(SceneEdits, StepByStepIsTheSameAsLoading) {
    for (const char* asset : {"five-lights.glb", "terrace.glb", "lanterns.glb"}) {
        SCOPED_TRACE(asset);
        std::mt19937 random(5);
        SceneOptions o = of_asset(asset);
        const PreparedScene first = prepare_scene(o);
        PreparedScene now = first;
        for (int i = 0; i < 40; ++i) {
            edit_something(random, *first.file, o);
            now = update_scene(now, o);
            if (i % 8 != 7) continue;
            const PreparedScene fresh = prepare_scene(o);
            EXPECT_EQ(now.hash, fresh.hash);
            EXPECT_EQ(now.warnings, fresh.warnings);
            EXPECT_EQ(now.default_sky, fresh.default_sky);
            EXPECT_EQ(now.scene->next_event_group.cdf, fresh.scene->next_event_group.cdf);
            EXPECT_TRUE(now.scene->light_tree == fresh.scene->light_tree);
            EXPECT_TRUE(pixels(now) == pixels(fresh));
        }
        const PreparedScene back = update_scene(now, first.options);
        EXPECT_EQ(back.hash, first.hash);
        EXPECT_EQ(back.warnings, first.warnings);
        EXPECT_TRUE(pixels(back) == pixels(first));
    }
}

std::shared_ptr<const Image> random_map(std::mt19937& random) {
    auto map = std::make_shared<Image>(8, 4);
    for (vec3& p : map->pixels) p = vec3(float(random() % 100));
    return map;
}

// A lamp with a texture and holes, beside glass, under one of two skies: what is shared with the
// scene before is never stale.
TEST(SceneEdits, TexturesAndHolesOfLampsAreNeverStale) {
    SceneDescription d;
    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 4;
    std::mt19937 random(8);
    for (int i = 0; i < 64; ++i) image->rgba.push_back(static_cast<std::uint8_t>(random()));
    d.images = {image};
    Material m = lamp(vec3(3, 2, 1));
    m.emission_texture.image = m.base_color_texture.image = 0;
    auto mesh = make_quad({-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, 3);
    for (const vec3& p : mesh.positions) mesh.texcoords[0].emplace_back(p.x, p.z);
    add(d, mesh, m);
    add(d, make_icosphere({0, 2, 0}, 0.5f, 1, false, true), glass(0));
    const std::shared_ptr<const Image> maps[] = {random_map(random), random_map(random), nullptr};
    std::vector<std::string> warnings;
    Scene now = build_scene(d, warnings);
    const auto number = [&] { return float(random() % 100) / 100; };
    for (int i = 0; i < 300; ++i) {
        Material& l = d.materials[0];
        if (random() % 3 == 0) l.emission = random() % 4 ? vec3(number(), number(), 1) : vec3(0);
        if (random() % 3 == 0) l.alpha_mode = static_cast<AlphaMode>(random() % 3);
        if (random() % 3 == 0) l.alpha = number();
        if (random() % 3 == 0) l.alpha_cutoff = number();
        if (random() % 3 == 0) l.double_sided = random() % 2;
        if (random() % 4 == 0) l.emission_texture.rows[0].z = number();
        if (random() % 4 == 0) l.base_color_texture.image = int(random() % 2) - 1;
        if (random() % 4 == 0) d.materials[1].transmission = float(random() % 2);
        if (random() % 2 == 0) d.sky = SkyDescription{.map = maps[random() % 3]};
        BuildOptions options;
        options.previous = &now;
        const Scene next = build_scene(d, warnings, options), fresh = build_scene(d, warnings);
        ASSERT_EQ(next.lights.size(), fresh.lights.size());
        for (size_t k = 0; k < next.lights.size(); ++k)
            ASSERT_EQ(next.lights[k].power, fresh.lights[k].power) << i;
        for (size_t k = 0; k < next.geometry->objects.size(); ++k)
            ASSERT_EQ(next.geometry->objects[k].may_be_transparent,
                      fresh.geometry->objects[k].may_be_transparent)
                << i;
        now = next;
    }
}

TEST(SceneEdits, KeepTheTreeAndShareTheTables) {
    SceneOptions o = of_asset("terrace.glb");
    o.sky = std::string(MIDWAY_SOURCE_DIR) + "/assets/terrace_sky.hdr";
    const PreparedScene old = prepare_scene(o);
    o.sky_rotation_degrees = 40;
    o.sky_strength = 3;
    for (int k = 0; k < static_cast<int>(old.file->materials.size()); ++k) {
        MaterialEdit e = edit_of(o.edits, old.file->materials, k);
        e.base_color = vec3(0.1f);
        e.transmission = 1.0f;
        e.emission_strength = 0.5f;
        set_edit(o.edits, old.file->materials, k, e);
    }
    const PreparedScene now = update_scene(old, o);
    EXPECT_NE(now.hash, old.hash);
    EXPECT_EQ(now.scene->geometry, old.scene->geometry);
    EXPECT_EQ(now.scene->accel, old.scene->accel);
    ASSERT_TRUE(now.scene->sky && now.scene->sky->cells);
    EXPECT_EQ(now.scene->sky->cells, old.scene->sky->cells);
}

TEST(SceneEdits, OfWhatIsGoneAreLeftOutWithALine) {
    SceneOptions o = of_asset("cornell.glb");
    const PreparedScene plain = prepare_scene(o);
    o.edits.lights = {{.name = "bulb\nof old", .index = 3, .on = false}};
    o.edits.materials = {{.name = "gone", .index = 0, .roughness = 0.5f}};
    const PreparedScene p = prepare_scene(o);
    ASSERT_EQ(p.warnings.size(), plain.warnings.size() + 2);
    EXPECT_NE(p.light_warnings[0].find("bulb"), std::string::npos);
    EXPECT_EQ(p.light_warnings[0].find('\n'), std::string::npos);
    EXPECT_NE(p.light_warnings[1].find("gone"), std::string::npos);
    EXPECT_EQ(p.hash, plain.hash);
    o.edits.materials.assign(1000, o.edits.materials[0]);
    EXPECT_LT(prepare_scene(o).warnings.size(), 50u);
}

TEST(SceneEdits, ALampSwitchedOffIsNotReplacedByASky) {
    SceneOptions o = of_asset("cornell.glb");
    const PreparedScene old = prepare_scene(o);
    ASSERT_FALSE(old.default_sky);
    for (int k = 0; k < static_cast<int>(old.file->materials.size()); ++k) {
        MaterialEdit e = edit_of(o.edits, old.file->materials, k);
        e.on = false;
        set_edit(o.edits, old.file->materials, k, e);
    }
    const PreparedScene dark = update_scene(old, o);
    EXPECT_FALSE(dark.default_sky);
    EXPECT_TRUE(dark.scene->lights.empty());
    EXPECT_EQ(dark.scene->total_power, 0);
    for (const vec3& p : pixels(dark)) EXPECT_EQ(p, vec3(0));
    // Nor is one that was dimmed to nothing.
    for (MaterialEdit& e : o.edits.materials) {
        e.on = true;
        e.emission_strength = 0.0f;
    }
    EXPECT_FALSE(update_scene(old, o).default_sky);
}

TEST(SceneEdits, EmissionComesApartAsTheFileHasIt) {
    Material m;
    m.emissive_factor = {0.7f, 0.1f, 0.3f};
    m.emissive_strength = 13.7f;
    m.emission = m.emissive_factor * m.emissive_strength;
    EXPECT_EQ(emission_parts(m).color, m.emissive_factor);
    EXPECT_EQ(emission_parts(m).strength, m.emissive_strength);
    const Material other = values_of(m, {.emission_strength = 2.3f});
    EXPECT_EQ(other.emission, m.emissive_factor * 2.3f);
    // Made without a file.
    m.emissive_factor = vec3(0);
    EXPECT_EQ(emission_parts(m).strength, m.emission.x);
    EXPECT_EQ(emission_parts(Material{}).strength, 0);
    EXPECT_EQ(values_of(Material{}, {.emission_strength = 2.0f}).emission, vec3(2));
}

}  // namespace
}  // namespace midway::test
