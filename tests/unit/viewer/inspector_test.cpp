// The path inspector without a window: clicks and drags with the tool in hand, lines in space and
// what of them is in sight, the workers' side driven by hand.
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include "support/scenes.h"
#include "viewer/engine.h"
#include "viewer/panels/panels.h"
#include "viewer/panels/parts.h"
#include "viewer/script_inspect.h"
#include "viewer/view.h"

namespace midway::test {
namespace {

class Inspector : public testing::Test {
  protected:
    Inspector() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {1280, 720};
        apply_theme(1);
        app.document.path = app.document.options.path = MIDWAY_SOURCE_DIR "/assets/cornell.glb";
        app.document.prepared =
            std::make_shared<PreparedScene>(prepare_scene(app.document.options));
        app.render.settings.width = 64;
        app.render.settings.height = 48;
        app.render.limits.spp = 4;
        app.render.fit_window = false;
    }
    ~Inspector() override { ImGui::DestroyContext(); }

    Change hand(vec2 at, int button = -1) {
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = {at.x, at.y};
        for (int b = 0; b < 3; ++b) io.MouseDown[b] = b == button;
        io.DeltaTime = 1.0f / 60;
        ImGui::NewFrame();
        Change change;
        for (const Panel& p : panels()) change |= p.draw(app);
        ImGui::Render();
        return change;
    }
    vec2 middle() const { return 0.5f * (app.ui.view.lower + app.ui.view.upper); }
    InspectorState& state() { return app.ui.panel.inspector; }

    App app;
};

TEST_F(Inspector, AClickInspectsAndADragStillOrbits) {
    choose_tool(app, ViewTool::inspect);
    for (int i = 0; i < 3; ++i) hand(middle());
    EXPECT_GT(app.ui.panel.dock[3] - app.ui.panel.dock[1], 100);
    EXPECT_EQ(app.ui.panel.dock[1], app.ui.view.upper.y);
    EXPECT_EQ(state().wish.number, 0u);
    Change change = hand(middle(), 0);
    // A hand that shakes.
    change |= hand(middle() + vec2(1, 1), 0);
    change |= hand(middle() + vec2(1, 1));
    EXPECT_FALSE(change.any());
    EXPECT_EQ(state().wish.number, 1u);
    EXPECT_EQ(state().wish.pixel, *pixel_at(app, middle() + vec2(1, 1)));
    change = hand(middle(), 0);
    change |= hand(middle() + vec2(60, 0), 0);
    change |= hand(middle());
    change |= hand(middle());
    EXPECT_TRUE(change.camera);
    EXPECT_EQ(state().wish.number, 1u) << "a drag that ends where it began is no click";
}

// All that the loop does for the inspector.
class InspectorAtWork : public Inspector {
  protected:
    void turn() {
        const News news = collect(app, engine);
        apply(app, engine, news.change, Engine::Clock::now());
        hand(middle());
        follow_inspection(app, engine);
    }
    bool turn_until(const std::function<bool()>& over) {
        for (int i = 0; i < 6000 && !over(); ++i) {
            turn();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return over();
    }
    bool rendered() {
        return app.snapshot && app.snapshot->job == engine.jobs.back().number &&
               app.snapshot->finished;
    }
    void render(const Change& change) {
        apply(app, engine, change, Engine::Clock::now());
        ASSERT_TRUE(turn_until([&] { return rendered(); }));
    }
    void inspect(const std::string& words) {
        inspect_by_script({words}, app);
        ASSERT_TRUE(turn_until([&] { return inspected(app, engine); }));
    }
    const InspectedSample& sample() { return state().shown->sample; }

    Engine engine;
};

TEST_F(InspectorAtWork, ShowsTheSampleOfTheImageThatIsShown) {
    render({.settings = true});
    const SubmittedJob& job = engine.jobs.back();
    // Any sample that found light: not every one does.
    InspectedSample expected;
    std::uint64_t number = 0;
    while (number < 100 && expected.paths.empty())
        expected = inspect_sample({job.prepared->scene, job.prepared->camera, job.settings}, 32, 24,
                                  ++number);
    inspect("32,24," + std::to_string(number));
    ASSERT_TRUE(state().shown);
    EXPECT_EQ(recorded_in(sample(), 32, 24), recorded_in(expected, 32, 24));
    EXPECT_EQ(sample().camera.size(), expected.camera.size());
    EXPECT_GE(state().picked, 0);
    EXPECT_FALSE(state().drawing->lines.empty());
    inspect("200,24");
    EXPECT_FALSE(state().shown) << "outside of the image";
    EXPECT_FALSE(state().note.empty());
}

TEST_F(InspectorAtWork, FollowsWhatChangesAndKeepsItsPlaceInSpace) {
    render({.settings = true});
    inspect("32,24,3");
    const auto first = state().shown;
    ASSERT_TRUE(first);
    // The camera moves: the very same path, seen from elsewhere.
    View view = current_view(app);
    view.eye += dvec3(0.1, 0.05, 0);
    const auto drawing = state().drawing;
    render(move_to(app, view));
    ASSERT_TRUE(turn_until([&] { return inspected(app, engine) && state().drawing != drawing; }));
    EXPECT_EQ(state().shown, first);
    EXPECT_TRUE(state().camera_moved);
    // Another exponent: the same sample with other weights.
    app.render.exponent = 0;
    render({.settings = true});
    ASSERT_TRUE(turn_until([&] { return state().shown != first; }));
    EXPECT_EQ(sample().exponents, std::vector<double>{0});
    EXPECT_EQ(sample().x, 32);
    EXPECT_EQ(sample().pass, 3u);
    EXPECT_EQ(sample().camera[1].position, first->sample.camera[1].position);
    // An image of another size has other pixels.
    app.render.settings.width = 80;
    render({.settings = true});
    EXPECT_FALSE(state().shown);
    inspect("32,24,3");
    ASSERT_TRUE(state().shown);
    inspect_by_script({"off"}, app);
    turn();
    EXPECT_FALSE(state().shown);
    EXPECT_FALSE(state().drawing);
}

TEST_F(InspectorAtWork, ExponentsOfTheSamePathsAreAtHand) {
    app.render.same_paths = true;
    render({.settings = true});
    inspect("20,30,1");
    ASSERT_TRUE(state().shown);
    const std::uint64_t job = engine.jobs.back().number;
    app.render.exponent = 0;
    ASSERT_TRUE(turn_until([&] { return sample().exponents[state().shown->exponent] == 0; }));
    EXPECT_EQ(engine.jobs.back().number, job) << "nothing is rendered anew";
}

TEST_F(InspectorAtWork, FindsTheBrightestSampleOfAPixel) {
    render({.settings = true});
    inspect("32,40,brightest");
    ASSERT_TRUE(state().shown);
    const SubmittedJob& job = engine.jobs.back();
    const BrightestSearch search{
        {job.prepared->scene, job.prepared->camera, job.settings}, 32, 40, 0, 4};
    const auto best = brightest_sample(search, RenderControl{}, {});
    ASSERT_TRUE(best);
    EXPECT_EQ(std::tie(sample().x, sample().y, sample().pass),
              std::tie(best->x, best->y, best->pass));
    EXPECT_EQ(recorded_in(sample(), 32, 40)[0], best->value);
    EXPECT_FALSE(state().progress);
    inspect("brightest");
    EXPECT_TRUE(state().shown || !state().note.empty());
}

TEST_F(InspectorAtWork, GoesToTheSampleThatWasNotFinite) {
    render({.settings = true});
    EXPECT_FALSE(inspect_nonfinite(app)) << "there is none";
    Snapshot snapshot = *app.snapshot;
    snapshot.statistics.nonfinite.add(40, 7, 2);
    app.snapshot = std::make_shared<const Snapshot>(snapshot);
    EXPECT_TRUE(inspect_nonfinite(app));
    ASSERT_TRUE(turn_until([&] { return inspected(app, engine); }));
    EXPECT_EQ(std::tuple(sample().x, sample().y, sample().pass), std::tuple(40, 7, 2u));
}

// A wall between the eye and a part of a line.
TEST(PathLines, AreCutWhereSomethingHidesThem) {
    SceneDescription d;
    add(d, make_quad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}), lambert(vec3(0.5f)));
    const std::shared_ptr<const Scene> scene = build(d);
    const Normalisation& n = scene->geometry->normalisation;
    const Camera camera = make_camera(camera_at({0, 0, 4}, {0, 0, 0}, 0.8), n, 400, 400);
    PathDrawing drawing;
    drawing.lines = {{{-0.9, 0.2, -1}, {0.9, 0.2, -1}}, {{-0.9, 0.2, 1}, {0.9, 0.2, 1}}};
    drawing.marks = {{{-0.5, 0, -1}, "C1"}, {{0.5, 0, -1}, "C2"}, {{-0.5, 0, 0}, "C3"}};
    const PathDrawing seen = seen_from(*scene, camera, drawing, RenderControl{});
    ASSERT_EQ(seen.lines.size(), 3u);
    EXPECT_TRUE(seen.lines[0].hidden);
    EXPECT_FALSE(seen.lines[1].hidden);
    EXPECT_FALSE(seen.lines[2].hidden);
    // The wall ends at x = 0, seen from the middle.
    EXPECT_NEAR(seen.lines[0].b.x, 0, 0.01);
    EXPECT_EQ(seen.lines[0].b, seen.lines[1].a);
    EXPECT_TRUE(seen.marks[0].hidden);
    EXPECT_FALSE(seen.marks[1].hidden);
    EXPECT_FALSE(seen.marks[2].hidden) << "a point on a surface is in sight";
}

