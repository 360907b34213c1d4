#include "display_values.h"

#include <imgui.h>

#include <cstdio>

#include "view.h"

namespace midway {
namespace {

constexpr float smallest_pixel = 4.2f;  // in font sizes, for three lines of numbers

// Four digits that say the most.
void print(char (&text)[16], float v) {
    const float a = std::abs(v);
    const char* format = a == 0      ? "%.0f"
                         : a < 1e-3f ? "%.0e"
                         : a < 10    ? "%.3f"
                         : a < 100   ? "%.2f"
                         : a < 1e5f  ? "%.0f"
                                     : "%.1e";
    std::snprintf(text, sizeof text, format, static_cast<double>(v));
}

bool is_scalar(Channel channel) {
    return channel == Channel::depth || channel == Channel::object || channel == Channel::error ||
           channel == Channel::samples;
}

}  // namespace

void draw_pixel_values(const App& app, const ShownImage& shown) {
    const float zoom = zoom_in_use(app), font = ImGui::GetFontSize();
    if (!app.display.pixel_values || !shown.image || shown.scale != 1 ||
        zoom < smallest_pixel * font)
        return;
    const ivec2 first(glm::floor(image_position(app, app.ui.view.lower)));
    const ivec2 end = ivec2(glm::floor(image_position(app, app.ui.view.upper))) + 1;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.PushClipRect({app.ui.view.lower.x, app.ui.view.lower.y},
                      {app.ui.view.upper.x, app.ui.view.upper.y});
    const int lines = is_scalar(app.display.channel) || shown.differs() ? 1 : 3;
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) {
            const std::optional<SeenPixel> seen = seen_pixel(shown, {x, y});
            if (!seen) continue;
            const vec3& v = seen->value;
            const bool bright = luminance(seen->colour) > 0.5f;
            const ImU32 ink = bright ? IM_COL32(0, 0, 0, 255) : IM_COL32(255, 255, 255, 230);
            const vec2 centre = screen_position(app, vec2(x, y) + 0.5f);
            for (int i = 0; i < lines; ++i) {
                char text[16];
                print(text, v[i]);
                const ImVec2 extent = ImGui::CalcTextSize(text);
                const float top = centre.y + (static_cast<float>(i) - 0.5f * lines) * font;
                list.AddText({centre.x - 0.5f * extent.x, top}, ink, text);
            }
        }
    list.PopClipRect();
}

}  // namespace midway
