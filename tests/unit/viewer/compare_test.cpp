// A against B without a window: what may be compared, how it is laid over, curves of the error and
// where a plot puts them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "viewer/comparing.h"
#include "viewer/comparison.h"
#include "viewer/plot_layout.h"

namespace midway::test {
namespace {

Subject subject(int width, int height) {
    Subject s;
    s.file = "a.glb";
    s.hash = 1;
    s.width = width;
    s.height = height;
    s.crop = {0, 0, width, height};
    return s;
}

std::shared_ptr<Image> noise(int width, int height, unsigned seed) {
    auto image = std::make_shared<Image>(width, height);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0, 1);
    for (vec3& p : image->pixels) p = vec3(value(random), value(random), value(random));
    return image;
}

// B is an image of 40 x 30 at this scale, A one of the part `place` of it.
App two_images(int scale, const PixelRect& place) {
    App app;
    auto s = std::make_shared<Snapshot>();
    s->job = 1;
    s->scale = scale;
    s->width = 40;
    s->height = 30;
    s->crop = {0, 0, 40, 30};
    const int w = (40 + scale - 1) / scale, h = (30 + scale - 1) / scale;
    const double x0 = 0.5 * (40 - w * scale), y0 = 0.5 * (30 - h * scale);
    s->placement = {x0, y0, x0 + w * scale, y0 + h * scale};
    s->exponents = {2};
    s->images = {noise(w, h, 1)};
    s->passes = 64;
    app.snapshot = s;
    app.compare.live = subject(40, 30);
    app.compare.live_job = 1;
    KeptImage a;
    a.id = 1;
    a.caption = "path, 128 samples";
    a.subject = subject(40, 30);
    a.place = place;
    a.image = noise(place.width(), place.height(), 2);
    a.mean = 0.5f;
    app.compare.kept = {a};
    app.compare.chosen = 1;
    return app;
}

// The definition: the number of the image whose pixel covers the middle of (x, y).
vec3 value_of_b(const App& app, int x, int y) {
    const Snapshot& s = *app.snapshot;
    return s.images[0]->at(int((x + 0.5 - s.placement.x0) / s.scale),
                           int((y + 0.5 - s.placement.y0) / s.scale));
}

TEST(Comparison, WipeTakesAFromTheLeftAtAnyScaleOfB) {
    for (const int scale : {1, 3, 7}) {
        App app = two_images(scale, {0, 0, 40, 30});
        app.compare.view = CompareView::wipe;
        app.compare.wipe = 0.31f;  // 12.4 pixels
        const ShownImage shown = shown_image(app);
        const Image picture = shown_colours(shown);
        ASSERT_EQ(ivec2(picture.width, picture.height), ivec2(40, 30));
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x) {
                const vec3 v = x < 12 ? app.compare.kept[0].image->at(x, y) : value_of_b(app, x, y);
                ASSERT_EQ(picture.at(x, y), tone_map(v, {0, Curve::srgb})) << x << " " << y;
            }
    }
}

TEST(Comparison, DifferenceIsOfTheSamePointsAndOnlyWhereBothAre) {
    const PixelRect place{10, 5, 30, 20};
    for (const int scale : {1, 3, 7})
        for (const bool relative : {false, true}) {
            App app = two_images(scale, place);
            app.display.exposure_ev = 1;
            app.compare.view = CompareView::difference;
            app.compare.relative = relative;
            const ShownImage shown = shown_image(app);
            for (int y = 0; y < 30; ++y)
                for (int x = 0; x < 40; ++x) {
                    const auto seen = seen_pixel(shown, {x, y});
                    ASSERT_EQ(seen.has_value(), place.contains(x, y));
                    if (!seen) continue;
                    const float a = luminance(app.compare.kept[0].image->at(x - 10, y - 5));
                    const float d = luminance(value_of_b(app, x, y)) - a;
                    const float expected = relative ? d / std::hypot(a, 0.05f) : d;
                    ASSERT_NEAR(seen->value.x, expected, 1e-5f);
                }
        }
}

