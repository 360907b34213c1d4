// The numbers of the pixels, written into them where they are large enough.
#pragma once

#include "display_maths.h"

namespace midway {

// Into ImGui's background list: over the image, under the panels.
void draw_pixel_values(const App& app, const ShownImage& shown);

}  // namespace midway
