// Materials, textures and their extensions in glTF files.
#include <gtest/gtest.h>

#include "unit/gltf_test_files.h"

namespace midway::test {
namespace {

// A square whose material is `material`.
SceneDescription load_material(GltfFile& file, const Json& material) {
    Json primitive = file.square_primitive();
    primitive["material"] = file.add("materials", material);
    file.show(primitive);
    return file.load();
}

int add_texture(GltfFile& file, const Json& image) {
    const int source = file.add("images", image);
    return file.add("textures", {{"source", source}});
}

Json png_uri() { return {{"uri", "data:image/png;base64," + tiny_png}}; }

TEST(GltfMaterial, AbsentMaterialIsTheDefaultOfGltf) {
    GltfFile file;
    file.show(file.square_primitive());
    const SceneDescription scene = file.load();
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.instances.at(0).material, 0);
    EXPECT_EQ(scene.materials[0].base_color, vec3(1));
    EXPECT_EQ(scene.materials[0].metallic, 1);
    EXPECT_EQ(scene.materials[0].roughness, 1);
    EXPECT_FALSE(scene.materials[0].double_sided);
}

TEST(GltfMaterial, CoreFactors) {
    GltfFile file;
    const SceneDescription scene =
        load_material(file, {{"name", "paint"},
                             {"pbrMetallicRoughness",
                              {{"baseColorFactor", {0.25, 0.5, 0.75, 0.5}},
                               {"metallicFactor", 0.125},
                               {"roughnessFactor", 0.375}}},
                             {"emissiveFactor", {1, 0.5, 0}},
                             {"alphaMode", "MASK"},
                             {"alphaCutoff", 0.25},
                             {"doubleSided", true}});
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.name, "paint");
    EXPECT_EQ(m.base_color, vec3(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(m.alpha, 0.5f);
    EXPECT_EQ(m.metallic, 0.125f);
    EXPECT_EQ(m.roughness, 0.375f);
    EXPECT_EQ(m.emission, vec3(1, 0.5f, 0));
    EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(m.alpha_cutoff, 0.25f);
    EXPECT_TRUE(m.double_sided);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfMaterial, FactorsOutOfRangeAreClampedWithAWarning) {
    GltfFile file;
    const SceneDescription scene =
        load_material(file, {{"pbrMetallicRoughness", {{"metallicFactor", 7}}}});
    EXPECT_EQ(scene.materials.at(0).metallic, 1);
    EXPECT_TRUE(mentions(scene.warnings, "metallicFactor"));
}

TEST(GltfMaterial, Extensions) {
    GltfFile file;
    const SceneDescription scene = load_material(
        file,
        {{"emissiveFactor", {1, 1, 0}},
         {"extensions",
          {{"KHR_materials_emissive_strength", {{"emissiveStrength", 12}}},
           {"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
           {"KHR_materials_ior", {{"ior", 1.25}}},
           {"KHR_materials_specular",
            {{"specularFactor", 0.5}, {"specularColorFactor", {1, 0.5, 0.25}}}},
           {"KHR_materials_volume",
            {{"thicknessFactor", 1}, {"attenuationDistance", 2}, {"attenuationColor", {1, 0, 0}}}},
           {"KHR_materials_unlit", Json::object()}}}});
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.emission, vec3(12, 12, 0));
    EXPECT_EQ(m.transmission, 0.5f);
    EXPECT_EQ(m.ior, 1.25f);
    EXPECT_EQ(m.specular, 0.5f);
    EXPECT_EQ(m.specular_color, vec3(1, 0.5f, 0.25f));
    EXPECT_TRUE(m.has_thickness);
    EXPECT_TRUE(mentions(scene.warnings, "absorption"));
    EXPECT_TRUE(mentions(scene.warnings, "unlit"));
}

TEST(GltfMaterial, StrengthBeyond32BitsIsKept) {
    GltfFile file;
    const SceneDescription scene = load_material(
        file, {{"emissiveFactor", {1, 1, 1}},
               {"extensions",
                {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10000000000ll}}}}}});
    EXPECT_FLOAT_EQ(scene.materials.at(0).emission.x, 1e10f);
}

TEST(GltfMaterial, ThinTransmissionHasNoThickness) {
    GltfFile file;
    const SceneDescription scene =
        load_material(file, {{"extensions", {{"KHR_materials_volume", {{"thicknessFactor", 0}}}}}});
    EXPECT_FALSE(scene.materials.at(0).has_thickness);
}

