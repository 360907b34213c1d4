// What a person changed about the lights and materials of a file: plain data that stands beside the
// file and is applied to its description. What is absent stays as in the file. Units are the
// file's; angles in radians.
//
// An edit names its light or material by name and index, so that it finds it again in a file that
// was exported anew: the same name at the same index, else the only one of that name. An edit that
// finds nothing is left out with a warning, and kept, in case the next export brings it back.
#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/scene_description.h"

namespace midway {

// Of a lamp without size (KHR_lights_punctual).
struct LightEdit {
    std::string name;
    int index = 0;  // in SceneDescription::lights
    bool on = true;
    std::optional<PunctualKind> kind;
    std::optional<vec3> color;
    std::optional<float> strength;  // intensity per steradian, or irradiance
    std::optional<float> inner_angle, outer_angle;
    bool operator==(const LightEdit&) const = default;
};

// Of a material; all of its triangles are one lamp where it shines.
struct MaterialEdit {
    std::string name;
    int index = 0;   // in SceneDescription::materials
    bool on = true;  // false: it does not shine
    std::optional<vec3> emission_color;
    std::optional<float> emission_strength;
    std::optional<vec3> base_color;
    std::optional<float> alpha, metallic, roughness, ior, transmission, specular;
    std::optional<bool> double_sided;
    bool operator==(const MaterialEdit&) const = default;
};

struct SkyEdit {
    bool on = true;
    std::optional<vec3> color;  // of a sky of one colour; a factor on a map
    bool operator==(const SkyEdit&) const = default;
};

struct SceneEdits {
    SkyEdit sky;
    std::vector<LightEdit> lights;
    std::vector<MaterialEdit> materials;
    bool empty() const { return sky == SkyEdit{} && lights.empty() && materials.empty(); }
    bool operator==(const SceneEdits&) const = default;
};

// Every value of an edit with its name and range, for whoever reads, writes, checks or lists them:
// visit(name, value, low, high). Values are bool (true: as in the file) or optional.
inline constexpr float largest_light = 1e30f, largest_ior = 1000;
inline constexpr float narrowest_cone = 1e-3f, widest_cone = 1.5707963f;

template <class Edit, class Visit>
requires std::is_same_v<std::remove_const_t<Edit>, LightEdit>
void visit_values(Edit& e, const Visit& visit) {
    visit("on", e.on, 0.0f, 1.0f);
    visit("kind", e.kind, 0.0f, 0.0f);
    visit("color", e.color, 0.0f, largest_light);
    visit("strength", e.strength, 0.0f, largest_light);
    visit("inner_angle", e.inner_angle, 0.0f, widest_cone);
    visit("outer_angle", e.outer_angle, narrowest_cone, widest_cone);
}

template <class Edit, class Visit>
requires std::is_same_v<std::remove_const_t<Edit>, MaterialEdit>
void visit_values(Edit& e, const Visit& visit) {
    visit("on", e.on, 0.0f, 1.0f);
    visit("emission_color", e.emission_color, 0.0f, largest_light);
    visit("emission_strength", e.emission_strength, 0.0f, largest_light);
    visit("base_color", e.base_color, 0.0f, 1.0f);
    visit("alpha", e.alpha, 0.0f, 1.0f);
    visit("metallic", e.metallic, 0.0f, 1.0f);
    visit("roughness", e.roughness, 0.0f, 1.0f);
    visit("ior", e.ior, 1.0f, largest_ior);
    visit("transmission", e.transmission, 0.0f, 1.0f);
    visit("specular", e.specular, 0.0f, 1.0f);
    visit("double_sided", e.double_sided, 0.0f, 1.0f);
}

template <class Edit, class Visit>
requires std::is_same_v<std::remove_const_t<Edit>, SkyEdit>
void visit_values(Edit& e, const Visit& visit) {
    visit("on", e.on, 0.0f, 1.0f);
    visit("color", e.color, 0.0f, largest_light);
}

std::string_view to_string(PunctualKind kind);
PunctualKind parse_light_kind(std::string_view word);  // throws std::invalid_argument

// Colour and strength that `emission` is the product of: the file's own where it has two, else the
// largest component is the strength.
struct EmissionParts {
    vec3 color{1};
    float strength = 0;
};
EmissionParts emission_parts(const Material& material);

// A material or a lamp with its edit, switched off or not. `values_of` leaves the switch alone.
Material values_of(const Material& material, const MaterialEdit& edit);
PunctualLight values_of(const PunctualLight& light, const LightEdit& edit);
Material edited(const Material& material, const MaterialEdit& edit);
PunctualLight edited(const PunctualLight& light, const LightEdit& edit);

// Where each edit belongs, in the order of the edits; -1: nowhere. No two belong to the same place:
// the first one counts.
std::vector<int> places(const std::vector<LightEdit>& edits,
                        const std::vector<PunctualLight>& lights);
std::vector<int> places(const std::vector<MaterialEdit>& edits,
                        const std::vector<Material>& materials);

// The edit of one light or material of the file; one without values where there is none.
LightEdit edit_of(const SceneEdits& edits, const std::vector<PunctualLight>& lights, int index);
MaterialEdit edit_of(const SceneEdits& edits, const std::vector<Material>& materials, int index);

// Puts it in its place. Values that are the file's own are dropped, and so is an edit without any.
void set_edit(SceneEdits& edits, const std::vector<PunctualLight>& lights, int index,
              LightEdit edit);
void set_edit(SceneEdits& edits, const std::vector<Material>& materials, int index,
              MaterialEdit edit);

// Throws std::invalid_argument with one line where a value is not finite or out of its range.
void check_edits(const SceneEdits& edits);

// One line for each thing that was changed: "material "lamp": emission_strength 3, roughness 0.2".
std::vector<std::string> edits_in_words(const SceneEdits& edits);

}  // namespace midway
