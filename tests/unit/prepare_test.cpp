// Other wishes for a scene that is loaded: what can be shared is shared, and the result is the one
// of loading anew.
#include "render/prepare.h"

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "support/assets.h"
#include "support/scenes.h"

namespace midway::test {
namespace {

std::vector<float> pixels(const PreparedScene& p) {
    ProgressiveRenderer r(p.scene, p.camera, settings(Technique::bdpt, 12, 4), {});
    r.render_passes(1);
    std::vector<float> values;
    for (const vec3& v : r.image().pixels) values.insert(values.end(), {v.x, v.y, v.z});
    return values;
}

TEST(UpdateScene, KeepsTheSceneForANewCamera) {
    const PreparedScene old = prepare_scene(of_asset("cornell.glb"));
    SceneOptions o = old.options;
    o.look_at = {0.2, 1.1, 3, 0, 1, 0};
    o.aperture_radius = 0.1;
    const PreparedScene now = update_scene(old, o);
    EXPECT_EQ(now.scene, old.scene);
    EXPECT_NE(now.hash, old.hash);
    EXPECT_EQ(now.hash, prepare_scene(o).hash);
    EXPECT_EQ(pixels(now), pixels(prepare_scene(o)));
}

TEST(UpdateScene, SharesGeometryAndTreeUnderNewLights) {
    const PreparedScene old = prepare_scene(of_asset("cornell.glb"));
    SceneOptions o = old.options;
    o.sky = "0.1,0.2,0.4";
    o.sky_strength = 2;
    o.lamp_strength = 0.5f;
    const PreparedScene lit = update_scene(old, o);
    EXPECT_NE(lit.scene, old.scene);
    EXPECT_EQ(lit.scene->geometry, old.scene->geometry);
    EXPECT_EQ(lit.scene->accel, old.scene->accel);
    EXPECT_EQ(lit.hash, prepare_scene(o).hash);
    EXPECT_EQ(pixels(lit), pixels(prepare_scene(o)));

    // The wishes are absolute: taking them back gives the first scene again.
    const PreparedScene back = update_scene(lit, old.options);
    EXPECT_EQ(back.hash, old.hash);
    EXPECT_EQ(pixels(back), pixels(old));
}

TEST(UpdateScene, ReadsASkyMapOnce) {
    SceneOptions o = of_asset("terrace.glb");
    o.sky = std::string(MIDWAY_SOURCE_DIR) + "/assets/terrace_sky.hdr";
    const PreparedScene old = prepare_scene(o);
    o.sky_rotation_degrees = 30;
    const PreparedScene turned = update_scene(old, o);
    EXPECT_EQ(turned.description.sky->map, old.description.sky->map);
    o.sky_rotation_degrees = 45;
    EXPECT_EQ(update_scene(turned, o).description.sky->rotation_degrees, 45);
}

TEST(UpdateScene, RefusesAnotherFile) {
    const PreparedScene old = prepare_scene(of_asset("cornell.glb"));
    EXPECT_THROW(update_scene(old, of_asset("idol.glb")), std::invalid_argument);
}

TEST(BuildScene, SharesGeometryOnlyWhereTheMaterialsAllowIt) {
    SceneDescription d;
    add(d, make_icosphere({0, 0, 0}, 1, 2, false, true), lambert(vec3(0.5f)));
    std::vector<std::string> warnings;
    const Scene old = build_scene(d, warnings);
    BuildOptions options;
    options.previous = &old;
    d.materials[0].base_color = vec3(0.9f, 0.1f, 0.1f);
    EXPECT_EQ(build_scene(d, warnings, options).geometry, old.geometry);
    d.materials[0].transmission = 1;
    EXPECT_EQ(build_scene(d, warnings, options).geometry, old.geometry);
    d.materials[0].transmission = 0;
    // Blending asks the tree for a filter.
    d.materials[0].alpha_mode = AlphaMode::blend;
    d.materials[0].alpha = 0.5f;
    const Scene blended = build_scene(d, warnings, options);
    EXPECT_NE(blended.geometry, old.geometry);
    EXPECT_TRUE(blended.has_transparency);
    options.previous = &blended;
    d.materials[0].alpha = 0.25f;
    EXPECT_EQ(build_scene(d, warnings, options).geometry, blended.geometry);
}

}  // namespace
}  // namespace midway::test