TEST(Comparison, ColoursOfDifferencesAreSymmetricAndEndAtTheScale) {
    DisplayMaths m;
    m.mode = DisplayMode::difference;
    m.range = {-0.25f, 0.25f};
    m.scale = 2;
    EXPECT_EQ(difference_colour(m, 0), signed_ramp()[5]);
    EXPECT_EQ(difference_colour(m, 0.125f), signed_ramp().back());
    EXPECT_EQ(difference_colour(m, -7), signed_ramp().front());
    EXPECT_GT(difference_colour(m, 0.06f).x, difference_colour(m, 0.06f).z) << "orange: brighter";
    EXPECT_LT(difference_colour(m, -0.06f).x, difference_colour(m, -0.06f).z) << "blue: darker";
}

TEST(Comparison, AnotherViewIsOnlyLookedAt) {
    App app = two_images(1, {0, 0, 40, 30});
    Subject& a = app.compare.kept[0].subject;
    const auto used = [&](CompareView wanted) {
        app.compare.view = wanted;
        return view_in_use(app);
    };
    EXPECT_EQ(used(CompareView::wipe), CompareView::wipe);
    a.camera.to_world[3].x = 0.1;
    EXPECT_EQ(view_refusal(app), "the camera moved");
    EXPECT_EQ(used(CompareView::wipe), CompareView::live);
    EXPECT_EQ(used(CompareView::difference), CompareView::live);
    EXPECT_EQ(used(CompareView::kept), CompareView::kept);
    a = subject(80, 60);
    EXPECT_NE(view_refusal(app).find("80 x 60"), std::string::npos);
    EXPECT_EQ(used(CompareView::difference), CompareView::live);
    a = subject(40, 30);
    a.file = "b.glb";
    EXPECT_EQ(used(CompareView::wipe), CompareView::live);
    // An edit of a light leaves the view as it is, and is said.
    a = subject(40, 30);
    a.hash = 2;
    EXPECT_EQ(used(CompareView::difference), CompareView::difference);
    EXPECT_EQ(a_remark(app), "the scene was edited");
    app.display.channel = Channel::albedo;
    EXPECT_EQ(used(CompareView::wipe), CompareView::live);
    app.display.channel = Channel::image;
    forget_image(app.compare, 1);
    EXPECT_EQ(app.compare.view, CompareView::live);
    EXPECT_EQ(used(CompareView::wipe), CompareView::live);
}

TEST(Comparison, AOfAnotherSizeIsFittedIntoThePlaceOfB) {
    App app = two_images(1, {0, 0, 40, 30});
    app.compare.kept[0].subject = subject(80, 80);
    app.compare.kept[0].place = {0, 0, 80, 80};
    app.compare.kept[0].image = noise(80, 80, 3);
    app.compare.view = CompareView::kept;
    const ShownImage shown = shown_image(app);
    EXPECT_EQ(shown.image, app.compare.kept[0].image);
    EXPECT_DOUBLE_EQ(shown.placement.x0, 5);
    EXPECT_DOUBLE_EQ(shown.placement.x1, 35);
    EXPECT_DOUBLE_EQ(shown.placement.y1, 30);
    EXPECT_NE(shown.scale, 1) << "its pixels are not those of the image: no numbers in them";
}

CurvePoint point(double seconds, std::uint64_t spp, double error, bool measured = false) {
    CurvePoint p;
    p.seconds = seconds;
    p.spp = spp;
    p.estimate = error;
    if (measured) {
        p.measured = ErrorPoint{seconds, seconds, spp};
        p.measured->relmse = error;
    }
    return p;
}

TEST(ErrorCurves, PointsStandEvenlyOnALogarithmicScale) {
    std::vector<LiveCurve> curves;
    const CurveMaker maker;
    for (int n = 1; n <= 100000; ++n) add_point(curves, maker, 1, point(0.01 * n, n, 1.0 / n));
    ASSERT_EQ(curves.size(), 1u);
    const std::vector<CurvePoint>& p = curves[0].points;
    EXPECT_EQ(p.back().spp, 100000u) << "the end follows the image";
    EXPECT_LT(p.size(), 8 * 5 + 5u);
    EXPECT_GT(p.size(), 30u);
    for (size_t i = 1; i + 1 < p.size(); ++i)
        EXPECT_GE(p[i].seconds, p[i - 1].seconds * curve_spacing * 0.9999);
}

