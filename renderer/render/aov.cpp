#include "render/aov.h"

#include <atomic>
#include <thread>

#include "math/float_mode.h"
#include "render/worker_priority.h"

namespace midway {
namespace {

void render_pixel(const Estimator& e, int samples, int x, int y, AovImages& out) {
    const double unscale = 1 / e.scene->geometry->normalisation.scale;
    dvec3 albedo(0), normal(0);
    double depth = 0;
    int hits = 0;
    for (int pass = 0; pass < samples; ++pass) {
        Walk w = start_camera_walk(e, x, y, static_cast<std::uint64_t>(pass));
        if (extend(e, w) != Reached::surface) continue;
        ++hits;
        const PathVertex& v = w.vertex;
        const float side = std::copysign(1.0f, glm::dot(v.ng, v.to_previous));
        albedo += dvec3(approximate_albedo(v.bsdf));
        normal += dvec3(v.bsdf.frame.n * side);
        depth += glm::dot(v.position - e.camera.position, e.camera.forward) * unscale;
    }
    const int px = x - e.crop.x0, py = y - e.crop.y0;
    out.albedo.at(px, py) = vec3(albedo / double(samples));
    out.normal.at(px, py) = vec3(normal / double(samples));
    if (hits > 0) out.depth.at(px, py) = vec3(static_cast<float>(depth / hits));

    const Ray center{e.camera.position,
                     camera_direction(e.camera, e.camera.position, {x + 0.5f, y + 0.5f})};
    const std::optional<SurfacePoint> p = intersect(*e.scene, center, 0);
    out.object.at(px, py) = vec3(p ? static_cast<float>(p->hit.object + 1) : 0.0f);
}

// False where `control`, if there is one, ended it early.
bool render_rows(const Estimator& e, int samples, int threads, const RenderControl* control,
                 AovImages& out) {
    std::atomic<int> next{e.crop.y0};
    std::atomic<bool> whole{true};
    std::vector<std::jthread> workers;
    for (int i = 0; i < threads; ++i)
        workers.emplace_back([&] {
            const ScopedFlushToZero flush;
            if (control) lower_priority();
            for (int y = next++; y < e.crop.y1; y = next++)
                for (int x = e.crop.x0; x < e.crop.x1; ++x) {
                    if (control && !control->go_on()) {
                        whole = false;
                        return;
                    }
                    render_pixel(e, samples, x, y, out);
                }
        });
    workers.clear();
    return whole;
}

AovImages blank(const Estimator& e) {
    const Image image(e.crop.width(), e.crop.height());
    return {image, image, image, image};
}

}  // namespace

AovImages render_aovs(const Estimator& e, int samples, int threads) {
    AovImages out = blank(e);
    render_rows(e, samples, threads, nullptr, out);
    return out;
}

std::optional<AovImages> render_aovs(const Estimator& e, int samples, int threads,
                                     const RenderControl& control) {
    AovImages out = blank(e);
    if (!render_rows(e, samples, threads, &control, out)) return {};
    return out;
}

}  // namespace midway
