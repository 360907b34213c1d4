// Broken and hostile glTF files: one line that says what, where and what to do; never a crash.
#include <gtest/gtest.h>

#include "unit/gltf_test_files.h"

namespace midway::test {
namespace {

// Expects an error that mentions `what` and has the form "WHAT (WHERE); REMEDY" on one line.
void expect_error(const std::string& message, const std::string& what) {
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_NE(message.find("); "), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

std::string error_of_bytes(const std::string& bytes) {
    TempDir folder;
    write_file(folder / "scene.any", bytes);
    try {
        load_gltf((folder / "scene.any").string());
    } catch (const std::runtime_error& failure) {
        return failure.what();
    }
    return "";
}

std::string u32(std::uint32_t value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string glb(std::string json, const std::string& binary) {
    while (json.size() % 4 != 0) json += ' ';
    std::string body = u32(static_cast<std::uint32_t>(json.size())) + "JSON" + json;
    if (!binary.empty()) {
        body += u32(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
    }
    return "glTF" + u32(2) + u32(static_cast<std::uint32_t>(12 + body.size())) + body;
}

std::string square_glb() {
    GltfFile file;
    file.show(file.square_primitive());
    file.root["buffers"] = {{{"byteLength", file.binary.size()}}};
    return glb(file.root.dump(), file.binary);
}

TEST(GltfError, BinaryContainerIsKnownByItsContent) { EXPECT_EQ(error_of_bytes(square_glb()), ""); }

TEST(GltfError, TruncatedBinaryContainerAtEveryLength) {
    const std::string whole = square_glb();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        ASSERT_NE(error_of_bytes(whole.substr(0, length)), "") << length;
    }
    expect_error(error_of_bytes(whole.substr(0, whole.size() - 1)), "truncated");
}

TEST(GltfError, ChunkLongerThanTheFile) {
    std::string bytes = square_glb();
    bytes.replace(12, 4, u32(0xfffffff0));
    expect_error(error_of_bytes(bytes), "truncated GLB chunk");
}

TEST(GltfError, NoSuchFileAndDirectory) {
    EXPECT_THROW(load_gltf("/nonexistent/scene.gltf"), std::runtime_error);
    EXPECT_THROW(load_gltf("/"), std::runtime_error);
}

TEST(GltfError, DeepJsonIsRefusedBeforeParsing) {
    expect_error(error_of_bytes(std::string(200000, '[')), "nests deeper");
    const std::string extras =
        "{\"asset\":{\"version\":\"2.0\"},\"extras\":\"" + std::string(20000, '[') + "\"}";
    EXPECT_EQ(error_of_bytes(extras), "");
}

TEST(GltfError, NotJson) {
    expect_error(error_of_bytes("{\"asset\": tru}"), "not valid JSON");
    expect_error(error_of_bytes(""), "no JSON");
    expect_error(error_of_bytes("[]"), "not an object");
}

TEST(GltfError, VersionOneIsRefused) {
    expect_error(error_of_bytes("{\"asset\":{\"version\":\"1.0\"}}"), "version 1.0");
}

TEST(GltfError, RequiredUnknownExtensionIsNamed) {
    GltfFile file;
    file.root["extensionsRequired"] = {"KHR_unheard_of"};
    expect_error(file.error(), "KHR_unheard_of");
}

TEST(GltfError, MissingBuffer) {
    GltfFile file;
    file.show(file.square_primitive());
    file.root["buffers"] = {{{"uri", "absent.bin"}, {"byteLength", 12}}};
    expect_error(file.error(), "absent.bin");
}

TEST(GltfError, ShortBuffer) {
    GltfFile file;
    file.show(file.square_primitive());
    write_file(file.folder / "short.bin", file.binary.substr(1));
    file.root["buffers"] = {{{"uri", "short.bin"}, {"byteLength", file.binary.size()}}};
    expect_error(file.error(), "buffer 0 holds");
}

TEST(GltfError, PathsOutOfTheFolderAreRefused) {
    GltfFile file;
    TempDir elsewhere;
    write_file(elsewhere / "secret.bin", std::string(64, 'x'));
    std::filesystem::create_symlink(elsewhere / "secret.bin", file.folder / "link.bin");
    std::filesystem::create_directory(file.folder / "directory");
    const std::string outside = "../" + elsewhere.path().filename().string() + "/secret.bin";
    const std::string encoded = "%2e%2E/" + elsewhere.path().filename().string() + "/secret.bin";
    for (const std::string& uri :
         {outside, encoded, (elsewhere / "secret.bin").string(), std::string("link.bin"),
          std::string("directory"), std::string("."), std::string("file:///etc/passwd"),
          std::string("scene.bin\0", 10)}) {
        file.root["buffers"] = {{{"uri", uri}, {"byteLength", 1}}};
        EXPECT_NE(file.error(), "") << uri;
    }
}

TEST(GltfError, IndexBeyondTheVertices) {
    GltfFile file;
    const int indices = file.accessor(std::vector<std::uint8_t>{0, 1, 4}, "SCALAR", type_ubyte, 3);
    file.show({{"attributes", {{"POSITION", file.square()}}}, {"indices", indices}});
    expect_error(file.error(), "vertex 4 of 4");
}

TEST(GltfError, ReferencesThatDoNotExist) {
    for (const char* what : {"mesh", "camera", "skin"}) {
        GltfFile file;
        const int node = file.show(file.square_primitive());
        file.root["nodes"][node][what] = 7;
        expect_error(file.error(), "7 does not exist");
    }
    for (const char* what : {"POSITION", "NORMAL", "JOINTS_0"}) {
        GltfFile file;
        Json primitive = file.square_primitive();
        primitive["attributes"][what] = 77;
        file.show(primitive);
        if (std::string(what) != "JOINTS_0") expect_error(file.error(), "77 does not exist");
    }
    GltfFile file;
    Json primitive = file.square_primitive();
    primitive["material"] = 7;
    file.show(primitive);
    expect_error(file.error(), "material 7");
}

// Each edit makes a range that ends outside its buffer or wraps around.
TEST(GltfError, RangesBeyondTheirBuffer) {
    const auto edited = [](const char* kind, const char* key, const Json& value) {
        GltfFile file;
        file.show(file.square_primitive());
        file.root[kind][0][key] = value;
        return file.error();
    };
    const std::uint64_t huge = ~std::uint64_t{0};
    EXPECT_NE(edited("bufferViews", "byteOffset", 1000), "");
    EXPECT_NE(edited("bufferViews", "byteOffset", huge), "");
    EXPECT_NE(edited("bufferViews", "byteOffset", -4), "");
    EXPECT_NE(edited("bufferViews", "byteLength", huge), "");
    EXPECT_NE(edited("bufferViews", "byteLength", 47), "");
    EXPECT_NE(edited("bufferViews", "byteStride", 16), "");
    EXPECT_NE(edited("bufferViews", "byteStride", 4), "");
    EXPECT_NE(edited("bufferViews", "buffer", 1), "");
    EXPECT_NE(edited("bufferViews", "buffer", -1), "");
    EXPECT_NE(edited("bufferViews", "buffer", std::int64_t{1} << 32), "");
    EXPECT_NE(edited("accessors", "byteOffset", 4), "");
    EXPECT_NE(edited("accessors", "byteOffset", huge), "");
    EXPECT_NE(edited("accessors", "count", 5), "");
    EXPECT_NE(edited("accessors", "count", huge), "");
    EXPECT_NE(edited("accessors", "count", huge / 12 + 2), "");
    EXPECT_NE(edited("accessors", "bufferView", 9), "");
    EXPECT_NE(edited("accessors", "componentType", 5124), "");
    EXPECT_NE(edited("accessors", "type", "VEC2"), "");
}

TEST(GltfError, SparseRangesAreChecked) {
    const auto edited = [](const std::string& pointer, const Json& value) {
        GltfFile file;
        const Json primitive = file.square_primitive();
        const int places = file.view(std::vector<std::uint8_t>{3});
        const int values = file.view(std::vector<float>{5, 6, 7});
        file.root["accessors"][0]["sparse"] = {
            {"count", 1},
            {"indices", {{"bufferView", places}, {"componentType", type_ubyte}}},
            {"values", {{"bufferView", values}}}};
        file.show(primitive);
        file.root["accessors"][0]["sparse"][Json::json_pointer(pointer)] = value;
        return file.error();
    };
    EXPECT_EQ(edited("/count", 1), "");
    EXPECT_NE(edited("/count", -1), "");
    EXPECT_NE(edited("/count", 5), "");
    EXPECT_NE(edited("/indices/byteOffset", 1), "");
    EXPECT_NE(edited("/indices/byteOffset", -1), "");
    EXPECT_NE(edited("/indices/bufferView", 99), "");
    EXPECT_NE(edited("/indices/componentType", type_float), "");
    EXPECT_NE(edited("/values/byteOffset", 4), "");
    EXPECT_NE(edited("/values/bufferView", -2), "");
}

// 40 bytes of JSON that ask for gigabytes of zeros.
TEST(GltfError, AccessorWithoutDataIsBounded) {
    GltfFile file;
    const int positions = file.add(
        "accessors", {{"componentType", type_float}, {"count", 1u << 25}, {"type", "VEC3"}});
    file.show({{"attributes", {{"POSITION", positions}}}});
    expect_error(file.error(), "too many");
}

TEST(GltfError, OverflowingTransformIsLeftOutWithAWarning) {
    GltfFile file;
    int child = file.show(file.square_primitive());
    file.root["nodes"][child]["scale"] = {1e200, 1e200, 1e200};
    file.add("nodes", {{"children", {child}}, {"scale", {1e200, 1e200, 1e200}}});
    const SceneDescription scene = file.load();
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_TRUE(mentions(scene.warnings, "infinite transform"));
}

TEST(GltfError, NamesOfStrangersStayOnOneLine) {
    GltfFile file;
    const int node = file.show(file.square_primitive());
    file.root["nodes"][node]["name"] = "two\nlines\x1b[31m";
    EXPECT_EQ(file.load().instances.at(0).name, "two lines [31m");
}

}  // namespace
}  // namespace midway::test
