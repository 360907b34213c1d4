#include "report/html_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "math/hash.h"
#include "report/html_web.h"

namespace midway {
namespace {

const char* class_of(Mark mark) {
    switch (mark) {
        case Mark::good:
            return "good";
        case Mark::bad:
            return "bad";
        case Mark::warning:
            return "warning";
        case Mark::none:
            break;
    }
    return "none";
}

// JSON as it may stand within a script element, whatever its strings hold: all beyond ASCII and
// the characters that HTML gives a meaning are written as \u escapes.
std::string script_json(const nlohmann::json& json) {
    std::string text;
    for (char c : json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)) {
        if (c == '<' || c == '>' || c == '&')
            text += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            text += c;
    }
    return text;
}

nlohmann::json finite_values(const std::vector<double>& values) {
    nlohmann::json list = nlohmann::json::array();
    for (double v : values) list.push_back(std::isfinite(v) ? nlohmann::json(v) : nullptr);
    return list;
}

nlohmann::json axes_json(const std::vector<ChartAxis>& axes) {
    nlohmann::json list = nlohmann::json::array();
    for (const ChartAxis& axis : axes) {
        nlohmann::json levels = nlohmann::json::array();
        for (const ChartLevel& level : axis.levels) {
            using Shade = ChartLevel::Shade;
            // What cannot stand on a logarithmic axis is no level of it.
            if (!std::isfinite(level.value) || (axis.logarithmic && level.value <= 0)) continue;
            const char* shade = level.shade == Shade::below   ? "below"
                                : level.shade == Shade::above ? "above"
                                                              : "none";
            levels.push_back({{"name", level.name}, {"value", level.value}, {"shade", shade}});
        }
        list.push_back({{"key", axis.key},
                        {"label", axis.label},
                        {"logarithmic", axis.logarithmic},
                        {"levels", levels},
                        {"note", axis.note}});
    }
    return list;
}

nlohmann::json series_json(const ChartSeries& series) {
    nlohmann::json columns = nlohmann::json::object();
    for (const ChartColumn& column : series.columns)
        columns[column.key] = {{"value", finite_values(column.value)},
                               {"low", finite_values(column.low)},
                               {"high", finite_values(column.high)}};
    return {{"name", series.name}, {"note", series.note}, {"columns", columns}};
}

void check_chart(const HtmlChart& chart) {
    const auto fail = [&](const std::string& what) {
        throw std::invalid_argument("cannot draw a chart: " + what + " (" + chart.title +
                                    "); give every axis columns of one length");
    };
    if (chart.x.empty() || chart.y.empty()) fail("it has no axis");
    for (const ChartSeries& series : chart.series)
        for (const ChartColumn& column : series.columns) {
            const size_t n = column.value.size();
            const auto wrong = [&](const auto& edge) { return !edge.empty() && edge.size() != n; };
            if (n != series.columns[0].value.size() || wrong(column.low) || wrong(column.high))
                fail("columns differ in length");
        }
    for (const auto* axes : {&chart.x, &chart.y})
        for (const ChartAxis& axis : *axes)
            if (!chart.series.empty() &&
                !std::ranges::any_of(chart.series, [&](const ChartSeries& series) {
                    return std::ranges::any_of(series.columns, [&](const ChartColumn& column) {
                        return column.key == axis.key;
                    });
                }))
                fail("nothing to show for " + axis.key);
}

// A file below the page's folder as a link, every special character written as %XX: nothing can
// name a scheme (javascript:) or another machine. Empty where it is no such file.
std::string local_link(std::string_view file) {
    if (file.empty() || file[0] == '/') return {};
    std::string link;
    for (const char c : file) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                           (c >= 'a' && c <= 'z') ||
                           std::string_view("-_./~").find(c) != std::string_view::npos;
        link += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return link;
}

// Digits, with nothing but what figures need around them: such columns stand to the right.
bool looks_like_number(std::string_view text) {
    return !text.empty() &&
           text.find_first_not_of("0123456789.,-+e%x \xe2\x80\x93<>=~") == text.npos;
}

std::string cell_html(const HtmlCell& cell, bool heading, bool number) {
    std::string content;
    if (cell.image.starts_with("data:image/"))
        content += "<img alt=\"\" src=\"" + html_escape(cell.image) + "\">";
    if (cell.swatch)
        content += "<span class=\"swatch\" data-series=\"" + html_escape(cell.text) + "\"></span>";
    const std::string link = local_link(cell.link);
    content += link.empty() ? html_escape(cell.text)
                            : "<a href=\"" + link + "\">" + html_escape(cell.text) + "</a>";
    if (!cell.detail.empty()) content += "<small>" + html_escape(cell.detail) + "</small>";
    return fmt::format("<{0} class=\"{1}{2}\"{3}>{4}</{0}>", heading ? "th" : "td",
                       cell.mark == Mark::none ? "" : class_of(cell.mark), number ? " number" : "",
                       heading ? " scope=\"row\"" : "", content);
}

// Fills {{name}} in the template; what is filled in is not looked at again.
std::string fill(std::string_view form,
                 const std::vector<std::pair<std::string_view, std::string_view>>& values) {
    std::string text;
    for (size_t at = 0; at < form.size();) {
        const size_t open = std::min(form.find("{{", at), form.size());
        text += form.substr(at, open - at);
        if (open == form.size()) break;
        const size_t close = form.find("}}", open);
        const std::string_view name = form.substr(open + 2, close - open - 2);
        const auto found =
            std::ranges::find(values, name, &decltype(values.begin())::value_type::first);
        text += found->second;
        at = close + 2;
    }
    return text;
}

}  // namespace