TEST(GltfMaterial, TextureWithSamplerAndTransform) {
    GltfFile file;
    const int texture = add_texture(file, png_uri());
    file.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    file.root["textures"][texture]["sampler"] = 0;
    const SceneDescription scene = load_material(
        file, {{"pbrMetallicRoughness",
                {{"baseColorTexture",
                  {{"index", texture},
                   {"texCoord", 0},
                   {"extensions",
                    {{"KHR_texture_transform",
                      {{"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"texCoord", 1}}}}}}}}}});
    const TextureRef& t = scene.materials.at(0).base_color_texture;
    ASSERT_TRUE(t.used());
    EXPECT_EQ(t.texcoord, 1);
    EXPECT_EQ(t.wrap_u, Wrap::clamp);
    EXPECT_EQ(t.wrap_v, Wrap::mirror);
    EXPECT_TRUE(t.nearest);
    EXPECT_EQ(t.rows[0], vec3(2, 0, 0.5f));
    EXPECT_EQ(t.rows[1], vec3(0, 3, 0.25f));
    const TextureImage& image = *scene.images.at(static_cast<std::size_t>(t.image));
    EXPECT_EQ(image.width, 2);
    EXPECT_EQ(image.height, 1);
    EXPECT_EQ(image.rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 128, 255, 255}));
}

// The extension's example: rotation is counter-clockwise for v pointing down, as its matrix says.
TEST(GltfMaterial, TextureRotation) {
    GltfFile file;
    const int texture = add_texture(file, png_uri());
    const SceneDescription scene = load_material(
        file,
        {{"emissiveTexture",
          {{"index", texture}, {"extensions", {{"KHR_texture_transform", {{"rotation", 0.5}}}}}}}});
    const TextureRef& t = scene.materials.at(0).emission_texture;
    EXPECT_FLOAT_EQ(t.rows[0].y, std::sin(0.5f));
    EXPECT_FLOAT_EQ(t.rows[1].x, -std::sin(0.5f));
}

TEST(GltfMaterial, ImageIsDecodedOnceHoweverOftenItIsUsed) {
    GltfFile file;
    const int texture = add_texture(file, png_uri());
    const SceneDescription scene =
        load_material(file, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}},
                             {"emissiveTexture", {{"index", texture}}}});
    EXPECT_EQ(scene.images.size(), 1u);
}

TEST(GltfMaterial, TextureWithoutItsCoordinatesIsAWarning) {
    GltfFile file;
    const int texture = add_texture(file, png_uri());
    const SceneDescription scene = load_material(file, {{"emissiveTexture", {{"index", texture}}}});
    EXPECT_TRUE(mentions(scene.warnings, "lacks the texture coordinates 0"));
}

TEST(GltfMaterial, MissingImageLeavesTheTextureOut) {
    GltfFile file;
    const int texture = add_texture(file, {{"uri", "absent.png"}});
    const SceneDescription scene = load_material(
        file, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    EXPECT_FALSE(scene.materials.at(0).base_color_texture.used());
    EXPECT_TRUE(mentions(scene.warnings, "absent.png"));
}

TEST(GltfMaterial, DamagedImageLeavesTheTextureOut) {
    GltfFile file;
    std::string damaged = tiny_png;
    damaged.replace(damaged.size() - 48, 8, "AAAAAAAA");
    const int texture = add_texture(file, {{"uri", "data:image/png;base64," + damaged}});
    const SceneDescription scene = load_material(file, {{"emissiveTexture", {{"index", texture}}}});
    EXPECT_FALSE(scene.materials.at(0).emission_texture.used());
    EXPECT_TRUE(mentions(scene.warnings, "image 0"));
}

// The header alone claims 9000 x 9000 texels.
TEST(GltfMaterial, HugeImageIsRefusedBeforeItIsDecoded) {
    GltfFile file;
    const std::string png =
        "iVBORw0KGgoAAAANSUhEUgAAIygAACMoCAIAAADit+XtAAAACUlEQVR4nGMA"
        "AAABAAFe/335AAAAAElFTkSuQmCC";
    const int texture = add_texture(file, {{"uri", "data:image/png;base64," + png}});
    const SceneDescription scene = load_material(file, {{"emissiveTexture", {{"index", texture}}}});
    EXPECT_TRUE(scene.images.empty());
    EXPECT_TRUE(mentions(scene.warnings, "2^26"));
}

TEST(GltfMaterial, ImageInABufferView) {
    GltfFile file;
    const int view = file.view(tiny_png_bytes());
    const int texture = add_texture(file, {{"bufferView", view}, {"mimeType", "image/png"}});
    const SceneDescription scene = load_material(file, {{"emissiveTexture", {{"index", texture}}}});
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0]->rgba[5], 128);
}

TEST(GltfMaterial, FileNamesArePercentDecoded) {
    GltfFile file;
    const std::vector<std::uint8_t> png = tiny_png_bytes();
    write_file(file.folder / "a b.png", std::string(png.begin(), png.end()));
    const int texture = add_texture(file, {{"uri", "a%20b.png"}});
    EXPECT_EQ(load_material(file, {{"emissiveTexture", {{"index", texture}}}}).images.size(), 1u);
}

TEST(GltfMaterial, UnsupportedExtensionIsAWarningWhenOnlyUsed) {
    GltfFile file;
    file.root["extensionsUsed"] = {"KHR_materials_clearcoat"};
    EXPECT_TRUE(mentions(file.load().warnings, "KHR_materials_clearcoat"));
}

}  // namespace
}  // namespace midway::test