TEST(ErrorCurves, TheSameAgainOnlyGoesOn) {
    std::vector<LiveCurve> curves;
    const CurveMaker path{Technique::path, 2}, bdpt{Technique::bdpt, 1};
    for (int n = 1; n <= 64; n *= 2) add_point(curves, path, 1, point(n, n, 1.0 / n));
    add_point(curves, bdpt, 2, point(1, 2, 0.1));
    const auto before = curves[0].points.size();
    for (int n = 1; n <= 64; n *= 2) add_point(curves, path, 3, point(1.5 * n, n, 1.0 / n));
    EXPECT_EQ(curves[0].points.size(), before);
    add_point(curves, path, 3, point(200, 128, 1.0 / 128));
    EXPECT_EQ(curves[0].points.size(), before + 1);
    EXPECT_EQ(curves[0].points.back().spp, 128u);
    // Points without the reference's numbers make room for ones that have them.
    add_point(curves, path, 4, point(1, 2, 0.5, true));
    EXPECT_EQ(curves[0].points.size(), 1u);
    // A reference that comes while an image stands: the same point, now measured.
    add_point(curves, bdpt, 2, point(1, 2, 0.1, true));
    EXPECT_EQ(curves[1].points.size(), 1u);
    EXPECT_TRUE(curves[1].points[0].measured);
}

TEST(ErrorCurves, AreNamedByWhatIsNotAsUsual) {
    EXPECT_EQ(curve_label({Technique::bdpt, 2}), "bdpt:2");
    EXPECT_EQ(curve_label({Technique::bdpt, 0.5}), "bdpt:0.5");
    EXPECT_EQ(curve_label({Technique::path, 2}), "path");
    EXPECT_EQ(curve_label({Technique::path, 0}), "path:0");
    EXPECT_EQ(curve_label({Technique::light, 1}), "light");
    EXPECT_EQ(curve_label({Technique::bdpt, 2, SamplerKind::independent, 7}),
              "bdpt:2, independent, seed 7");
}

TEST(ErrorCurves, AreFewHoweverTheSliderMoves) {
    std::vector<LiveCurve> curves;
    // Every fifth value is stayed at for a while.
    for (unsigned job = 1; job <= 160; ++job) {
        const CurveMaker maker{Technique::bdpt, 0.05 * job};
        for (int n = 2; n < (job % 5 ? 3 : 6); ++n)
            add_point(curves, maker, job, point(0.2 * n, n, 1));
        EXPECT_LE(curves.size(), most_curves);
    }
    EXPECT_EQ(curves.size(), most_curves);
    for (const LiveCurve& c : curves) EXPECT_EQ(c.job % 5, 0u) << c.label;
}

TEST(ErrorCurves, CsvHasTheColumnsOfTheBatchAndTheEstimate) {
    std::vector<LiveCurve> curves;
    add_point(curves, {Technique::path, 2, SamplerKind::sobol, 5}, 1, point(0.5, 4, 0.25));
    add_point(curves, {Technique::bdpt, 1}, 2, point(0.5, 4, 0.125, true));
    EXPECT_EQ(curves_csv(curves),
              "technique,exponent,seed,seconds,cpu_seconds,spp,mse,rmse,relmse,relmse_trimmed,"
              "smape,bias,bias_z,relmse_estimated\n"
              "path,2,5,0.5,0,4,,,,,,,,0.25\n"
              "bdpt,1,0,0.5,0.5,4,0,0,0.125,0,0,0,0,0.125\n");
}

Plot line_plot(std::vector<dvec2> values) {
    Plot plot;
    PlotSeries s;
    s.label = "path";
    s.current = true;
    s.of.resize(values.size());
    s.values = std::move(values);
    plot.series.push_back(std::move(s));
    return plot;
}

constexpr Rect frame{{100, 50}, {700, 400}};

