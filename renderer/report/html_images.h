// The image viewer of an HTML page: images side by side with one zoom, wipe, flip, exposure, signed
// difference and relative error against the first of them.
//
// The pixels travel as half floats (times a power of two of each image) in base64, decoded and tone
// mapped by the page, so that exposure and differences are those of the linear light. They are not
// compressed: deflate took a quarter off rendered images (measured: 17 to 32 %), and asks for what
// not every browser can undo. Half floats keep 11 bits, which adds at most 2.4e-4 of a value to
// differences. Values beyond 65504 times the mean stop there.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"
#include "report/html_page.h"

namespace midway {

struct PageImage {
    std::string name, caption;
    const Image* image = nullptr;
};

// The first image is the reference; those of another size, or of none, are left out, and the page
// says so. Where all of them together have more than 8 million pixels, squares of 2x2, 3x3, ...
// pixels are averaged, and the page says so. The second image is shown on the left, number `right`
// on the right. Does nothing where the reference is empty.
void add_image_viewer(HtmlPage& page, const std::vector<PageImage>& images, size_t right);

// IEEE 754 binary16, rounded to nearest even; beyond the range the largest finite value, NaN stays.
std::uint16_t half_from_float(float value);

std::string base64(std::string_view bytes);

// A small picture of the image as a data URI (PNG), at most `width` pixels wide.
std::string thumbnail_uri(const Image& image, int width);

}  // namespace midway
