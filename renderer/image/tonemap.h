// From scene-referred linear light to what a display is sent. Exposure in EV (stops): light is
// multiplied by 2^EV, then a curve maps it to [0, 1], then the transfer function encodes it.
#pragma once

#include "image/image.h"

namespace midway {

enum class Curve {
    srgb,    // no curve: clipped at one
    filmic,  // soft shoulder, K. Narkowicz, "ACES filmic tone mapping curve" (2015)
    agx,     // like AgX, T. Sobotka (2022): bright colours go to white without a change of hue
};

struct ToneMap {
    float exposure_ev = 0;
    Curve curve = Curve::srgb;
};

// The sRGB transfer function of IEC 61966-2-1 (1999) on [0, 1]. What lies outside is clipped; a NaN
// becomes 0.
float srgb_from_linear(float linear);

// The AgX-like curve, encoded: chromaticities move a fifth of the way to white, then each channel's
// stops, from 10 below middle grey to 6.5 above, pass a sigmoid of slope 2 (AgX's range, inset and
// slope). Middle grey, 0.18, stays where sRGB has it. The same as in shaders/display.frag.
vec3 agx(const vec3& exposed);

// Encoded sRGB in [0, 1].
vec3 tone_map(const vec3& linear, const ToneMap& tone);

// The exposure that takes the log-average luminance to 0.18. Black, an almost black background
// (4096 times darker than the brightest 1 %) and fireflies have no say. 0 where nothing shines.
float auto_exposure(const Image& image);

}  // namespace midway
