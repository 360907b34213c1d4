// One HTML page in one file: headings, tables and charts in the project's style, to be opened
// offline and printed. Everything it needs (style, scripts, Chart.js with its licence notice) is
// embedded at build time from renderer/report/web/; nothing is loaded from outside, and a content
// security policy forbids it.
//
// Every text is escaped here, so names from files may hold anything. Numbers that are not finite
// become gaps in charts and "-" in format_number. Colours of series follow their name: a technique
// looks the same on every page.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace midway {

enum class Mark { none, good, bad, warning };

struct HtmlCell {
    HtmlCell() = default;
    HtmlCell(std::string t) : text(std::move(t)) {}
    HtmlCell(const char* t) : text(t) {}
    HtmlCell(std::string t, Mark m) : text(std::move(t)), mark(m) {}

    std::string text;
    Mark mark = Mark::none;
    std::string detail = {};  // smaller, under the text: an interval, a remark
    std::string link = {};    // a file below the page's folder
    std::string image = {};   // data URI of a small image, shown above the text
    bool swatch = false;      // the text names a series: its colour stands before it
};

struct HtmlTable {
    std::string caption;  // what the table says, in a sentence
    std::vector<std::string> columns;
    std::vector<std::vector<HtmlCell>> rows;  // the first cell of a row is its heading
};

// One quantity of a series, point by point. `low` and `high` are empty where there is no band.
struct ChartColumn {
    std::string key;
    std::vector<double> value, low = {}, high = {};
};

// One curve (or cloud): all its columns have one length.
struct ChartSeries {
    std::string name;
    std::vector<ChartColumn> columns;
    std::string note = {};  // shown with hover values
};

// A horizontal line; the region below or above it can be shaded as one where values mean nothing.
struct ChartLevel {
    enum class Shade { none, below, above };
    std::string name;
    double value = 0;
    Shade shade = Shade::none;
};

// What an axis can show: the column of this key. Several choices make a selector.
struct ChartAxis {
    std::string key, label;
    bool logarithmic = true;
    std::vector<ChartLevel> levels = {};  // of a vertical axis
    std::string note = {};                // said under the chart while this axis is chosen
};

struct HtmlChart {
    std::string title, caption;
    std::vector<ChartAxis> x, y;  // at least one each
    std::vector<ChartSeries> series;
    bool lines = true;  // points alone without
};

// The text with & < > " ' as entities and control characters as spaces: safe in elements and quoted
// attributes.
std::string html_escape(std::string_view text);

// A value for people, three significant digits: 0.0123, 1.23e-05, 12300; "-" where not finite.
std::string format_number(double value, int digits = 3);

// Pages are built from the top; each call appends.
class HtmlPage {
  public:
    // `verdict` is the page in one sentence, under the title.
    HtmlPage(std::string title, std::string verdict, Mark mark = Mark::none);

    // Level 2 headings make the table of contents.
    void add_heading(std::string_view text, int level = 2);
    void add_paragraph(std::string_view text);
    void add_note(Mark mark, std::string_view text);  // a sentence in a box
    void add_list(const std::vector<std::string>& items);
    void add_code(std::string_view text);  // with a button that copies it
    void add_facts(const std::vector<std::pair<std::string, std::string>>& facts);
    void add_table(const HtmlTable& table);
    // std::invalid_argument for columns of different lengths or axes without a column.
    void add_chart(const HtmlChart& chart);
    // A button that saves `text` as a file of this name; the text travels within the page.
    void add_download(const std::string& file_name, std::string_view text);

    // For parts with markup of their own: trusted HTML, style and scripts of this library (they run
    // after page.js and charts.js), and JSON for them (escaped here; midway.json(id) reads it).
    void add_html(std::string_view trusted);
    void add_style(std::string_view trusted);
    void add_script(std::string_view trusted);
    void add_json(const std::string& id, std::string_view json);

    // What is folded away on screen, and printed: call around the parts.
    void begin_details(std::string_view summary, bool open = false);
    void end_details();

    // The whole file.
    std::string finish() const;

  private:
    std::string title_, verdict_;
    Mark mark_;
    std::string contents_, body_, styles_;
    std::vector<std::string> scripts_;
    int ids_ = 0;
};

}  // namespace midway