std::string html_escape(std::string_view text) {
    std::string escaped;
    for (char c : text) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\'':
                escaped += "&#39;";
                break;
            default:
                escaped += static_cast<unsigned char>(c) < 32 && c != '\n' ? ' ' : c;
        }
    }
    return escaped;
}

std::string format_number(double value, int digits) {
    if (!std::isfinite(value)) return "-";
    if (value == 0) return "0";
    const double size = std::abs(value);
    if (size < 1e-3 || size >= 1e5) return fmt::format("{:.{}e}", value, digits - 1);
    return size >= std::pow(10.0, digits) ? fmt::format("{:.0f}", value)
                                          : fmt::format("{:.{}g}", value, digits);
}

HtmlPage::HtmlPage(std::string title, std::string verdict, Mark mark)
    : title_(std::move(title)), verdict_(std::move(verdict)), mark_(mark) {}

void HtmlPage::add_heading(std::string_view text, int level) {
    const std::string id = fmt::format("part-{}", ++ids_);
    body_ += fmt::format("<h{0} id=\"{1}\">{2}</h{0}>\n", level, id, html_escape(text));
    if (level == 2)
        contents_ += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", id, html_escape(text));
}

void HtmlPage::add_paragraph(std::string_view text) {
    body_ += "<p>" + html_escape(text) + "</p>\n";
}

void HtmlPage::add_note(Mark mark, std::string_view text) {
    body_ += fmt::format("<p class=\"note {}\">{}</p>\n", class_of(mark), html_escape(text));
}

void HtmlPage::add_list(const std::vector<std::string>& items) {
    body_ += "<ul>\n";
    for (const std::string& item : items) body_ += "<li>" + html_escape(item) + "</li>\n";
    body_ += "</ul>\n";
}

void HtmlPage::add_code(std::string_view text) {
    const std::string id = fmt::format("code-{}", ++ids_);
    body_ += fmt::format(
        "<div class=\"code\"><pre id=\"{0}\" tabindex=\"0\">{1}</pre>"
        "<button type=\"button\" data-copy=\"{0}\">Copy</button></div>\n",
        id, html_escape(text));
}

void HtmlPage::add_facts(const std::vector<std::pair<std::string, std::string>>& facts) {
    body_ += "<dl class=\"facts\">\n";
    for (const auto& [name, value] : facts)
        body_ += "<dt>" + html_escape(name) + "</dt><dd>" + html_escape(value) + "</dd>\n";
    body_ += "</dl>\n";
}

void HtmlPage::add_table(const HtmlTable& table) {
    const auto is_number_column = [&](size_t column) {
        bool number = false;
        for (const auto& row : table.rows) {
            if (column >= row.size() || row[column].text.empty() || row[column].text == "-")
                continue;
            if (!looks_like_number(row[column].text)) return false;
            number = true;
        }
        return number;
    };
    const std::string id = fmt::format("about-{}", ++ids_);
    body_ += fmt::format(
        "<p class=\"caption\" id=\"{0}\">{1}</p>\n<div class=\"table\" tabindex=\"0\">"
        "<table aria-describedby=\"{0}\"><thead><tr>",
        id, html_escape(table.caption));
    std::vector<bool> number;
    for (size_t i = 0; i < table.columns.size(); ++i) {
        number.push_back(i > 0 && is_number_column(i));
        body_ += fmt::format("<th scope=\"col\" class=\"{}\">{}</th>", number[i] ? "number" : "",
                             html_escape(table.columns[i]));
    }
    body_ += "</tr></thead><tbody>\n";
    for (const auto& row : table.rows) {
        body_ += "<tr>";
        for (size_t i = 0; i < row.size(); ++i)
            body_ += cell_html(row[i], i == 0, i < number.size() && number[i]);
        body_ += "</tr>\n";
    }
    body_ += "</tbody></table></div>\n";
}

