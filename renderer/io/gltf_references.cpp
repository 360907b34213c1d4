#include "io/gltf_references.h"

#include <exception>
#include <filesystem>

#include "io/gltf_json.h"

namespace midway {
namespace {

using namespace gltf;

// Keeps the two lists of the document that name files; the rest may be large.
bool keep(int depth, Json::parse_event_t event, Json& parsed) {
    if (depth != 1 || event != Json::parse_event_t::key) return true;
    return parsed == "buffers" || parsed == "images";
}

std::vector<std::string> references(const std::string& path) {
    const Bytes bytes = read_file(path);
    const Container container = split_container(bytes, path);
    check_json_depth(container.json, path);
    const Json root = Json::parse(container.json, keep);
    std::vector<std::string> files;
    for (const char* list : {"buffers", "images"}) {
        const Json* entries = find(root, list);
        if (!entries || !entries->is_array()) continue;
        for (const Json& entry : *entries) {
            const std::string uri = text(entry, "uri");
            if (uri.empty() || is_data_uri(uri)) continue;
            files.push_back(
                (std::filesystem::path(path).parent_path() / percent_decode(uri)).string());
        }
    }
    return files;
}

}  // namespace

std::vector<std::string> gltf_references(const std::string& path) {
    try {
        return references(path);
    } catch (const std::exception&) {
        return {};
    }
}

}  // namespace midway
