// Edits in words, for scripts.
#include <charconv>
#include <stdexcept>

#include "viewer/edits.h"

namespace midway {
namespace {

using Words = std::vector<std::string>;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

float number(const std::string& text, float low, float high) {
    float x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (error != std::errc() || end != text.data() + text.size() || !(x >= low && x <= high))
        refuse("not a number in range: \"" + text + "\"");
    return x;
}

bool on_off(const std::string& text) {
    if (text != "on" && text != "off") refuse("neither on nor off: \"" + text + "\"");
    return text == "on";
}

vec3 color(const std::string& text, float low, float high) {
    vec3 c;
    size_t start = 0;
    for (int k = 0; k < 3; ++k) {
        const size_t comma = k < 2 ? text.find(',', start) : text.size();
        if (comma == std::string::npos) refuse("not R,G,B: \"" + text + "\"");
        c[k] = number(text.substr(start, comma - start), low, high);
        start = comma + 1;
    }
    return c;
}

template <class Edit>
void set_by_name(Edit& e, const std::string& key, const std::string& text) {
    bool known = false;
    visit_values(e, [&](const char* name, auto& value, float low, float high) {
        if (key != name) return;
        known = true;
        using T = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<T, bool>) {
            value = text == "file" || on_off(text);
        } else {
            value.reset();
            if (text == "file") return;
            using Value = typename T::value_type;
            if constexpr (std::is_same_v<Value, float>) value = number(text, low, high);
            if constexpr (std::is_same_v<Value, vec3>) value = color(text, low, high);
            if constexpr (std::is_same_v<Value, bool>) value = on_off(text);
            if constexpr (std::is_same_v<Value, PunctualKind>) value = parse_light_kind(text);
        }
    });
    if (!known) refuse("nothing to edit is called \"" + key + "\"");
}

template <class Item>
int find(const std::vector<Item>& items, const std::string& name) {
    for (size_t i = 0; i < items.size(); ++i)
        if (items[i].name == name) return static_cast<int>(i);
    size_t index = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
    if (error != std::errc() || end != name.data() + name.size() || index >= items.size())
        refuse("the file holds no \"" + name + "\"");
    return static_cast<int>(index);
}

}  // namespace

Change edit_by_name(App& app, const Words& w) {
    if (!app.document.prepared) refuse("no scene is open");
    if (w.size() != (w.at(0) == "sky" ? 3u : 4u)) refuse("wrong number of words");
    const FileContents& file = *app.document.prepared->file;
    if (w[0] == "sky") {
        SkyEdit e = app.document.options.edits.sky;
        set_by_name(e, w[1], w[2]);
        return change_sky(app, e);
    }
    if (w[0] == "light") {
        const int light = find(file.lights, w[1]);
        LightEdit e = light_edit(app, light);
        set_by_name(e, w[2], w[3]);
        return change_light(app, light, std::move(e));
    }
    if (w[0] != "material") refuse("neither light, material nor sky: \"" + w[0] + "\"");
    const int material = find(file.materials, w[1]);
    MaterialEdit e = material_edit(app, material);
    set_by_name(e, w[2], w[3]);
    return change_material(app, material, std::move(e));
}

}  // namespace midway