void HtmlPage::add_chart(const HtmlChart& chart) {
    check_chart(chart);
    nlohmann::json series = nlohmann::json::array();
    for (const ChartSeries& s : chart.series) series.push_back(series_json(s));
    const std::string id = fmt::format("chart-{}", ++ids_);
    const nlohmann::json spec = {{"x", axes_json(chart.x)},
                                 {"y", axes_json(chart.y)},
                                 {"lines", chart.lines},
                                 {"series", series}};
    body_ += fmt::format(
        "<figure class=\"chart\" data-chart=\"{0}\">\n<h3>{1}</h3>\n"
        "<div class=\"controls\"></div>\n<div class=\"legend\"></div>\n"
        "<div class=\"plot\"><canvas tabindex=\"0\" role=\"img\" aria-label=\"{1}: values by the "
        "left and right arrow keys\"></canvas></div>\n<p class=\"axis-note\"></p>\n"
        "<figcaption>{2}</figcaption>\n<details class=\"screen-only\"><summary>All numbers of this "
        "chart</summary><div class=\"numbers\" tabindex=\"0\"></div></details>\n</figure>\n"
        "<script type=\"application/json\" id=\"{0}\">{3}</script>\n",
        id, html_escape(chart.title), html_escape(chart.caption), script_json(spec));
}

void HtmlPage::add_download(const std::string& file_name, std::string_view text) {
    const std::string id = fmt::format("download-{}", ++ids_);
    body_ += fmt::format(
        "<p class=\"download\"><button type=\"button\" data-download=\"{0}\" "
        "data-name=\"{1}\">Save "
        "{1}</button></p>\n<script type=\"application/json\" id=\"{0}\">{2}</script>\n",
        id, html_escape(file_name), script_json(std::string(text)));
}

void HtmlPage::add_html(std::string_view trusted) { body_ += trusted; }

void HtmlPage::add_style(std::string_view trusted) { styles_ += trusted; }

void HtmlPage::add_script(std::string_view trusted) { scripts_.emplace_back(trusted); }

void HtmlPage::add_json(const std::string& id, std::string_view json) {
    body_ += "<script type=\"application/json\" id=\"" + html_escape(id) + "\">" +
             script_json(nlohmann::json::parse(json)) + "</script>\n";
}

void HtmlPage::begin_details(std::string_view summary, bool open) {
    body_ += fmt::format("<details{}><summary>{}</summary>\n", open ? " open" : "",
                         html_escape(summary));
}

void HtmlPage::end_details() { body_ += "</details>\n"; }

std::string HtmlPage::finish() const {
    // Scripts run only with the page's nonce. It follows from all that the page says, so no text
    // from a file can know it.
    std::uint64_t state = hash_bytes(0x6d6964776179, body_.data(), body_.size());
    state = hash_bytes(state, title_.data(), title_.size());
    const std::string nonce =
        fmt::format("{:016x}{:016x}", state, hash_bytes(state, verdict_.data(), verdict_.size()));
    std::string scripts;
    const auto add = [&](std::string_view script) {
        scripts += "<script nonce=\"" + nonce + "\">\n";
        scripts += script;
        scripts += "</script>\n";
    };
    add(web::page_js);
    add(web::chart_js);
    add(web::charts_js);
    for (const std::string& script : scripts_) add(script);
    const std::string css = std::string(web::page_css) + styles_;
    const std::string contents = contents_.empty() ? "" : "<ul>\n" + contents_ + "</ul>";
    const std::string title = html_escape(title_), verdict = html_escape(verdict_);
    return fill(web::page_html, {{"title", title},
                                 {"verdict", verdict},
                                 {"mark", class_of(mark_)},
                                 {"nonce", nonce},
                                 {"version", MIDWAY_VERSION},
                                 {"css", css},
                                 {"contents", contents},
                                 {"body", body_},
                                 {"scripts", scripts}});
}

}  // namespace midway
