#include "render/leave_outs.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/coverage.h"

namespace midway {
namespace {

// How much of what materials can have the objects of a scene have.
struct MaterialUse {
    size_t materials = 0, places = 0, textures = 0, normal_maps = 0, transmission = 0;
};

MaterialUse material_use(const Scene& s) {
    std::vector<bool> used(s.materials.size());
    for (const Object& o : s.geometry->objects) used[static_cast<size_t>(o.material)] = true;
    MaterialUse use;
    for (size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        const Material& m = s.materials[i];
        ++use.materials;
        use.normal_maps += m.normal_texture.used();
        use.transmission += m.transmission > 0;
        for (const TextureRef* t : texture_refs(m)) {
            if (t == &m.normal_texture) continue;
            ++use.places;
            use.textures += t->used();
        }
    }
    return use;
}

void add_materials(const Scene& s, std::vector<LeaveOut>& list) {
    const MaterialUse use = material_use(s);
    if (use.textures == 0)
        list.push_back({"textures", "no material has one"});
    else if (use.textures < use.places)
        list.push_back(
            {"textures", fmt::format("{} of {} places for one in the materials are empty",
                                     use.places - use.textures, use.places)});
    if (use.normal_maps == 0)
        list.push_back({"normal maps", "no material has one"});
    else if (use.normal_maps < use.materials)
        list.push_back(
            {"normal maps", fmt::format("{} of {} materials have none",
                                        use.materials - use.normal_maps, use.materials)});
    if (const size_t n = s.geometry->spared_objects; n > 0)
        list.push_back(
            {"texture coordinates", fmt::format("no texture asks for some that {} object{}", n,
                                                n == 1 ? " has" : "s have")});
    if (use.transmission == 0) list.push_back({"transmission", "no material lets light through"});
}

void add_transparency(const Scene& s, std::vector<LeaveOut>& list) {
    const std::vector<Object>& objects = s.geometry->objects;
    const auto opaque = static_cast<size_t>(std::count_if(
        objects.begin(), objects.end(), [](const Object& o) { return !o.may_be_transparent; }));
    if (opaque == objects.size())
        list.push_back({"transparency", "every surface is opaque"});
    else if (opaque > 0)
        list.push_back(
            {"transparency", fmt::format("{} of {} objects are opaque", opaque, objects.size())});
}

void add_lights(const Scene& s, std::vector<LeaveOut>& list) {
    size_t black = 0;
    bool infinite = false;
    for (const Light& l : s.lights) {
        black += !(l.power > 0);
        infinite |= is_infinite(l.kind) && l.power > 0;
    }
    if (!infinite && !s.lights.empty())
        list.push_back({"lights at infinity", "there is neither a sun nor a sky that shines"});
    if (black > 0)
        list.push_back({"black lights", fmt::format("{} of {} are black", black, s.lights.size())});
    if (s.unreached_lights > 0)
        list.push_back({"lights", fmt::format("{} of {} shine on no surface, with {:.2g} % of all "
                                              "power",
                                              s.unreached_lights, s.lights.size(),
                                              100 * s.unreached_power / s.total_power)});
}

}  // namespace

std::vector<LeaveOut> leave_outs(const Scene& s) {
    std::vector<LeaveOut> list;
    for (const FamilyNeed& need : family_needs(scene_features(s)))
        if (!need.needed) list.push_back({need.family, need.why});
    add_lights(s, list);
    if (s.geometry->objects.empty()) return list;
    add_transparency(s, list);
    add_materials(s, list);
    return list;
}

}  // namespace midway
