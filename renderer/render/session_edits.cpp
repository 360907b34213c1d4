#include "render/session_edits.h"

#include <algorithm>

namespace midway {
namespace {

using Json = SessionJson;

constexpr size_t most_edits = 100000;
constexpr int highest_index = 1 << 30;

Json value_json(const vec3& v) { return {v.x, v.y, v.z}; }
Json value_json(PunctualKind k) { return to_string(k); }
template <class T>
Json value_json(const T& v) {
    return v;
}

template <class Edit>
void write_values(const Edit& e, Json& j) {
    visit_values(e, [&](const char* name, const auto& value, float, float) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, bool>) {
            if (!value) j[name] = false;
        } else if (value) {
            j[name] = value_json(*value);
        }
    });
}

template <class Edit>
Json list_json(const std::vector<Edit>& edits) {
    Json list = Json::array();
    for (const Edit& e : edits) {
        Json j{{"index", e.index}, {"name", e.name}};
        write_values(e, j);
        list.push_back(std::move(j));
    }
    return list;
}

float ranged(const SessionFields& f, const char* name, const Json& j, float low, float high) {
    const float x = f.small_number(name, j);
    if (!(x >= low && x <= high)) f.bad(name, "is out of range");
    return x;
}

struct Target {
    SessionFields& fields;
    const char* name;
    float low, high;
};

void read_value(const Target& t, bool& to) { t.fields.read(t.name, to); }
void read_value(const Target& t, std::optional<bool>& to) { t.fields.read(t.name, to); }
void read_value(const Target& t, std::optional<PunctualKind>& to) {
    PunctualKind kind{};
    if (!t.fields.find(t.name)) return;
    t.fields.read_word(t.name, kind, parse_light_kind);
    to = kind;
}
void read_value(const Target& t, std::optional<float>& to) {
    if (const Json* j = t.fields.find(t.name)) to = ranged(t.fields, t.name, *j, t.low, t.high);
}
void read_value(const Target& t, std::optional<vec3>& to) {
    const Json* j = t.fields.find(t.name);
    if (!j) return;
    t.fields.list(t.name, *j, 3, 3);
    to.emplace();
    for (int k = 0; k < 3; ++k)
        (*to)[k] = ranged(t.fields, t.name, (*j)[static_cast<size_t>(k)], t.low, t.high);
}

template <class Edit>
void read_values(SessionFields& f, Edit& e) {
    visit_values(e, [&](const char* name, auto& value, float low, float high) {
        read_value({f, name, low, high}, value);
    });
    f.warn_of_the_rest();
}

template <class Edit>
void read_list(SessionFields& f, const char* name, std::vector<Edit>& edits) {
    const Json* j = f.find(name);
    if (!j) return;
    std::vector<int> indices;
    for (const Json& object : f.list(name, *j, 0, most_edits)) {
        SessionFields fields = f.inside(name, object);
        Edit& e = edits.emplace_back();
        fields.read_whole("index", e.index, 0, highest_index);
        fields.read("name", e.name);
        read_values(fields, e);
        indices.push_back(e.index);
    }
    std::sort(indices.begin(), indices.end());
    if (std::adjacent_find(indices.begin(), indices.end()) != indices.end())
        f.bad(name, "holds two edits of the same index");
}

}  // namespace

SessionJson edits_json(const SceneEdits& edits) {
    Json j = Json::object();
    Json sky = Json::object();
    write_values(edits.sky, sky);
    if (!sky.empty()) j["sky"] = std::move(sky);
    if (!edits.lights.empty()) j["lights"] = list_json(edits.lights);
    if (!edits.materials.empty()) j["materials"] = list_json(edits.materials);
    return j;
}

void read_edits(SessionFields f, SceneEdits& edits) {
    if (const Json* j = f.find("sky")) {
        SessionFields sky = f.inside("sky", *j);
        read_values(sky, edits.sky);
    }
    read_list(f, "lights", edits.lights);
    read_list(f, "materials", edits.materials);
    f.warn_of_the_rest();
}

}  // namespace midway
