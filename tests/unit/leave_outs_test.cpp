// What a render leaves out is not needed: doing it all the same changes no bit of the film, lights
// that are called out of reach shine on nothing, and every line that is told is true.
#include "render/leave_outs.h"

#include <gtest/gtest.h>

#include "support/rooms.h"

namespace midway::test {
namespace {

SceneDescription bulb_room() {
    SceneDescription s = plain_room();
    s.materials[1] = lambert(vec3(0.3f));
    s.lights = {point_light({0, 1.7f, 1}, 3)};
    return s;
}

std::shared_ptr<const Scene> build_with(const SceneDescription& d, const NeedlessWork& work,
                                        const Scene* previous = nullptr) {
    std::vector<std::string> warnings;
    return std::make_shared<Scene>(
        build_scene(d, warnings, {.previous = previous, .needless = work}));
}

FilmWords film_of(const std::shared_ptr<const Scene>& scene, const RenderSettings& s) {
    ProgressiveRenderer r(scene, eye(), s, {.threads = 2});
    r.render_passes(4);
    return r.film().words();
}

std::string why(const Scene& scene, const std::string& what) {
    for (const LeaveOut& line : leave_outs(scene))
        if (line.what == what) return line.why;
    return "";
}

TEST(LeaveOuts, DoneAllTheSameChangeNoBit) {
    const NeedlessWork works[] = {{.attributes = true},
                                  {.attributes = true, .textures = true},
                                  {.lights = true},
                                  {.sky = true},
                                  {.transmission = true}};
    for (const SceneDescription& d : {plain_room(), mirror_room(), bulb_room()}) {
        const auto scene = build(d);
        for (const Technique t : {Technique::path, Technique::bdpt}) {
            const RenderSettings usual = settings(t, 12, 6);
            const FilmWords film = film_of(scene, usual);
            for (const NeedlessWork& work : works) {
                EXPECT_TRUE(film == film_of(build_with(d, work), usual));
                EXPECT_TRUE(film == film_of(build_with(d, work, scene.get()), usual));
            }
        }
    }
}

// Else the same bits would say nothing.
TEST(LeaveOuts, WhatIsNeedlessIsThere) {
    const SceneDescription d = bulb_room();
    EXPECT_LT(build(d)->sky_light, 0);
    EXPECT_GE(build_with(d, {.sky = true})->sky_light, 0);
    const auto all_transmit = build_with(d, {.transmission = true});
    for (const Material& m : all_transmit->materials) EXPECT_EQ(1, m.transmission);
    const auto all_textured = build_with(d, {.textures = true});
    for (const Material& m : all_textured->materials) EXPECT_TRUE(m.base_color_texture.used());
}

TEST(LeaveOuts, FamiliesDoneAllTheSameChangeNoBit) {
    for (const SceneDescription& d : {mirror_room(), bulb_room()}) {
        const auto scene = build(d);
        RenderSettings s = settings(Technique::bdpt, 12, 6);
        const Families needed = make_estimator(*scene, eye(), s).families;
        const FilmWords film = film_of(scene, s);
        s.needless = {true, true, true, true};
        EXPECT_FALSE(needed == make_estimator(*scene, eye(), s).families);
        EXPECT_TRUE(film == film_of(scene, s));
        // With a plan that was made without them, too.
        s.technique = Technique::automatic;
        s.plan = Plan{needed, 4};
        EXPECT_TRUE(film == film_of(scene, s));
    }
}

// A plan may be older than the families that are asked for: without next event its direct light is
// left to light tracing after all.
TEST(LeaveOuts, DirectSplatsAreSparedForNextEventAlone) {
    const auto scene = build(plain_room());
    RenderSettings s = settings(Technique::automatic, 12, 6);
    s.plan = Plan{{}, 4, false};
    EXPECT_EQ(0, make_estimator(*scene, eye(), s).direct_share);
    s.families = parse_families("light");
    EXPECT_GT(make_estimator(*scene, eye(), s).direct_share, 0);
}

TEST(LeaveOuts, WhatMayTurnRoundingKeepsTheMean) {
    const SceneDescription d = plain_room();
    const RenderSettings s = settings(Technique::path, 12, 6);
    const double usual = image_mean(render(build(d), eye(), s, 16));
    // The same paths, but that one in a thousand goes another way: where a normal was rounded, or
    // two triangles lie at one distance.
    for (const NeedlessWork& work :
         {NeedlessWork{.attributes = true, .normal_maps = true}, NeedlessWork{.coverage = true}})
        EXPECT_NEAR(usual, image_mean(render(build_with(d, work), eye(), s, 16)), 0.01 * usual);
}

TEST(LeaveOuts, EveryLineIsTrue) {
    SceneDescription d = plain_room();
    const auto plain = build(d);
    EXPECT_EQ("no material has one", why(*plain, "textures"));
    EXPECT_EQ("no material has one", why(*plain, "normal maps"));
    EXPECT_EQ("every surface is opaque", why(*plain, "transparency"));
    EXPECT_EQ("no texture asks for some that 2 objects have", why(*plain, "texture coordinates"));
    EXPECT_EQ("there is neither a sun nor a sky that shines", why(*plain, "lights at infinity"));
    EXPECT_EQ("", why(*plain, "transmission"));
    EXPECT_EQ("", why(*plain, "lights"));
    EXPECT_EQ("", why(*plain, "emitter"));
    for (const Object& o : plain->geometry->objects) {
        EXPECT_TRUE(o.texcoords[0].empty());
        EXPECT_TRUE(o.tangents.empty());
    }

    auto image = std::make_shared<TextureImage>();
    image->width = image->height = 1;
    image->rgba = {200, 150, 100, 128};
    d.images = {image};
    d.materials[0].base_color_texture.image = d.materials[0].normal_texture.image = 0;
    d.materials[0].alpha_mode = AlphaMode::blend;
    d.materials[2] = lambert(vec3(0.5f));
    d.sky = constant_sky(vec3(0.1f));
    const auto other = build(d);
    EXPECT_EQ("23 of 24 places for one in the materials are empty", why(*other, "textures"));
    EXPECT_EQ("3 of 4 materials have none", why(*other, "normal maps"));
    EXPECT_EQ("3 of 4 objects are opaque", why(*other, "transparency"));
    EXPECT_EQ("no texture asks for some that 1 object has", why(*other, "texture coordinates"));
    EXPECT_EQ("", why(*other, "lights at infinity"));
    EXPECT_EQ("no material lets light through", why(*other, "transmission"));
    EXPECT_FALSE(other->geometry->objects[0].texcoords[0].empty());
    EXPECT_FALSE(other->geometry->objects[0].tangents.empty());

    EXPECT_EQ("no light here can be hit by a ray", why(*build(bulb_room()), "emitter"));
    EXPECT_NE("", why(*build(mirror_room()), "connect"));
}

TEST(LeaveOuts, AttributesComeBackWithTheTextureThatAsksForThem) {
    SceneDescription d = plain_room();
    const auto plain = build(d);
    auto image = std::make_shared<TextureImage>();
    image->width = 2, image->height = 1;
    image->rgba = {255, 0, 0, 255, 0, 0, 255, 255};
    d.images = {image};
    d.materials[0].base_color_texture.image = 0;
    const RenderSettings s = settings(Technique::path, 12, 3);
    EXPECT_TRUE(film_of(build(d), s) == film_of(build_with(d, {}, plain.get()), s));
}

// Lamps of the scene that reach nothing.
size_t unreached(const SceneDescription& d) { return build(d)->unreached_lights; }

SceneDescription floor_with(const Mesh& mesh, const Material& material) {
    SceneDescription s;
    add(s, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 20), lambert(vec3(0.6f)));
    add(s, mesh, material);
    return s;
}

TEST(Reach, LampsWithTheSceneBehindThemShineOnNothing) {
    const Mesh up = make_quad({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}, 3);
    const Mesh down = make_quad({-1, 1, 1}, {0, 0, -2}, {2, 0, 0}, 3);
    EXPECT_EQ(18u, unreached(floor_with(up, lamp(vec3(1)))));
    EXPECT_EQ(0u, unreached(floor_with(down, lamp(vec3(1)))));
    Material both = lamp(vec3(1));
    both.double_sided = true;
    EXPECT_EQ(0u, unreached(floor_with(up, both)));
    // Whatever stands over it, if only by a corner, is reached.
    SceneDescription d = floor_with(up, lamp(vec3(1)));
    add(d, make_quad({50, 1.00001f, 0}, {1, 0, 0}, {0, -1, 0}), lambert(vec3(0.5f)));
    EXPECT_EQ(0u, unreached(d));
    // Parts of a tilted one lie in a plane but for rounding.
    EXPECT_EQ(18u, unreached(floor_with(make_quad({-1, 1, 1}, {2, 0, 0}, {0, 0.7f, -2}, 3),
                                        lamp(vec3(1)))));
    EXPECT_EQ(
        0u, unreached(floor_with(make_quad({-1, 1, 1}, {2, 0, 0}, {0, 4, -2}, 3), lamp(vec3(1)))));
}

// Of a lamp's triangle: by all vertices of the scene.
bool any_vertex_in_front(const Geometry& g, const Light& l) {
    const Object& lamp = g.objects[l.object];
    const uvec3& t = lamp.triangles[l.triangle];
    const dvec3 a(lamp.positions[t.x]), b(lamp.positions[t.y]), c(lamp.positions[t.z]);
    for (const Object& o : g.objects)
        for (const vec3& p : o.positions)
            if (glm::dot(glm::normalize(glm::cross(b - a, c - a)), dvec3(p) - a) > 1e-9)
                return true;
    return false;
}

TEST(Reach, IsWhatAllVerticesSay) {
    for (const bool inward : {false, true}) {
        SceneDescription d =
            floor_with(make_icosphere({0, 1.5f, 0}, 0.4f, 3, inward), lamp(vec3(1)));
        add(d, make_icosphere({1, 0.5f, 0}, 0.3f, 2), lamp(vec3(2)));
        const auto scene = build(d);
        size_t out_of_reach = 0;
        for (const Light& l : scene->lights) {
            EXPECT_EQ(any_vertex_in_front(*scene->geometry, l), l.reaches);
            out_of_reach += !l.reaches;
        }
        EXPECT_EQ(out_of_reach, scene->unreached_lights);
        EXPECT_EQ(inward, out_of_reach < 100);
    }
}

TEST(Reach, SpotsThatPassByShineOnNothing) {
    SceneDescription d =
        floor_with(make_quad({5, 0, 0}, {1, 0, 0}, {0, 1, 0}), lambert(vec3(0.5f)));
    d.lights = {spot_light({0, 1, 0}, {0, 2, 0}, 1, 0.1f, 0.5f)};
    EXPECT_EQ(1u, unreached(d));
    d.lights = {spot_light({0, 1, 0}, {0, 0, 0}, 1, 0.1f, 0.5f)};
    EXPECT_EQ(0u, unreached(d));
    // Its edge touches the floor's.
    d.lights = {spot_light({0, 1, 0}, {-2, 1, 0}, 1, 0.1f, 0.5f)};
    EXPECT_EQ(0u, unreached(d));
    d.lights = {spot_light({0, 1, 0}, {-2, 1, 0}, 1, 0.1f, 0.3f)};
    EXPECT_EQ(1u, unreached(d));
}

TEST(Reach, LightsOutOfReachAreSeenAndNeverPicked) {
    const auto scene = build(room_with_a_sign());
    ASSERT_EQ(2u, scene->unreached_lights);
    for (size_t i = 0; i < scene->lights.size(); ++i) {
        const int light = first_of_lamp(*scene->lamps, static_cast<int>(i));
        EXPECT_EQ(scene->lights[i].reaches, scene->lights[i].emission_pick > 0);
        EXPECT_EQ(scene->lights[i].reaches, scene->light_tree.probability(light, vec3(0)) > 0);
    }
    EXPECT_NE("", why(*scene, "lights"));
    const auto sign = camera_at({0, -0.8f, 4}, {0, -0.8f, 0}, 0.01);
    for (const Technique t : {Technique::path, Technique::light, Technique::bdpt}) {
        for (const double b : {0.0, 1.0, 2.0, 3.5}) {
            RenderSettings s = settings(t, 2, 4);
            s.exponents = {b};
            EXPECT_FLOAT_EQ(9, static_cast<float>(image_mean(render(scene, sign, s, 2))));
        }
    }
}

TEST(Reach, NoLightThatReachesNeedsNothingButToBeSeen) {
    SceneDescription d = floor_with(make_quad({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}), lamp(vec3(3)));
    const auto scene = build(d);
    const Estimator e = make_estimator(*scene, eye(), settings(Technique::bdpt));
    EXPECT_TRUE(e.families == (Families{true, false, false, false}));
    EXPECT_EQ("no light reaches a surface", why(*scene, "next-event"));
    const auto above = camera_at({0, 3, 0.1f}, {0, 1, 0}, 0.1);
    EXPECT_FLOAT_EQ(
        3, static_cast<float>(image_mean(render(scene, above, settings(Technique::bdpt, 2), 2))));
}

// A difference beyond 5 standard errors of some 30 degrees of freedom: less than once in 10^4.
TEST(Reach, PickingThemAllTheSameKeepsTheMean) {
    const SceneDescription d = room_with_a_sign();
    for (const Technique t : {Technique::path, Technique::bdpt}) {
        const Estimate without = batch_mean(build(d), eye(), settings(t, 8, 5), 8, 16);
        const Estimate with =
            batch_mean(build_with(d, {.lights = true}), eye(), settings(t, 8, 5), 8, 16);
        EXPECT_LT(std::abs(z_score(without, with)), 5);
    }
}

// Four differences beyond 5 standard errors of some 30 degrees of freedom: less than once in 10^4.
TEST(LeaveOuts, BlackLightsAreNeverPickedAndPickingThemKeepsTheMean) {
    SceneDescription d = plain_room();
    d.lights = {point_light({0, 1.7f, 1}, 0), point_light({0.5f, 1.5f, 1}, 0)};
    const auto usual = build(d);
    EXPECT_EQ("2 of 4 are black", why(*usual, "black lights"));
    for (const Scene* previous : {static_cast<const Scene*>(nullptr), usual.get()}) {
        const auto all = build_with(d, {.black_lights = true}, previous);
        ASSERT_EQ(usual->lights.size(), all->lights.size());
        for (size_t i = 0; i < all->lights.size(); ++i) {
            const int light = first_of_lamp(*all->lamps, static_cast<int>(i));
            const bool shines = all->lights[i].power > 0;
            EXPECT_EQ(shines, usual->lights[i].emission_pick > 0);
            EXPECT_EQ(shines, usual->light_tree.probability(light, vec3(0)) > 0);
            EXPECT_FLOAT_EQ(0.25f, static_cast<float>(all->lights[i].emission_pick));
            EXPECT_GT(all->light_tree.probability(light, vec3(0)), 0);
        }
        for (const Technique t : {Technique::path, Technique::bdpt}) {
            const RenderSettings s = settings(t, 8, 5);
            EXPECT_LT(std::abs(z_score(batch_mean(usual, eye(), s, 8, 16),
                                       batch_mean(all, eye(), s, 8, 16))),
                      5);
        }
    }
}

}  // namespace
}  // namespace midway::test
