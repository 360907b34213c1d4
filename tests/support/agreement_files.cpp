#include <filesystem>

#include "render/coverage.h"
#include "render/prepare.h"
#include "support/agreement_scenes.h"

namespace midway::test {

AgreementScene load_agreement_scene(const std::string& path, const std::string& sky) {
    SceneOptions options;
    options.path = path;
    if (!sky.empty()) options.sky = sky;
    const PreparedScene p = prepare_scene(options);
    AgreementScene s;
    s.name = std::filesystem::path(path).stem().string();
    s.scene = p.scene;
    s.camera = p.camera;
    s.sees_smooth = scene_features(*p.scene).smooth;
    return s;
}

}  // namespace midway::test
