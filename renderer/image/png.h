// Eight-bit RGB PNG for people to look at; measurements belong in EXR. Dithered, so that slow
// gradients show no bands: noise of one step width, uniform, which gives each grey its mean exactly
// and is off by less than one step; the same for red, green and blue, so that greys stay grey. The
// noise is a function of the pixel's position alone, with little low-frequency power (J. Jimenez,
// "Next generation post processing in Call of Duty: Advanced Warfare", 2014). Pure black and white
// stay pure. Throws std::runtime_error with one line "WHAT (WHERE); REMEDY".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/tonemap.h"

namespace midway {

// The bytes of the file.
std::string encode_png(const Image& linear, const ToneMap& tone);

// All appear whole or not at all.
void write_png(const std::string& path, const Image& linear, const ToneMap& tone);
// Of values that are encoded already, in [0, 1].
void write_encoded_png(const std::string& path, const Image& encoded);
// Bytes as they are, three a pixel, rows from the top.
void write_png_bytes(const std::string& path, int width, int height,
                     const std::vector<std::uint8_t>& rgb);

}  // namespace midway
