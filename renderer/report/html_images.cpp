#include "report/html_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "image/png.h"
#include "image/tonemap.h"
#include "report/html_web.h"
#include "report/reference.h"

namespace midway {
namespace {

constexpr size_t max_page_pixels = size_t{8} << 20;

// Mean of squares of n x n pixels; those at the right and lower edge may be cut.
Image averaged(const Image& image, int n) {
    Image small((image.width + n - 1) / n, (image.height + n - 1) / n);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            const int right = std::min((x + 1) * n, image.width);
            const int low = std::min((y + 1) * n, image.height);
            glm::dvec3 sum(0);
            for (int v = y * n; v < low; ++v)
                for (int u = x * n; u < right; ++u) sum += glm::dvec3(image.at(u, v));
            small.at(x, y) = vec3(sum / double((right - x * n) * (low - y * n)));
        }
    return small;
}

// The power of two that takes the mean of the finite values to about one; 0 where there is none.
int scale_exponent(const Image& image) {
    double sum = 0;
    for (const vec3& p : image.pixels)
        for (int c = 0; c < 3; ++c)
            if (std::isfinite(p[c])) sum += std::abs(double(p[c]));
    const double mean = sum / (3.0 * double(image.pixels.size()));
    return mean > 0 && std::isfinite(mean) ? std::ilogb(mean) : 0;
}

std::string half_floats(const Image& image, int exponent) {
    std::string bytes;
    bytes.reserve(image.pixels.size() * 6);
    for (const vec3& p : image.pixels)
        for (int c = 0; c < 3; ++c) {
            const std::uint16_t half = half_from_float(std::ldexp(p[c], -exponent));
            bytes += static_cast<char>(half & 255);
            bytes += static_cast<char>(half >> 8);
        }
    return bytes;
}

// A difference of luminance that few pixels exceed: the full colour of the difference to begin
// with, as a power of two.
double usual_difference(const std::vector<PageImage>& images) {
    const Image& reference = *images[0].image;
    std::vector<float> differences;
    for (size_t i = 1; i < images.size(); ++i)
        for (size_t p = 0; p < reference.pixels.size(); ++p) {
            const float d = luminance(images[i].image->pixels[p]) - luminance(reference.pixels[p]);
            if (std::isfinite(d)) differences.push_back(std::abs(d));
        }
    if (differences.empty()) return 0;
    const auto place = differences.begin() + std::ptrdiff_t(differences.size() * 97 / 100);
    std::nth_element(differences.begin(), place, differences.end());
    return *place > 0 ? std::round(std::log2(double(*place)) * 4) / 4 : 0;
}

}  // namespace

std::uint16_t half_from_float(float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, 4);
    const auto sign = static_cast<std::uint16_t>(bits >> 16 & 0x8000);
    if (std::isnan(value)) return sign | 0x7e00;
    const double size = std::min(std::abs(double(value)), 65504.0);
    // Steps of 2^-24 below 2^-14, of 2^-10 of the binade above.
    const int exponent = std::max(size > 0 ? std::ilogb(size) : -14, -14);
    const double steps = std::nearbyint(std::ldexp(size, 10 - exponent));
    // A fraction that rounds up to the next binade carries into the exponent by itself; the
    // largest value was cut before.
    const auto whole = static_cast<std::uint32_t>(steps) + (std::uint32_t(exponent + 14) << 10);
    return static_cast<std::uint16_t>(sign | std::min(whole, 0x7bffu));
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k)
            word =
                word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k)
            text += i + k < bytes.size() + 1 ? digits[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string thumbnail_uri(const Image& image, int width) {
    if (image.pixels.empty()) return {};
    const Image small = averaged(image, std::max(1, (image.width + width - 1) / width));
    return "data:image/png;base64," + base64(encode_png(small, {auto_exposure(small)}));
}

void add_image_viewer(HtmlPage& page, const std::vector<PageImage>& images, size_t right) {
    if (images.empty() || !images[0].image || images[0].image->pixels.empty()) return;
    std::vector<PageImage> shown;
    std::string note;
    size_t shown_right = 0;
    for (const PageImage& i : images) {
        const bool fits = i.image && i.image->width == images[0].image->width &&
                          i.image->height == images[0].image->height;
        if (fits && &i == &images[std::min(right, images.size() - 1)]) shown_right = shown.size();
        if (fits)
            shown.push_back(i);
        else
            note += i.name + " has no image of the reference's size. ";
    }
    int n = 1;
    const size_t pixels = images[0].image->pixels.size() * shown.size();
    while (pixels > max_page_pixels * n * n) ++n;
    if (n > 1)
        note += fmt::format("To keep this page small, squares of {0}x{0} pixels are averaged. ", n);

    std::vector<Image> small;
    small.reserve(shown.size());
    for (PageImage& i : shown) {
        if (n == 1) break;
        small.push_back(averaged(*i.image, n));
        i.image = &small.back();
    }
    const Image& reference = *shown[0].image;
    nlohmann::json list = nlohmann::json::array();
    std::string data;
    for (size_t i = 0; i < shown.size(); ++i) {
        const int exponent = scale_exponent(*shown[i].image);
        const std::string id = fmt::format("image-{}", i);
        list.push_back({{"id", id},
                        {"name", shown[i].name},
                        {"caption", shown[i].caption},
                        {"scale", exponent}});
        data += "<script type=\"application/octet-stream\" id=\"" + id + "\">" +
                base64(half_floats(*shown[i].image, exponent)) + "</script>\n";
    }
    const nlohmann::json spec = {{"width", reference.width},
                                 {"height", reference.height},
                                 {"exposure", std::round(auto_exposure(reference) * 4) / 4},
                                 {"mean", mean_luminance(reference)},
                                 {"range", usual_difference(shown)},
                                 {"note", note},
                                 {"right", shown_right},
                                 {"images", list}};
    page.add_style(web::images_css);
    page.add_html(web::images_html);
    page.add_html(data);
    page.add_json("images", spec.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    page.add_script(web::images_js);
    page.add_script(web::viewer_js);
}

}  // namespace midway
