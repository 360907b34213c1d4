#include "render/image_metadata.h"

#include <fmt/format.h>

#include "render/film_file.h"

namespace midway {

Metadata image_metadata(const PreparedScene& p, const RenderSettings& settings,
                        std::uint64_t passes, std::uint64_t clamped) {
    Metadata m{{"midway:version", MIDWAY_VERSION},
               {"midway:scene", p.description.source},
               {"midway:scene_hash", hex_hash(p.hash)},
               {"midway:settings", settings_json(settings)},
               {"midway:seed", std::to_string(settings.seed)},
               {"midway:spp", std::to_string(passes)}};
    if (clamped > 0) m["midway:clamped"] = std::to_string(clamped) + " contributions";
    return m;
}

void set_exponent(Metadata& metadata, double exponent) {
    metadata["midway:exponent"] = fmt::format("{:g}", exponent);
}

std::string hex_hash(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

}  // namespace midway
