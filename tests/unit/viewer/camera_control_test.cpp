// Camera gestures as pure functions: what each must keep (distance, the point under the mouse, the
// poles, the renderer's own camera to the bit) and that none depends on the frame rate.
#include "viewer/camera_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/scenes.h"

namespace midway::test {
namespace {

const Viewport port{1280, 720};
const View start{{3, 1.5, 4}, {0.2, 0.7, -0.3}, 0.8};

double distance_of(const View& v, const dvec3& p) { return glm::length(v.eye - p); }

double elevation_of(const View& v) { return std::asin(view_basis(v).forward.y); }

void expect_near(const dvec3& a, const dvec3& b, double tolerance) {
    EXPECT_LT(glm::length(a - b), tolerance)
        << a.x << ' ' << a.y << ' ' << a.z << " against " << b.x << ' ' << b.y << ' ' << b.z;
}

void expect_same_pixel(const View& a, const View& b, const dvec3& point) {
    const std::optional<dvec2> p = project(a, port, point), q = project(b, port, point);
    ASSERT_TRUE(p && q);
    EXPECT_LT(glm::length(*p - *q), 1e-6);
}

TEST(CameraControl, PixelsAgreeWithTheRenderersCamera) {
    CameraDescription description;
    description.yfov = start.yfov;
    description = look_at(description, start.eye, start.target);
    const Camera camera = make_camera(description, {}, 1280, 720);
    for (const dvec2 pixel : {dvec2(0, 0), dvec2(640, 360), dvec2(1280, 0), dvec2(17.5, 700.25)}) {
        const dvec3 ours = glm::normalize(pixel_direction(start, port, pixel));
        expect_near(ours, dvec3(camera_direction(camera, camera.position, vec2(pixel))), 1e-6);
        const dvec3 point = start.eye + ours * 2.5;
        EXPECT_LT(glm::length(project(start, port, point).value() - pixel), 1e-9);
    }
    EXPECT_FALSE(project(start, port, start.eye + (start.eye - start.target)));
}

TEST(CameraControl, WishesHoldAViewToTheBit) {
    CameraDescription camera;
    camera.yfov = 0.7;
    SceneOptions options;
    const View of_file = view_in(options, camera, {0, 0, -5});
    EXPECT_EQ(of_file.target, dvec3(0, 0, -5));
    use_view({start.eye, start.target, 0.7}, camera, options);
    EXPECT_FALSE(options.fov_degrees) << "the file's field of view is still in use";

    options.fov_degrees = 33.3;
    View view = view_in(options, camera, {0, 0, 0});
    EXPECT_EQ(view.eye, start.eye);
    EXPECT_EQ(view.target, start.target);
    use_view(view, camera, options);
    EXPECT_EQ(options.fov_degrees, 33.3);
    view.yfov = 0.5;
    use_view(view, camera, options);
    EXPECT_NEAR(options.fov_degrees.value(), glm::degrees(0.5), 1e-12);
}

TEST(CameraControl, OrbitKeepsTheDistanceAndThePivotsPixel) {
    const dvec3 pivot{0.5, 0.2, 0.4};
    View v = start;
    for (int i = 0; i < 500; ++i) {
        const dvec2 drag(7 * std::sin(i * 0.7), 5 * std::cos(i * 1.3));
        const View next = orbit(v, pivot, drag, port);
        expect_same_pixel(v, next, pivot);
        v = next;
    }
    EXPECT_NEAR(distance_of(v, pivot), distance_of(start, pivot), 1e-9);
    EXPECT_NEAR(distance_of(v, v.target), distance_of(start, start.target), 1e-9);
    EXPECT_GT(glm::length(v.eye - start.eye), 0.1);
}

TEST(CameraControl, OrbitFollowsTheMouse) {
    // What is in front of the pivot moves with the mouse: right, and down.
    const dvec3 pivot = start.target;
    const dvec3 front = pivot + 0.1 * glm::normalize(start.eye - pivot);
    const dvec2 before = project(start, port, front).value();
    EXPECT_GT(project(orbit(start, pivot, {20, 0}, port), port, front)->x, before.x + 0.1);
    EXPECT_GT(project(orbit(start, pivot, {0, 20}, port), port, front)->y, before.y + 0.1);
}

TEST(CameraControl, NeverTurnsOverThePoles) {
    for (const double step : {-400.0, 400.0, -10.0, 10.0}) {
        View turned = start, looked = start;
        for (int i = 0; i < 300; ++i) {
            turned = orbit(turned, {0, 0, 0}, {1, step}, port);
            looked = look_around(looked, {1, step}, port);
            EXPECT_GT(view_basis(turned).up.y, 0);
            EXPECT_GT(view_basis(looked).up.y, 0);
        }
        EXPECT_NEAR(std::abs(elevation_of(turned)), glm::radians(89.0), 1e-6);
        EXPECT_NEAR(std::abs(elevation_of(looked)), glm::radians(89.0), 1e-6);
    }
}

TEST(CameraControl, ACameraThatLooksStraightDownComesBack) {
    const View down{{0, 5, 0}, {0, 0, 0}, 0.7};
    EXPECT_NEAR(elevation_of(orbit(down, {0, 0, 0}, {0, 50}, port)), -std::numbers::pi / 2, 1e-6);
    const View back = orbit(down, {0, 0, 0}, {0, -50}, port);
    EXPECT_NEAR(elevation_of(back), -std::numbers::pi / 2 + 50 * std::numbers::pi / 720, 1e-6);
    EXPECT_NEAR(distance_of(back, {0, 0, 0}), 5, 1e-9);
}

TEST(CameraControl, LookingAroundTurnsToWhereTheMouseGoes) {
    const View v = look_around(start, {12, -9}, port);
    EXPECT_EQ(v.eye, start.eye);
    const dvec2 middle = project(v, port, start.target).value();
    EXPECT_NEAR(middle.x, 640 - 12, 0.5);
    EXPECT_NEAR(middle.y, 360 + 9, 0.5);
}

TEST(CameraControl, PanKeepsThePointUnderTheMouse) {
    const dvec3 held{0.8, 0.1, -2};
    View v = start;
    for (const dvec2 pixel : {dvec2(100, 100), dvec2(1279, 3), dvec2(640, 719)}) {
        v = pan(v, port, held, pixel);
        EXPECT_LT(glm::length(project(v, port, held).value() - pixel), 1e-6);
    }
    expect_near(view_basis(v).forward, view_basis(start).forward, 1e-9);
    EXPECT_NEAR(depth_of(v, held), depth_of(start, held), 1e-9);
}

TEST(CameraControl, DollyKeepsItsPointAndStopsBeforeIt) {
    const dvec3 towards{0.8, 0.1, -2};
    View v = start;
    for (int i = 0; i < 100; ++i) {
        const View next = dolly(v, towards, 0.8, 10);
        expect_same_pixel(v, next, towards);
        v = next;
    }
    EXPECT_NEAR(distance_of(v, towards), 1e-3, 1e-9);
    for (int i = 0; i < 200; ++i) v = dolly(v, towards, 1.25, 10);
    EXPECT_NEAR(distance_of(v, towards), 1e4, 1e-6);
    expect_near(view_basis(v).forward, view_basis(start).forward, 1e-6);
}

TEST(CameraControl, FrameFillsTheImageAndLosesNothing) {
    const Bounds bounds{{-1, 0, -2}, {4, 1, 3}};
    for (const double aspect : {0.4, 1.0, 16.0 / 9}) {
        const View v = frame(start, bounds, aspect);
        const Viewport image{aspect * 1000, 1000};
        double widest = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const dvec3 p(corner & 1 ? 4 : -1, corner & 2 ? 1 : 0, corner & 4 ? 3 : -2);
            const dvec2 at = project(v, image, p).value();
            widest = std::max({widest, std::abs(at.x / image.width * 2 - 1),
                               std::abs(at.y / image.height * 2 - 1)});
        }
        EXPECT_NEAR(widest, 1 / 1.06, 1e-9);
        expect_near(view_basis(v).forward, view_basis(start).forward, 1e-9);
    }
}

TEST(CameraControl, FlightDoesNotDependOnTheFrameRate) {
    const FlyInput input{1, -0.5, 0.25, 3};
    View once = start, often = start;
    dvec3 velocity_once(0), velocity_often(0);
    once = fly(once, velocity_once, input, 0.5);
    for (int i = 0; i < 100; ++i) often = fly(often, velocity_often, input, 0.005);
    expect_near(once.eye, often.eye, 1e-9);
    expect_near(velocity_once, velocity_often, 1e-9);
    EXPECT_NEAR(glm::length(velocity_once), 3, 0.02);
    // Without a wish the flight ends.
    for (int i = 0; i < 10; ++i) often = fly(often, velocity_often, {0, 0, 0, 3}, 0.1);
    EXPECT_FALSE(is_moving(velocity_often, {0, 0, 0, 3}));
}

TEST(CameraControl, GlidesDoNotDependOnTheFrameRateAndEnd) {
    DollyGlide fast{{0, 0, 0}, -0.7}, slow{{0, 0, 0}, -0.7};
    View a = start, b = start;
    a = advance(fast, a, 10, 0.1);
    for (int i = 0; i < 20; ++i) b = advance(slow, b, 10, 0.005);
    expect_near(a.eye, b.eye, 1e-9);
    for (int i = 0; i < 100 && slow.log_factor != 0; ++i) b = advance(slow, b, 10, 0.016);
    EXPECT_EQ(slow.log_factor, 0);
    EXPECT_NEAR(distance_of(b, {0, 0, 0}), distance_of(start, {0, 0, 0}) * std::exp(-0.7), 1e-9);

    const View other{{-3, 2, -4}, {1, 0, 1}, 0.5};
    ViewGlide glide{start, other, glide_seconds / 2};
    EXPECT_GT(distance_of(glide_view(glide), glide_view(glide).target), 0.1);
    glide.elapsed = glide_seconds;
    EXPECT_TRUE(finished(glide));
    EXPECT_EQ(glide_view(glide).eye, other.eye);
}

TEST(CameraControl, FindsTheSurfaceUnderAPixelInTheFilesUnits) {
    // A square of two units in the plane z = 0, far from the origin: normalised when built.
    const dvec3 center{100, -40, 7};
    SceneDescription d;
    auto mesh = std::make_shared<Mesh>();
    for (const vec2 c : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)})
        mesh->positions.push_back(vec3(c, 0));
    mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
    d.meshes.push_back(mesh);
    d.materials.emplace_back();
    Instance instance;
    instance.to_world = glm::dmat4(1);
    instance.to_world[3] = dvec4(center, 1);
    d.instances.push_back(instance);
    std::vector<std::string> warnings;
    const Scene scene = build_scene(d, warnings);

    const View view{center + dvec3(0.3, 0.2, 4), center + dvec3(0.3, 0.2, 0), 0.8};
    const dvec3 seen = center + dvec3(-0.6, 0.5, 0);
    const dvec2 pixel = project(view, port, seen).value();
    const std::optional<dvec3> found = surface_at(scene, view, port, pixel);
    ASSERT_TRUE(found);
    expect_near(*found, seen, 1e-4);
    EXPECT_FALSE(surface_at(scene, view, port, {0, 0}));
    expect_near(natural_pivot(scene, view), view.target, 1e-4);
    EXPECT_NEAR(scene_radius(scene), std::sqrt(2.0), 1e-5);
}

}  // namespace
}  // namespace midway::test
