#include "subject.h"

#include "render/film_file.h"

namespace midway {

Subject subject_of(const PreparedScene& scene, const RenderSettings& settings) {
    RenderSettings same = settings;
    const RenderSettings usual;
    same.technique = usual.technique;
    same.plan.reset();
    same.exponents = usual.exponents;
    same.sampler = usual.sampler;
    same.seed = usual.seed;
    same.crop.reset();
    return {scene.options.path,
            scene.hash,
            scene.camera,
            settings.width,
            settings.height,
            settings.crop.value_or(PixelRect{0, 0, settings.width, settings.height}),
            settings_json(same)};
}

std::string other_view(const Subject& then, const Subject& now) {
    if (then.file != now.file) return "another file is open";
    if (then.width != now.width || then.height != now.height)
        return "the image's size changed from " + std::to_string(then.width) + " x " +
               std::to_string(then.height);
    if (then.camera.to_world != now.camera.to_world || then.camera.yfov != now.camera.yfov)
        return "the camera moved";
    return {};
}

std::string other_image(const Subject& then, const Subject& now) {
    if (std::string why = other_view(then, now); !why.empty()) return why;
    if (then.camera.aperture_radius != now.camera.aperture_radius ||
        then.camera.focus_distance != now.camera.focus_distance)
        return "the lens changed";
    if (then.hash != now.hash) return "the scene was edited";
    const auto corners = [](const PixelRect& r) { return std::tie(r.x0, r.y0, r.x1, r.y1); };
    if (corners(then.crop) != corners(now.crop)) return "another region is rendered";
    if (then.settings != now.settings) return "the settings changed";
    return {};
}

}  // namespace midway
