#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "image/file.h"
#include "render/json_text.h"
#include "report/html_page.h"
#include "report/summary.h"

namespace midway {
namespace {

using Json = nlohmann::ordered_json;

std::string ratio_text(const Interval& i) {
    if (std::isnan(i.value)) return "-";
    const std::string value = format_number(i.value, 3);
    if (std::isnan(i.lower)) return value;
    return value + " (" + format_number(i.lower, 3) + " to " + format_number(i.upper, 3) + ")";
}

// Marks stand for what the figure cannot be read without.
std::string cell(const TechniqueResult& t, bool trimmed) {
    const std::optional<Interval>& e = trimmed ? t.efficiency_trimmed : t.efficiency;
    std::string text = t.curves.empty() ? "-" : e ? ratio_text(*e) : "1";
    if (!t.not_covered.empty()) text += " *";
    if (t.bias.flagged) text += " !";
    return text;
}

std::string table(const SuiteReport& s, bool trimmed) {
    const std::vector<std::string> labels = technique_labels(s);
    std::string head = "| scene |", rule = "|---|", body;
    for (const std::string& l : labels) {
        head += " `" + l + "` |";
        rule += "---|";
    }
    for (const Comparison& c : s.scenes) {
        body += "| " + c.name + " |";
        for (const std::string& l : labels) {
            std::string text = "-";
            for (const TechniqueResult& t : c.techniques)
                if (t.label == l) text = cell(t, trimmed);
            body += " " + text + " |";
        }
        body += "\n";
    }
    return head + "\n" + rule + "\n" + body;
}

}  // namespace

std::vector<std::string> technique_labels(const SuiteReport& s) {
    std::vector<std::string> labels;
    for (const Comparison& c : s.scenes)
        for (const TechniqueResult& t : c.techniques)
            if (std::ranges::find(labels, t.label) == labels.end()) labels.push_back(t.label);
    return labels;
}

std::string suite_table(const SuiteReport& s) {
    std::string text = fmt::format(
        "Efficiency 1 / (relMSE x seconds) relative to the first technique, with 95 % "
        "intervals over seeds; {} on {} threads.\n\n",
        s.machine.cpu, s.machine.threads);
    text += table(s, false);
    text +=
        "\nThe same by the trimmed relMSE (without the 0.1 % of the pixels that are worst):\n\n";
    text += table(s, true);
    text +=
        "\n\\* does not cover the whole scene: what is missing counts as error. ! differs from "
        "the reference in the mean.\n";
    if (!s.complete) text += "\nStopped early: the same command completes this table.\n";
    text += "\n    " + s.command + "\n";
    return text;
}

void write_suite(const SuiteReport& s, const std::string& directory) {
    const std::filesystem::path folder(directory);
    std::filesystem::create_directories(folder);
    atomic_write((folder / "table.md").string(), suite_table(s));
    Json j;
    j["name"] = s.name;
    j["command"] = s.command;
    j["complete"] = s.complete;
    j["scenes_planned"] = s.scenes_planned;
    j["seconds"] = s.seconds;
    j["scenes"] = Json::array();
    for (const Comparison& c : s.scenes) j["scenes"].push_back(Json::parse(summary_json(c)));
    atomic_write((folder / "summary.json").string(), json_text(j) + "\n");
}

}  // namespace midway
