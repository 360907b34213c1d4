// Colours, spacing and fonts of the window. One language everywhere: what belongs to the camera
// side of a path is teal, what belongs to the light side is amber. All else is neutral grey, so
// that nothing beside the image shifts how its colours look. Fonts come from the system (Inter,
// DejaVu Sans, Noto Sans, in this order), else ImGui's own serves. Sizes in panels are multiples of
// the font's size, which follows the monitor's scale.
#pragma once

#include <imgui.h>

namespace midway::theme {

// ImVec4, but a literal type.
struct Color {
    float x = 0, y = 0, z = 0, w = 1;
    operator ImVec4() const { return {x, y, z, w}; }
};

constexpr Color rgb(int hex, float alpha = 1) {
    return {static_cast<float>((hex >> 16) & 255) / 255, static_cast<float>((hex >> 8) & 255) / 255,
            static_cast<float>(hex & 255) / 255, alpha};
}

inline constexpr Color camera = rgb(0x34b8a6);  // teal
inline constexpr Color light = rgb(0xe3a236);   // amber
inline constexpr Color error = rgb(0xe5736b);
inline constexpr Color text = rgb(0xdadada);
inline constexpr Color text_dim = rgb(0x9a9a9a);
inline constexpr Color panel = rgb(0x232323);
inline constexpr Color frame = rgb(0x343434);
inline constexpr Color line = rgb(0x3c3c3c);
inline constexpr Color surround = rgb(0x303030);  // around the image

inline constexpr float font_points = 15;  // at scale 1

inline ImU32 color(const Color& c, float alpha = 1) {
    return ImGui::GetColorU32(ImVec4(c.x, c.y, c.z, c.w * alpha));
}

// The font of headings; the ordinary one where there is no other.
ImFont* heading_font();

}  // namespace midway::theme
