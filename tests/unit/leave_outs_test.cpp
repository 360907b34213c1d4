// What a render leaves out is not needed: doing it all the same changes no bit of the film, lights
// that are called out of reach shine on nothing, and every line that is told is true.
#include "render/leave_outs.h"

#include <gtest/gtest.h>

#include <map>

#include "render/pilot.h"
#include "report/cost.h"
#include "support/scenes.h"

namespace midway::test {
namespace {

CameraDescription eye() { return camera_at({0, 1, 4}, {0, 0.5f, 0}, 0.8); }

// A floor, a ball, a lamp above; every kind of lobe, nothing textured.
SceneDescription plain_room() {
    SceneDescription s;
    add(s, make_quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, 2), lambert(vec3(0.6f)));
    add(s, make_quad({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    add(s, make_icosphere({0.7f, 0.5f, 0}, 0.5f, 2, false, true), glass(0.1f));
    add(s, make_icosphere({-0.7f, 0.5f, 0}, 0.5f, 2, false, true), plastic(0.2f));
    return s;
}

// Only mirrors and clear glass, and a lamp that is seen in the floor: nothing to connect.
SceneDescription mirror_room() {
    SceneDescription s;
    add(s, make_quad({-2, 0, 3.5f}, {4, 0, 0}, {0, 0, -6}, 2), metal(0, vec3(0.7f)));
    add(s, make_quad({-0.5f, 2, -2.5f}, {1, 0, 0}, {0, 0, 1}), lamp(vec3(4)));
    add(s, make_icosphere({0.7f, 0.5f, 0}, 0.5f, 2, false, true), glass(0));
    return s;
}

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

// A floor, a lamp over it, and another that the camera sees and nothing else.
SceneDescription room_with_a_sign() {
    SceneDescription d = plain_room();
    add(d, make_quad({-3, -1, 2}, {6, 0, 0}, {0, 0.4f, 0}), lamp(vec3(9)));
    return d;
}

TEST(Reach, LightsOutOfReachAreSeenAndNeverPicked) {
    const auto scene = build(room_with_a_sign());
    ASSERT_EQ(2u, scene->unreached_lights);
    for (size_t i = 0; i < scene->lights.size(); ++i) {
        const auto light = static_cast<int>(i);
        EXPECT_EQ(scene->lights[i].reaches, scene->emission_pick.probability(light) > 0);
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

TEST(Cost, MeasuresEveryThingThatCanBeTurnedOn) {
    PreparedScene p;
    p.description = room_with_a_sign();
    p.camera = eye();
    p.scene = build(p.description);
    RenderSettings s = settings(Technique::automatic, 8, 4);
    s.plan = Plan{{true, true, true, false}, 2};
    const auto rows = measure_cost(p, s, {.threads = 1, .rounds = 2, .seconds = 0});
    std::map<std::string, LeaveOutCost> by_name;
    for (const LeaveOutCost& row : rows) by_name[row.what] = row;
    for (const char* what : {"textures", "texture coordinates", "transparency",
                             "lights at infinity", "strategy images"}) {
        ASSERT_TRUE(by_name.contains(what)) << what;
        EXPECT_TRUE(by_name[what].same_bits) << what;
        EXPECT_EQ(1, by_name[what].mean_ratio) << what;
    }
    for (const char* what :
         {"connections", "light subpaths", "all that auto leaves out", "lights"}) {
        ASSERT_TRUE(by_name.contains(what)) << what;
        EXPECT_FALSE(by_name[what].same_bits) << what;
        EXPECT_GT(by_name[what].mean_ratio, 0.3) << what;
        EXPECT_LT(by_name[what].mean_ratio, 3) << what;
    }
    for (const char* what : {"normal maps", "transparency"}) {
        ASSERT_TRUE(by_name.contains(what)) << what;
        EXPECT_NEAR(by_name[what].mean_ratio, 1, 0.05) << what;
    }
    EXPECT_FALSE(by_name.contains("light tracing"));
    EXPECT_EQ(10u, rows.size());
    for (const LeaveOutCost& row : rows) {
        EXPECT_GT(row.left_out.median, 0) << row.what;
        EXPECT_GT(row.done.median, 0) << row.what;
        EXPECT_LE(row.saving.low, row.saving.median) << row.what;
        EXPECT_FALSE(row.why.empty()) << row.what;
    }
}

TEST(Cost, MeasuresAPlanPieceByPiece) {
    PreparedScene p;
    p.description = plain_room();
    p.camera = eye();
    p.scene = build(p.description);
    RenderSettings s = settings(Technique::automatic, 8, 4);
    s.plan = Plan{{true, true, false, false}, 0};
    std::vector<std::string> names;
    for (const LeaveOutCost& row : measure_cost(p, s, {.threads = 1, .rounds = 1, .seconds = 0}))
        if (row.why.starts_with("the plan of auto is path tracing")) names.push_back(row.what);
    EXPECT_EQ(
        (std::vector<std::string>{"connections", "light tracing", "all that auto leaves out"}),
        names);
    s.plan = Plan{{}, 1};
    for (const LeaveOutCost& row : measure_cost(p, s, {.threads = 1, .rounds = 1, .seconds = 0}))
        EXPECT_EQ(row.why.starts_with("the plan"), row.what == "light subpaths") << row.what;
    s.plan = Plan{{}, 8};
    for (const LeaveOutCost& row : measure_cost(p, s, {.threads = 1, .rounds = 1, .seconds = 0}))
        EXPECT_FALSE(row.why.starts_with("the plan")) << row.what << ": two subpaths are no saving";
}

TEST(Cost, MeasuresFamiliesThatNothingHereNeeds) {
    PreparedScene p;
    p.description = mirror_room();
    p.camera = eye();
    p.scene = build(p.description);
    RenderSettings s = settings(Technique::automatic, 8, 4);
    choose_plan(*p.scene, p.camera, s, 1);
    const auto rows = measure_cost(p, s, {.threads = 1, .rounds = 1, .seconds = 0});
    size_t families = 0;
    for (const LeaveOutCost& row : rows) {
        const bool family =
            row.what == "next-event" || row.what == "light" || row.what == "connect";
        families += family;
        EXPECT_TRUE(row.same_bits || row.what == "normal maps" || row.what == "transparency")
            << row.what;
    }
    EXPECT_EQ(3u, families);
}

}  // namespace
}  // namespace midway::test
