// A clear afternoon over the sea, made of three gradients: sky by height, glow around the sun, sea
// by depth below the horizon. Equirectangular: the middle column looks along -z, to the right of it
// +x.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "scenes.h"
#include "terrace_sun.h"

namespace midway::assets {
namespace {

constexpr int width = 512, height = 256;

dvec3 sky_radiance(const dvec3& d) {
    const dvec3 zenith(0.10, 0.23, 0.52), horizon(0.62, 0.74, 0.86), sea(0.035, 0.10, 0.15);
    const double cos_sun = std::clamp(glm::dot(d, to_terrace_sun()), -1.0, 1.0);
    const double angle = std::acos(cos_sun) * 180 / pi;
    const dvec3 glow =
        dvec3(1.0, 0.86, 0.62) * (1.6 * std::exp(-angle / 6) + 0.35 * std::exp(-angle / 28));
    if (d.y >= 0) return glm::mix(horizon, zenith, 1 - std::pow(1 - d.y, 3.0)) + glow;
    const double depth = 1 - std::exp(d.y * 14);
    return glm::mix(horizon * 0.75, sea, depth) + glow * 0.12;
}

std::array<std::uint8_t, 4> rgbe(const dvec3& color) {
    const double largest = std::max({color.x, color.y, color.z});
    int exponent = 0;
    const double scale = std::frexp(largest, &exponent) * 256 / largest;
    std::array<std::uint8_t, 4> bytes{};
    for (int c = 0; c < 3; ++c) bytes[c] = std::uint8_t(std::min(color[c] * scale, 255.0));
    bytes[3] = std::uint8_t(exponent + 128);
    return bytes;
}

// Run-length code of one channel of a row: counts above 128 repeat one byte, others precede bytes.
void append_channel(std::string& file, const std::array<std::uint8_t, width>& row) {
    const auto run_at = [&](int x) {
        int length = 1;
        while (x + length < width && length < 127 && row[x + length] == row[x]) ++length;
        return length;
    };
    for (int x = 0; x < width;) {
        const int run = run_at(x);
        if (run >= 4) {
            file += char(128 + run);
            file += char(row[x]);
            x += run;
            continue;
        }
        int end = x;
        while (end < width && end - x < 128 && run_at(end) < 4) ++end;
        file += char(end - x);
        for (; x < end; ++x) file += char(row[x]);
    }
}

}  // namespace

std::string terrace_sky() {
    std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) +
                       " +X " + std::to_string(width) + "\n";
    for (int y = 0; y < height; ++y) {
        std::array<std::array<std::uint8_t, width>, 4> channels;
        for (int x = 0; x < width; ++x) {
            const double theta = pi * (y + 0.5) / height;
            const double phi = 2 * pi * ((x + 0.5) / width - 0.5);
            const dvec3 direction(std::sin(theta) * std::sin(phi), std::cos(theta),
                                  -std::sin(theta) * std::cos(phi));
            const auto bytes = rgbe(sky_radiance(direction));
            for (int c = 0; c < 4; ++c) channels[c][x] = bytes[c];
        }
        file += {char(2), char(2), char(width >> 8), char(width & 255)};
        for (const auto& channel : channels) append_channel(file, channel);
    }
    return file;
}

}  // namespace midway::assets
