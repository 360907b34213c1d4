#include "comparison.h"

#include <fmt/format.h>

#include <cmath>

#include "strategy_view.h"

namespace midway {
namespace {

// A alone. One of another size is fitted into the place of B, so that it can be looked at.
void show_kept(const Subject& b, const KeptImage& a, ShownImage& shown) {
    const Subject& s = a.subject;
    const double zoom = std::min(double(b.width) / s.width, double(b.height) / s.height);
    const dvec2 left = 0.5 * (dvec2(b.width, b.height) - zoom * dvec2(s.width, s.height));
    const auto at = [&](int x, int y) { return left + zoom * dvec2(x, y); };
    const dvec2 lower = at(a.place.x0, a.place.y0), upper = at(a.place.x1, a.place.y1);
    shown.image = a.image;
    shown.scale = zoom == 1 ? 1 : 0;
    shown.placement = {lower.x, lower.y, upper.x, upper.y};
    shown.crop = {int(std::floor(lower.x)), int(std::floor(lower.y)), int(std::ceil(upper.x)),
                  int(std::ceil(upper.y))};
}

PixelRect united(const PixelRect& a, const PixelRect& b) {
    return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

// Null beyond the image.
const vec3* texel(const Image& image, const dvec2& origin, double scale, const ivec2& pixel) {
    const ivec2 t = ivec2(glm::floor((dvec2(pixel) + 0.5 - origin) / scale));
    const bool inside = t.x >= 0 && t.y >= 0 && t.x < image.width && t.y < image.height;
    return inside ? &image.at(t.x, t.y) : nullptr;
}

}  // namespace

const KeptImage* image_a(const App& app) {
    const CompareState& c = app.compare;
    if (!c.chosen) return nullptr;
    if (*c.chosen == reference_id)
        return c.reference && c.reference->shown ? &*c.reference->shown : nullptr;
    for (const KeptImage& k : c.kept)
        if (k.id == *c.chosen) return &k;
    return nullptr;
}

std::string view_refusal(const App& app) {
    const KeptImage* a = image_a(app);
    return a && app.compare.live ? other_view(a->subject, *app.compare.live) : "";
}

std::string a_remark(const App& app) {
    const KeptImage* a = image_a(app);
    if (!a || !app.compare.live || !other_view(a->subject, *app.compare.live).empty()) return {};
    return other_image(a->subject, *app.compare.live);
}

CompareView view_in_use(const App& app) {
    const CompareView wanted = app.compare.view;
    if (wanted == CompareView::live || app.display.channel != Channel::image ||
        shows_strategies(app) || !image_a(app) || !app.compare.live || !app.snapshot ||
        app.snapshot->images.empty())
        return CompareView::live;
    if (wanted == CompareView::kept) return wanted;
    return view_refusal(app).empty() ? wanted : CompareView::live;
}

std::string caption_a(const App& app) {
    const KeptImage* a = image_a(app);
    return a ? "A: " + a->caption : "";
}

std::string caption_b(const App& app) {
    if (!app.snapshot || app.snapshot->exponents.empty()) return "B";
    CurveMaker maker = app.compare.maker;
    maker.exponent = app.snapshot->exponents[shown_exponent(app)];
    const Snapshot& s = *app.snapshot;
    if (s.scale > 1) return fmt::format("B: {}, first look", curve_label(maker));
    return fmt::format("B: {}, {} sample{}", curve_label(maker), s.passes,
                       s.passes == 1 ? "" : "s");
}

size_t kept_bytes(const CompareState& c) {
    size_t bytes = 0;
    for (const KeptImage& k : c.kept) bytes += k.image->pixels.size() * sizeof(vec3);
    return bytes;
}

CompareLook compare_look(const App& app) {
    const CompareView view = view_in_use(app);
    if (view == CompareView::live) return {};
    const CompareState& c = app.compare;
    CompareLook look{view, image_a(app)->image.get()};
    if (view == CompareView::wipe) look.wipe = c.wipe;
    if (view == CompareView::difference) {
        look.relative = c.relative;
        look.range = c.relative ? c.relative_range : c.range;
    }
    return look;
}

void show_comparison(const App& app, ShownImage& shown) {
    const CompareView view = view_in_use(app);
    if (view == CompareView::live) return;
    const CompareState& c = app.compare;
    const KeptImage& a = *image_a(app);
    if (view == CompareView::kept) return show_kept(*c.live, a, shown);
    shown.other = a.image;
    shown.other_place = a.place;
    if (view == CompareView::wipe) {
        shown.wipe = std::round(c.wipe * static_cast<float>(c.live->width));
        return;
    }
    // As in relMSE (image/metrics.h): a tenth of the mean keeps black from being divided by.
    DisplayMaths& m = shown.maths;
    m.mode = c.relative ? DisplayMode::relative : DisplayMode::difference;
    const float range = c.relative ? c.relative_range : c.range;
    m.range = {-range, range};
    if (c.relative) m.scale = 1;
    m.floor = std::max(0.01f * sqr(a.mean), 1e-30f);
}

float shown_difference(const DisplayMaths& m, const vec3& b, const vec3& a) {
    const float light = luminance(a), difference = luminance(b) - light;
    if (m.mode == DisplayMode::difference) return difference;
    return difference / std::sqrt(sqr(light) + m.floor);
}

std::optional<SeenPixel> seen_pixel(const ShownImage& shown, const ivec2& p) {
    const ImagePlacement& place = shown.placement;
    const vec3* b = shown.crop.contains(p.x, p.y)
                        ? texel(*shown.image, {place.x0, place.y0}, shown.scale, p)
                        : nullptr;
    const vec3* a = nullptr;
    if (shown.other) a = texel(*shown.other, {shown.other_place.x0, shown.other_place.y0}, 1, p);
    if (shown.differs()) {
        if (!a || !b) return {};
        const float d = shown_difference(shown.maths, *b, *a);
        return SeenPixel{vec3(d), difference_colour(shown.maths, d)};
    }
    const bool left = shown.other && static_cast<float>(p.x) + 0.5f < shown.wipe;
    const vec3* seen = left ? a : b;
    if (!seen) return {};
    return SeenPixel{*seen, shown_colour(shown.maths, *seen)};
}

Image compared_colours(const ShownImage& shown) {
    const PixelRect all = united(shown.crop, shown.other_place);
    Image encoded(all.width(), all.height());
    for (int y = 0; y < encoded.height; ++y)
        for (int x = 0; x < encoded.width; ++x)
            if (const auto seen = seen_pixel(shown, {all.x0 + x, all.y0 + y}))
                encoded.at(x, y) = seen->colour;
    return encoded;
}

}  // namespace midway