TEST(PlotLayout, PutsEveryPointInsideAndDecadesAtTheirPlaces) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> decades(-6, 4);
    for (int round = 0; round < 200; ++round) {
        std::vector<dvec2> values(1 + round % 7);
        for (dvec2& v : values) v = {std::pow(10, decades(random)), std::pow(10, decades(random))};
        const Plot plot = line_plot(values);
        const PlotLayout l = lay_out(plot, frame, 15);
        for (const dvec2& v : values) {
            const vec2 p = plot_position(l, v);
            EXPECT_TRUE(p.x >= l.area.lower.x && p.x <= l.area.upper.x) << p.x;
            EXPECT_TRUE(p.y >= l.area.lower.y && p.y <= l.area.upper.y) << p.y;
            const auto hit = plot_hit(plot, l, p, 1);
            ASSERT_TRUE(hit);
        }
        for (const auto* ticks : {&l.x, &l.y}) {
            int labels = 0;
            for (const PlotTick& t : *ticks) {
                if (t.label.empty()) continue;
                ++labels;
                const double v = std::stod(t.label);
                const vec2 at = plot_position(l, {v, v});
                EXPECT_NEAR(ticks == &l.x ? at.x : at.y, t.at, 0.01f) << t.label;
            }
            EXPECT_GE(labels, 2);
            EXPECT_LE(labels, 30);
        }
    }
}

TEST(PlotLayout, UnknownValuesPartTheLine) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Plot plot = line_plot({{1, 1}, {2, 0.5}, {3, nan}, {4, -0.1}, {5, 0.2}, {6, 0.1}});
    const PlotLayout l = lay_out(plot, frame, 15);
    ASSERT_EQ(l.lines.size(), 2u);
    EXPECT_EQ(l.lines[0].points.size(), 2u);
    EXPECT_EQ(l.lines[1].points.size(), 2u);
}

TEST(PlotLayout, GuideFallsByADecadeInADecade) {
    const PlotLayout l = lay_out(line_plot({{0.1, 1}, {1, 0.3}, {10, 0.01}}), frame, 15);
    ASSERT_TRUE(l.guide);
    const vec2 way = l.guide->second - l.guide->first;
    const dvec2 per_point = (l.high - l.low) / dvec2(l.area.size());
    EXPECT_NEAR(way.x * per_point.x, way.y * per_point.y, 1e-4);
    EXPECT_GT(way.x, 0);
    for (const vec2& p : {l.guide->first, l.guide->second})
        EXPECT_TRUE(p.y >= l.area.lower.y - 0.1f && p.y <= l.area.upper.y + 0.1f);
}

TEST(PlotLayout, OfNothingHasItsTicksAndNoLine) {
    const PlotLayout l = lay_out({}, frame, 15);
    EXPECT_TRUE(l.lines.empty());
    EXPECT_FALSE(l.guide);
    EXPECT_GE(l.x.size(), 2u);
    EXPECT_FALSE(plot_hit({}, l, {300, 200}, 1e9f));
}

TEST(PlotLayout, TechniquesKeepTheirColours) {
    CompareState c;
    for (int order = 0; order < 2; ++order) {
        c.curves.clear();
        std::vector<CurveMaker> makers = {{Technique::path, 2},
                                          {Technique::light, 2},
                                          {Technique::bdpt, 2},
                                          {Technique::bdpt, 3},
                                          {Technique::bdpt, 2, SamplerKind::independent}};
        if (order == 1) std::swap(makers[0], makers[2]);
        for (const CurveMaker& m : makers) add_point(c.curves, m, 1, point(1, 2, 1));
        const Plot plot = make_plot(c, ErrorMetric::relmse);
        std::vector<size_t> colours;
        for (const PlotSeries& s : plot.series) {
            if (s.label == "path") {
                EXPECT_EQ(s.color, 0u);
            }
            if (s.label == "bdpt:2") {
                EXPECT_EQ(s.color, 2u);
            }
            colours.push_back(s.color);
        }
        std::sort(colours.begin(), colours.end());
        EXPECT_EQ(std::unique(colours.begin(), colours.end()), colours.end());
    }
}

}  // namespace
}  // namespace midway::test
