#include "plan_json.h"

#include <cmath>

namespace midway {

using Json = nlohmann::ordered_json;

Json plan_json(const PlanDecision& d) {
    const auto one = [](const PlanForecast& f) {
        Json j;
        j["what"] = describe(f.plan);
        j["families"] = to_string(f.plan.families);
        j["light_subpaths_per_pixel"] = f.plan.light_quarters / 4.0;
        j["splats_direct_light"] = f.plan.splats_direct;
        j["direct_light_samples"] = f.plan.direct_samples;
        j["cost"] = f.cost;
        j["error"] = std::isfinite(f.error) ? Json(f.error) : Json(nullptr);
        j["time"] = std::isfinite(f.time()) ? Json(f.time()) : Json(nullptr);
        return j;
    };
    Json j = one(d.chosen());
    j["seconds"] = d.seconds;
    j["weighed_up"] = Json::array();
    for (const PlanForecast& f : d.forecasts) j["weighed_up"].push_back(one(f));
    return j;
}

}  // namespace midway
