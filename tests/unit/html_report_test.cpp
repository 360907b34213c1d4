// The pages of renderer/report/html_*: that they say what was measured, that no text from a file
// gets out of its place, that nothing is loaded from outside, and that they work in a browser.
#include "report/html_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "report/html_images.h"
#include "support/made_comparison.h"
#include "support/temp_dir.h"

namespace midway {
namespace {

using test::TempDir;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string hostile =
    "</script><img src=x onerror=\"stolen=1\"><script>stolen=1</script>' \" & {{body}} "
    "\xe2\x80\xa8";

std::string read(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

size_t count(const std::string& text, const std::string& part) {
    size_t n = 0;
    for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
    return n;
}

// A page is too long to print where it fails.
::testing::AssertionResult holds(const std::string& page, const std::string& part) {
    if (page.find(part) != page.npos) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "the page does not hold: " << part;
}

std::string report_of(const Comparison& c) {
    const TempDir folder;
    write_report(c, folder.path().string());
    return read(folder / "report.html");
}

// A comparison whose every text is hostile.
Comparison hostile_comparison() {
    Comparison c = test::made_comparison("cornell");
    for (std::string* text : {&c.name, &c.scene, &c.command, &c.formula, &c.method, &c.machine.cpu,
                              &c.machine.version, &c.machine.instruction_set, &c.machine.compiler,
                              &c.reference.source, &c.reference.technique, &c.reference.why})
        *text = hostile;
    c.settings = {{hostile, hostile}};
    c.left_out = c.warnings = {hostile};
    for (TechniqueResult& t : c.techniques) {
        t.label += hostile;
        t.name = t.bias.text = hostile;
        t.not_covered = t.left_out = {hostile};
    }
    return c;
}

TEST(HtmlPage, EscapesWhateverAFileSays) {
    const std::string plain = report_of(test::made_comparison("cornell"));
    const std::string page = report_of(hostile_comparison());
    EXPECT_EQ(count(page, "<script"), count(plain, "<script"));
    EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
    EXPECT_EQ(count(page, "<img"), count(plain, "<img"));
    EXPECT_EQ(count(page, "<body>"), 1u);
    EXPECT_TRUE(holds(page, "&lt;/script&gt;&lt;img src=x onerror=&quot;stolen=1&quot;&gt;"));
    EXPECT_FALSE(holds(page, "onerror=\""));
}

TEST(HtmlPage, LoadsNothingFromOutside) {
    const TempDir folder;
    write_report(test::made_comparison("cornell"), folder.path().string());
    write_suite_index(test::made_suite(), folder.path().string());
    for (const char* name : {"report.html", "index.html"}) {
        SCOPED_TRACE(name);
        const std::string page = read(folder / name);
        EXPECT_TRUE(holds(page, "default-src 'none'"));
        EXPECT_FALSE(holds(page, "@import"));
        const size_t style = page.find("<style"), end = page.find("</style>");
        EXPECT_FALSE(holds(page.substr(style, end - style), "url("));
        // Attributes lead to places in the page, to data in it, or to files beside it.
        const std::regex outside(R"((src|href|action|srcset|data)\s*=\s*["']?\s*(\w+:)?//)");
        EXPECT_FALSE(std::regex_search(page.substr(0, page.find("Chart.js v")), outside));
        EXPECT_EQ(count(page, "<link"), 0u);
        EXPECT_EQ(count(page, "<script src"), 0u);
    }
}

TEST(HtmlPage, KeepsTheLicenceOfWhatItEmbeds) {
    const std::string page = report_of(test::made_comparison("cornell"));
    EXPECT_TRUE(holds(page, "Chart.js Contributors"));
    EXPECT_TRUE(holds(page, "Permission is hereby granted, free of charge"));
}

TEST(HtmlPage, LinksLeadToFilesBelowIt) {
    const auto link_of = [](const std::string& file) {
        HtmlPage page("t", "v");
        HtmlCell cell("name");
        cell.link = file;
        page.add_table({"", {"a"}, {{cell}}});
        const std::string html = page.finish(), main = html.substr(html.find("<main>"));
        const size_t at = main.find("<a href=\"");
        return at < main.find("</main>") ? main.substr(at + 9, main.find('"', at + 9) - at - 9)
                                         : std::string();
    };
    EXPECT_EQ(link_of("cornell/report.html"), "cornell/report.html");
    EXPECT_EQ(link_of("a b#?%\"<.html"), "a%20b%23%3F%25%22%3C.html");
    EXPECT_EQ(link_of("javascript:alert(1)"), "javascript%3Aalert%281%29");
    EXPECT_EQ(link_of("//elsewhere/x"), "");
}

TEST(HtmlPage, ChartsRefuseWhatCannotBeDrawn) {
    HtmlChart chart{"t", "", {{"x", "x"}}, {{"y", "y"}}, {{"s", {{"x", {1, 2}}, {"y", {1}}}}}};
    HtmlPage page("t", "v");
    EXPECT_THROW(page.add_chart(chart), std::invalid_argument);
    chart.series[0].columns[1].value = {1, 2};
    EXPECT_NO_THROW(page.add_chart(chart));
    chart.series[0].columns[1].low = {1};
    EXPECT_THROW(page.add_chart(chart), std::invalid_argument);
    chart.series[0].columns.pop_back();
    EXPECT_THROW(page.add_chart(chart), std::invalid_argument);
}

TEST(HtmlPage, NumbersAreShort) {
    EXPECT_EQ(format_number(0.01234), "0.0123");
    EXPECT_EQ(format_number(1.234e-5), "1.23e-05");
    EXPECT_EQ(format_number(12345), "12345");
    EXPECT_EQ(format_number(-3.14159, 2), "-3.1");
    EXPECT_EQ(format_number(0), "0");
    EXPECT_EQ(format_number(std::nan("")), "-");
}

// The value of a half float by its definition (IEEE 754-2008, table 3.5).
double half_value(std::uint16_t half) {
    const int exponent = half >> 10 & 31, fraction = half & 1023;
    const double size =
        exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
    return half & 0x8000 ? -size : size;
}

TEST(HtmlImages, HalfFloatsRoundToTheNearest) {
    for (int bits = 0; bits < 0x7c00; ++bits) {
        const double value = half_value(std::uint16_t(bits));
        ASSERT_EQ(half_from_float(float(value)), bits);
        ASSERT_EQ(half_from_float(float(-value)), bits | 0x8000);
        if (bits + 1 == 0x7c00) break;
        // Halfway to the next goes to the even one, a little more or less to the nearer.
        const float middle = float((value + half_value(std::uint16_t(bits + 1))) / 2);
        ASSERT_EQ(half_from_float(middle), bits + (bits & 1)) << bits;
        ASSERT_EQ(half_from_float(std::nextafter(middle, 0.0f)), bits) << bits;
        ASSERT_EQ(half_from_float(std::nextafter(middle, 1e9f)), bits + 1) << bits;
    }
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(half_from_float(1e9f), 0x7bff);
    EXPECT_EQ(half_from_float(-infinity), 0xfbff);
    EXPECT_EQ(half_from_float(std::nanf("")) & 0x7e00, 0x7e00);
}

TEST(HtmlImages, Base64FollowsRfc4648) {
    const std::pair<const char*, const char*> cases[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"},
                                                         {"\xff\xfe\xfd", "//79"}};
    for (const auto& [bytes, text] : cases) EXPECT_EQ(base64(bytes), text);
}

TEST(HtmlImages, ImagesOfAnotherSizeAreLeftOutAndSaid) {
    const Image reference(8, 8), other(4, 8);
    HtmlPage page("t", "v");
    add_image_viewer(page, {{"reference", "", &reference}, {"odd", "", &other}}, 1);
    EXPECT_TRUE(holds(page.finish(), "odd has no image of the reference's size"));
}

TEST(HtmlImages, ManyPixelsAreAveragedAndSaid) {
    const Image big(3000, 2000);
    HtmlPage page("t", "v");
    add_image_viewer(page, {{"reference", "", &big}, {"a", "", &big}}, 1);
    const std::string html = page.finish();
    EXPECT_TRUE(holds(html, "squares of 2x2 pixels are averaged"));
    EXPECT_TRUE(holds(html, "\"width\":1500"));
}

// Comparisons of which the verdict is told.
Comparison with_efficiency(const Interval& of_bdpt) {
    Comparison c = test::made_comparison("cornell");
    c.techniques = {c.techniques[0], c.techniques[4]};
    c.techniques[1].efficiency = of_bdpt;
    return c;
}

TEST(HtmlReport, VerdictFollowsTheInterval) {
    const Verdict win = verdict_of(with_efficiency({5, 4, 6}));
    EXPECT_EQ(win.best, "bdpt:2");
    EXPECT_EQ(win.mark, Mark::good);
    EXPECT_THAT(win.text, HasSubstr("5 times as efficient as path (95 % interval 4 to 6)"));
    const Verdict loss = verdict_of(with_efficiency({0.5, 0.4, 0.6}));
    EXPECT_EQ(loss.best, "path");
    EXPECT_THAT(loss.text, HasSubstr("path is the best here"));
    const Verdict even = verdict_of(with_efficiency({1.1, 0.8, 1.4}));
    EXPECT_EQ(even.best, "");
    EXPECT_EQ(even.mark, Mark::warning);
    EXPECT_THAT(even.text, HasSubstr("No technique is shown to be better than path"));
    const Verdict unknown = verdict_of(with_efficiency({5, unknown_number, unknown_number}));
    EXPECT_EQ(unknown.best, "");
    EXPECT_THAT(unknown.text, HasSubstr("with one seed there is no interval"));
}

TEST(HtmlReport, BiasComesFirst) {
    Comparison c = with_efficiency({5, 4, 6});
    c.techniques[1].bias.flagged = true;
    const Verdict verdict = verdict_of(c);
    EXPECT_EQ(verdict.mark, Mark::bad);
    EXPECT_EQ(verdict.text.find("bdpt:2 is biased, or the reference"), 0u);
    EXPECT_EQ(verdict.best, "");
    c.techniques[1].bias.flagged = false;
    c.techniques[1].bias.expected = true;
    EXPECT_THAT(verdict_of(c).text, Not(HasSubstr("biased")));
}

// A mean that differs for a reason is no praise either.
TEST(HtmlReport, ExpectedDifferencesAreMarked) {
    Comparison c = with_efficiency({5, 4, 6});
    BiasVerdict& b = c.techniques[1].bias;
    b.limit = 4;
    b.z = -48;
    b.expected = true;
    b.text = "differs, as it must";
    const auto mark_of_row = [&] {
        const std::string page = report_of(c);
        const size_t at = page.find(b.text), cell = page.rfind("<td", at);
        return page.substr(cell, at - cell);
    };
    EXPECT_THAT(mark_of_row(), HasSubstr("warning"));
    b.z = 1;
    EXPECT_THAT(mark_of_row(), HasSubstr("good"));
}

TEST(HtmlReport, WhatDoesNotCoverCannotWin) {
    Comparison c = with_efficiency({5, 4, 6});
    c.techniques[1].not_covered = {"caustics"};
    EXPECT_EQ(verdict_of(c).best, "");
    EXPECT_THAT(verdict_of(c).text, HasSubstr("bdpt:2 does not cover all of this scene"));
}

TEST(HtmlReport, StoppedRunsSaySo) {
    Comparison c = with_efficiency({5, 4, 6});
    c.complete = false;
    EXPECT_THAT(verdict_of(c).text, HasSubstr("stopped early"));
    c.techniques[1] = TechniqueResult{};
    EXPECT_NO_THROW(report_of(c));
    EXPECT_TRUE(holds(report_of(Comparison{}), "Nothing was compared"));
}

TEST(HtmlReport, HoldsAllThatWasMeasured) {
    const Comparison c = test::made_comparison("cornell");
    const std::string page = report_of(c);
    for (const std::string& text : {c.command, c.formula, c.method, c.machine.cpu, c.left_out[0],
                                    c.techniques[1].not_covered[0], c.reference.why})
        EXPECT_TRUE(holds(page, html_escape(text)));
    EXPECT_TRUE(holds(page, html_escape(c.warnings[0])));
    EXPECT_TRUE(holds(page, "technique,exponent,seed,seconds,cpu_seconds,spp,mse"));
}

TEST(HtmlReport, SuiteNamesItsLosses) {
    const TempDir folder;
    write_suite_index(test::made_suite(), folder.path().string());
    const std::string page = read(folder / "index.html");
    EXPECT_TRUE(holds(page, "3 of 4 scenes"));
    EXPECT_TRUE(holds(page, "worse on 1: terrace (0.5"));
    EXPECT_TRUE(holds(page, "stopped early"));
    EXPECT_NO_THROW(write_suite_index(SuiteReport{}, folder.path().string()));
}

std::string headline(const SuiteReport& suite) {
    const TempDir folder;
    write_suite_index(suite, folder.path().string());
    return read(folder / "index.html");
}

TEST(HtmlReport, SuiteNamesNoBestThatLoses) {
    SuiteReport suite = test::made_suite();
    for (Comparison& c : suite.scenes)
        for (TechniqueResult& t : c.techniques)
            if (t.efficiency) t.efficiency = Interval{0.5, 0.4, 0.6};
    EXPECT_TRUE(holds(headline(suite), "path does best on the whole; next comes"));
}

TEST(HtmlReport, SuiteCountsNoTechniqueWhereItIsUnsound) {
    SuiteReport suite = test::made_suite();
    // Whatever is said to be a thousand times better, and does not cover the scene.
    for (Comparison& c : suite.scenes)
        for (TechniqueResult& t : c.techniques)
            if (!t.not_covered.empty()) t.efficiency = Interval{1000, 900, 1100};
    EXPECT_FALSE(holds(headline(suite), "light does best"));
    for (Comparison& c : suite.scenes)
        for (TechniqueResult& t : c.techniques) t.bias.flagged = t.label == "path";
    EXPECT_FALSE(holds(headline(suite), "does best on the whole"));
}

// MIDWAY_SCREENSHOTS=FOLDER keeps pictures of all pages. Once is enough: not with the sanitizers.
#ifndef __SANITIZE_ADDRESS__
TEST(HtmlReport, WorksInABrowser) {
    const TempDir folder;
    const Comparison made = test::made_comparison("cornell");
    write_report(made, folder.path().string());
    write_suite_index(test::made_suite(), folder.path().string());
    std::filesystem::create_directory(folder / "hostile");
    write_report(hostile_comparison(), (folder / "hostile").string());
    std::ofstream(folder / "hostile" / "name.txt") << hostile;
    const int x = 158, y = 179;  // on the ball
    const auto pixel = [&](const Image& i) {
        return std::vector<float>{i.at(x, y).r, i.at(x, y).g, i.at(x, y).b};
    };
    std::ofstream(folder / "expected.json")
        << nlohmann::json{{"pixel", {x, y}},
                          {"reference", pixel(made.reference.image)},
                          {"path", pixel(made.techniques[0].image)}};
    const char* shots = std::getenv("MIDWAY_SCREENSHOTS");
    const std::string log = (folder / "browser.log").string();
    const std::string command =
        "python3 '" MIDWAY_SOURCE_DIR "/tests/support/report_in_browser.py' '" +
        folder.path().string() + "' " + (shots ? "'" + std::string(shots) + "' " : "") + "> '" +
        log + "' 2>&1";
    const int status = std::system(command.c_str());
    if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "no Chromium to open the reports in (chromium)";
    EXPECT_EQ(status, 0) << read(log);
}
#endif

}  // namespace
}  // namespace midway
