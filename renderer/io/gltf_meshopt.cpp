#include <meshoptimizer.h>

#include "io/gltf_compression.h"

namespace midway::gltf {
namespace {

struct CompressedView {
    ByteSpan data;
    std::uint64_t stride = 0, count = 0;
    std::string mode, filter;
};

// Reads and checks the extension's object; the decoder itself only asserts these conditions.
CompressedView read_view(const RawDocument& document, const Json& extension) {
    CompressedView view;
    view.data = buffer_range(document, natural(document, extension, "buffer"),
                             natural(document, extension, "byteOffset", 0),
                             natural(document, extension, "byteLength"));
    view.stride = natural(document, extension, "byteStride");
    view.count = natural(document, extension, "count");
    view.mode = text(extension, "mode");
    view.filter = text(extension, "filter");
    if (view.filter == "NONE") view.filter.clear();
    const bool attributes = view.mode == "ATTRIBUTES";
    const bool indices = view.mode == "TRIANGLES" || view.mode == "INDICES";
    bool good = (attributes && view.stride % 4 == 0 && view.stride > 0 && view.stride <= 252) ||
                (indices && (view.stride == 2 || view.stride == 4) && view.filter.empty());
    if (view.mode == "TRIANGLES" && view.count % 3 != 0) good = false;
    if (view.filter == "OCTAHEDRAL") good = good && (view.stride == 4 || view.stride == 8);
    if (view.filter == "QUATERNION") good = good && view.stride == 8;
    const bool known = view.filter.empty() || view.filter == "OCTAHEDRAL" ||
                       view.filter == "QUATERNION" || view.filter == "EXPONENTIAL";
    if (!good || !known || view.count > max_decoded_bytes / view.stride) {
        fail(document.path, "a meshopt buffer view has impossible parameters");
    }
    return view;
}

bool decode(const CompressedView& view, Bytes& out) {
    const unsigned char* data = view.data.data();
    const std::size_t size = view.data.size();
    if (view.mode == "TRIANGLES") {
        return meshopt_decodeIndexBuffer(out.data(), view.count, view.stride, data, size) == 0;
    }
    if (view.mode == "INDICES") {
        return meshopt_decodeIndexSequence(out.data(), view.count, view.stride, data, size) == 0;
    }
    if (meshopt_decodeVertexBuffer(out.data(), view.count, view.stride, data, size) != 0)
        return false;
    if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), view.count, view.stride);
    if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), view.count, view.stride);
    if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), view.count, view.stride);
    return true;
}

}  // namespace

void decode_meshopt(RawDocument& document) {
    Json::array_t* views = array(document, "bufferViews");
    if (!views) return;
    std::uint64_t left = max_decoded_bytes;
    for (Json& view : *views) {
        const Json* extensions = find(view, "extensions");
        const Json* extension = extensions ? find(*extensions, "EXT_meshopt_compression") : nullptr;
        if (!extension) continue;
        const CompressedView compressed = read_view(document, *extension);
        const std::uint64_t bytes = compressed.count * compressed.stride;
        if (bytes > left)
            fail(document.path, "more than 2 GiB of compressed data", "split the scene");
        left -= bytes;
        Bytes decoded(bytes);
        if (bytes > 0 && !decode(compressed, decoded)) {
            fail(document.path, "a meshopt buffer view cannot be decoded");
        }
        view = {{"buffer", document.buffers.size()}, {"byteLength", bytes}};
        if (compressed.mode == "ATTRIBUTES") view["byteStride"] = compressed.stride;
        document.buffers.push_back(std::move(decoded));
    }
}

}  // namespace midway::gltf
