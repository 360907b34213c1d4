// Directional albedo of the single-scattering GGX reflection lobe under Schlick's Fresnel term,
// which is linear in f0 and f90: E(mu) = f0 * a(mu) + f90 * b(mu). The diffuse layer below a
// specular coat gets what the coat leaves over, 1 - E, in both directions (after Kelemen &
// Szirmay-Kalos 2001).
#pragma once

namespace midway {

struct SchlickAlbedo {
    float a = 0, b = 0;
};

// Directional albedo for mu = |cos| in [0, 1]; alpha below smooth_alpha means a perfect mirror.
SchlickAlbedo directional_albedo(float mu, float alpha);

// Cosine-weighted mean over the hemisphere, of exactly the interpolant above.
SchlickAlbedo average_albedo(float alpha);

}  // namespace midway
