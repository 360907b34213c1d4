#include "integrator/facts.h"

#include "integrator/walk.h"

namespace midway {

Facts facts_of(const Estimator& e) {
    if (e.exponent_count != 1 || e.exponents[0] != 2) return no_facts;
    const bool light = e.families.needs_light_subpaths() || e.weighed[0].needs_light_subpaths();
    return light ? power2_facts : path_tracer_facts;
}

}  // namespace midway
