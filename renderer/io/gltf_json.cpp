#include "io/gltf_json.h"

namespace midway::gltf {

const Json* find(const Json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto it = object.find(key);
    return it == object.end() ? nullptr : &*it;
}

Json* find(Json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto it = object.find(key);
    return it == object.end() ? nullptr : &*it;
}

std::uint64_t natural(const RawDocument& document, const Json& object, const char* key,
                      std::optional<std::uint64_t> otherwise) {
    const Json* value = find(object, key);
    if (!value && otherwise) return *otherwise;
    if (!value || !value->is_number_unsigned()) {
        fail(document.path, std::string("\"") + key + "\" is missing or no non-negative integer");
    }
    return value->get<std::uint64_t>();
}

std::string text(const Json& object, const char* key) {
    const Json* value = find(object, key);
    return value && value->is_string() ? value->get<std::string>() : std::string();
}

Json::array_t* array(RawDocument& document, const char* key) {
    Json* value = find(document.root, key);
    if (!value) return nullptr;
    if (!value->is_array()) fail(document.path, std::string("\"") + key + "\" is not an array");
    return value->get_ptr<Json::array_t*>();
}

ByteSpan buffer_range(const RawDocument& document, std::uint64_t buffer, std::uint64_t offset,
                      std::uint64_t length) {
    if (buffer >= document.buffers.size()) {
        fail(document.path, "buffer " + std::to_string(buffer) + " does not exist");
    }
    const ByteSpan bytes = document.buffers[buffer];
    if (offset > bytes.size() || length > bytes.size() - offset) {
        fail(document.path,
             "a buffer view reaches past the end of buffer " + std::to_string(buffer));
    }
    return bytes.subspan(offset, length);
}

int append_view(RawDocument& document, Bytes bytes, std::uint64_t stride) {
    Json view = {
        {"buffer", document.buffers.size()}, {"byteOffset", 0}, {"byteLength", bytes.size()}};
    if (stride) view["byteStride"] = stride;
    document.buffers.push_back(std::move(bytes));
    Json& views = document.root["bufferViews"];
    views.push_back(std::move(view));
    return static_cast<int>(views.size() - 1);
}

}  // namespace midway::gltf