TEST(PathLines, LandWhereTheCameraSeesThem) {
    SceneDescription d;
    add(d, make_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(vec3(0.5f)));
    add(d, make_quad({-0.5f, -0.5f, 3}, {1, 0, 0}, {0, 1, 0}), lamp(vec3(1)));
    const std::shared_ptr<const Scene> scene = build(d);
    const Normalisation& n = scene->geometry->normalisation;
    const CameraDescription eye = camera_at({0.3, 0.2, 2}, {0, 0, 0}, 0.8);
    const Camera camera = make_camera(eye, n, 40, 30);
    RenderSettings s = settings(Technique::bdpt, 8);
    s.width = 40;
    s.height = 30;
    for (int x = 12; x < 28; ++x) {
        const InspectedSample sample = inspect_sample({scene, eye, s}, x, 13, 2);
        ASSERT_GE(sample.camera.size(), 2u);
        const auto at = place_on_image(camera, n, sample.camera[1].position);
        ASSERT_TRUE(at);
        // Through the box filter the first vertex lies in its own pixel.
        EXPECT_EQ(ivec2(glm::floor(*at)), ivec2(x, 13));
    }
    EXPECT_FALSE(place_on_image(camera, n, {0.3, 0.2, 3})) << "behind the lens";
    const auto half = place_on_image(camera, n, dvec3(0.3, 0.2, 3), dvec3(0.3, 0.6, 0));
    ASSERT_TRUE(half);
    EXPECT_TRUE(std::isfinite(half->a.x) && std::isfinite(half->a.y));
}

}  // namespace
}  // namespace midway::test
