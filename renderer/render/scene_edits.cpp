#include "render/scene_edits.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "image/file.h"

namespace midway {
namespace {

// The fall-off divides by the difference of the cosines, so the cones must differ.
constexpr float widest_inner = 0.999f;

template <class T>
constexpr bool is_optional = false;
template <class T>
constexpr bool is_optional<std::optional<T>> = true;

template <class T>
bool in_range(const T& x, float low, float high) {
    if constexpr (std::is_same_v<T, float>) return x >= low && x <= high;
    if constexpr (std::is_same_v<T, vec3>)
        return in_range(x.x, low, high) && in_range(x.y, low, high) && in_range(x.z, low, high);
    return true;
}

template <class Edit>
bool has_values(const Edit& e) {
    bool any = false;
    visit_values(e, [&](const char*, const auto& value, float, float) {
        if constexpr (is_optional<std::remove_cvref_t<decltype(value)>>)
            any |= value.has_value();
        else
            any |= !value;
    });
    return any;
}

template <class Edit>
void check(const Edit& e, const std::string& what) {
    visit_values(e, [&](const char* name, const auto& value, float low, float high) {
        if constexpr (is_optional<std::remove_cvref_t<decltype(value)>>) {
            if (value && !in_range(*value, low, high))
                throw std::invalid_argument(fmt::format("{} out of range ({}); use {:g} to {:g}",
                                                        name, one_line(what), low, high));
        }
    });
}

template <class T>
std::string in_words(const T& x) {
    if constexpr (std::is_same_v<T, bool>) return x ? "on" : "off";
    if constexpr (std::is_same_v<T, float>) return fmt::format("{}", x);
    if constexpr (std::is_same_v<T, vec3>) return fmt::format("{},{},{}", x.x, x.y, x.z);
    if constexpr (std::is_same_v<T, PunctualKind>) return std::string(to_string(x));
}

template <class Edit>
std::string values_in_words(const Edit& e) {
    std::string text;
    visit_values(e, [&](const char* name, const auto& value, float, float) {
        std::string word;
        if constexpr (is_optional<std::remove_cvref_t<decltype(value)>>) {
            if (value) word = fmt::format("{} {}", name, in_words(*value));
        } else if (!value) {
            word = "off";
        }
        if (!word.empty()) text += (text.empty() ? "" : ", ") + word;
    });
    return text;
}

template <class Edit, class Item>
std::vector<int> find_places(const std::vector<Edit>& edits, const std::vector<Item>& items) {
    std::vector<int> at(edits.size(), -1);
    if (edits.empty()) return at;
    std::unordered_map<int, size_t> taken;
    const auto take = [&](size_t edit, int place) {
        if (taken.emplace(place, edit).second) at[edit] = place;
    };
    bool moved = false;
    for (size_t k = 0; k < edits.size(); ++k) {
        const Edit& e = edits[k];
        const bool there = e.index >= 0 && static_cast<size_t>(e.index) < items.size() &&
                           items[static_cast<size_t>(e.index)].name == e.name;
        if (there) take(k, e.index);
        moved |= !there;
    }
    if (!moved) return at;
    // Names that stand once.
    std::unordered_map<std::string_view, int> named;
    for (size_t i = 0; i < items.size(); ++i)
        if (const auto [it, first] = named.emplace(items[i].name, static_cast<int>(i)); !first)
            it->second = -1;
    for (size_t k = 0; k < edits.size(); ++k) {
        const auto it = named.find(edits[k].name);
        if (at[k] < 0 && it != named.end() && it->second >= 0 && !edits[k].name.empty())
            take(k, it->second);
    }
    return at;
}

template <class Edit, class Item>
Edit find_edit(const std::vector<Edit>& edits, const std::vector<Item>& items, int index) {
    const std::vector<int> at = find_places(edits, items);
    Edit e;
    for (size_t k = 0; k < edits.size(); ++k)
        if (at[k] == index) e = edits[k];
    e.name = items[static_cast<size_t>(index)].name;
    e.index = index;
    return e;
}

template <class Edit, class Item>
void put_edit(std::vector<Edit>& edits, const std::vector<Item>& items, int index, const Edit& e) {
    const std::vector<int> at = find_places(edits, items);
    size_t k = 0;
    while (k < edits.size() && at[k] != index) ++k;
    const auto place = edits.begin() + static_cast<std::ptrdiff_t>(k);
    if (!has_values(e)) {
        if (k < edits.size()) edits.erase(place);
    } else if (k < edits.size()) {
        *place = e;
    } else {
        edits.push_back(e);
    }
}

template <class T>
void drop_same(std::optional<T>& value, const T& of_file) {
    if (value && *value == of_file) value.reset();
}

}  // namespace

std::string_view to_string(PunctualKind kind) {
    switch (kind) {
        case PunctualKind::point:
            return "point";
        case PunctualKind::spot:
            return "spot";
        case PunctualKind::directional:
            return "directional";
    }
    return "";
}

PunctualKind parse_light_kind(std::string_view word) {
    for (const PunctualKind k :
         {PunctualKind::point, PunctualKind::spot, PunctualKind::directional})
        if (word == to_string(k)) return k;
    throw std::invalid_argument("unknown kind of light (" + one_line(std::string(word)) +
                                "); use point, spot or directional");
}

EmissionParts emission_parts(const Material& m) {
    if (m.emissive_factor * m.emissive_strength == m.emission && max_component(m.emission) > 0)
        return {m.emissive_factor, m.emissive_strength};
    const float strength = max_component(m.emission);
    if (!(strength > 0)) return {vec3(1), 0};
    return {m.emission / strength, strength};
}

Material values_of(const Material& material, const MaterialEdit& e) {
    Material m = material;
    if (e.emission_color || e.emission_strength) {
        const EmissionParts parts = emission_parts(material);
        m.emissive_factor = e.emission_color.value_or(parts.color);
        m.emissive_strength = e.emission_strength.value_or(parts.strength);
        m.emission = m.emissive_factor * m.emissive_strength;
    }
    m.base_color = e.base_color.value_or(m.base_color);
    m.alpha = e.alpha.value_or(m.alpha);
    m.metallic = e.metallic.value_or(m.metallic);
    m.roughness = e.roughness.value_or(m.roughness);
    m.ior = e.ior.value_or(m.ior);
    m.transmission = e.transmission.value_or(m.transmission);
    m.specular = e.specular.value_or(m.specular);
    m.double_sided = e.double_sided.value_or(m.double_sided);
    return m;
}

PunctualLight values_of(const PunctualLight& light, const LightEdit& e) {
    PunctualLight l = light;
    l.kind = e.kind.value_or(l.kind);
    l.color = e.color.value_or(l.color);
    l.intensity = e.strength.value_or(l.intensity);
    l.outer_cone_angle = e.outer_angle.value_or(l.outer_cone_angle);
    l.inner_cone_angle =
        std::min(e.inner_angle.value_or(l.inner_cone_angle), widest_inner * l.outer_cone_angle);
    return l;
}

Material edited(const Material& material, const MaterialEdit& e) {
    Material m = values_of(material, e);
    if (!e.on) m.emission = vec3(0);
    return m;
}

PunctualLight edited(const PunctualLight& light, const LightEdit& e) {
    PunctualLight l = values_of(light, e);
    if (!e.on) l.intensity = 0;
    return l;
}

std::vector<int> places(const std::vector<LightEdit>& edits,
                        const std::vector<PunctualLight>& lights) {
    return find_places(edits, lights);
}

std::vector<int> places(const std::vector<MaterialEdit>& edits,
                        const std::vector<Material>& materials) {
    return find_places(edits, materials);
}

LightEdit edit_of(const SceneEdits& edits, const std::vector<PunctualLight>& lights, int index) {
    return find_edit(edits.lights, lights, index);
}

MaterialEdit edit_of(const SceneEdits& edits, const std::vector<Material>& materials, int index) {
    return find_edit(edits.materials, materials, index);
}

void set_edit(SceneEdits& edits, const std::vector<PunctualLight>& lights, int index, LightEdit e) {
    const PunctualLight& l = lights[static_cast<size_t>(index)];
    drop_same(e.kind, l.kind);
    drop_same(e.color, l.color);
    drop_same(e.strength, l.intensity);
    drop_same(e.inner_angle, l.inner_cone_angle);
    drop_same(e.outer_angle, l.outer_cone_angle);
    put_edit(edits.lights, lights, index, e);
}

void set_edit(SceneEdits& edits, const std::vector<Material>& materials, int index,
              MaterialEdit e) {
    const Material& m = materials[static_cast<size_t>(index)];
    const EmissionParts parts = emission_parts(m);
    drop_same(e.emission_color, parts.color);
    drop_same(e.emission_strength, parts.strength);
    drop_same(e.base_color, m.base_color);
    drop_same(e.alpha, m.alpha);
    drop_same(e.metallic, m.metallic);
    drop_same(e.roughness, m.roughness);
    drop_same(e.ior, m.ior);
    drop_same(e.transmission, m.transmission);
    drop_same(e.specular, m.specular);
    drop_same(e.double_sided, m.double_sided);
    put_edit(edits.materials, materials, index, e);
}

void check_edits(const SceneEdits& edits) {
    check(edits.sky, "edit of the sky");
    for (const LightEdit& e : edits.lights) check(e, "edit of light \"" + e.name + "\"");
    for (const MaterialEdit& e : edits.materials) check(e, "edit of material \"" + e.name + "\"");
}

std::vector<std::string> edits_in_words(const SceneEdits& edits) {
    std::vector<std::string> lines;
    if (has_values(edits.sky)) lines.push_back("sky: " + values_in_words(edits.sky));
    for (const LightEdit& e : edits.lights)
        lines.push_back("light \"" + one_line(e.name) + "\": " + values_in_words(e));
    for (const MaterialEdit& e : edits.materials)
        lines.push_back("material \"" + one_line(e.name) + "\": " + values_in_words(e));
    return lines;
}

}  // namespace midway
