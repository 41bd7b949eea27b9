#include "analysis/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/report/assets.h"
#include "base/field.h"
#include "base/markup.h"

namespace dihaptic::analysis {
namespace {

using PageJson = nlohmann::json;

/// Values that are not finite become null.
PageJson numbers(const std::vector<double>& values) {
    PageJson out = PageJson::array();
    for (const double value : values)
        out.push_back(std::isfinite(value) ? PageJson(value) : PageJson());
    return out;
}

/// Four significant digits. A value as small as a rounding error is shown as 0.
std::string in_short(double value) {
    if (std::isnan(value)) return "-";
    return fmt::format("{:.4g}", std::abs(value) < 1e-6 ? 0 : value);
}

std::string to_html(const Table& table) {
    std::string out = "<div class=\"wide\"><table>\n<tr>";
    for (const Table::Column& column : table.columns)
        out += fmt::format("<th title=\"{}\">{}</th>", escaped_markup(column.in_words()),
                           escaped_markup(column.name));
    out += "</tr>\n";
    for (const auto& row : table.rows) {
        out += "<tr>";
        for (const Table::Cell& cell : row) {
            if (const auto* text = std::get_if<std::string>(&cell)) {
                out += fmt::format("<td>{}</td>", escaped_markup(*text));
                continue;
            }
            const double value = std::get<double>(cell);
            out += fmt::format("<td class=\"number\">{}</td>", in_short(value));
        }
        out += "</tr>\n";
    }
    return out + "</table></div>\n";
}

}  // namespace

bool Series::empty() const {
    return std::none_of(y.begin(), y.end(), [](double value) { return std::isfinite(value); });
}

Page::Page(std::string title, std::string who, std::string origin)
    : title_(std::move(title)), who_(std::move(who)), origin_(std::move(origin)) {}

void Page::heading(const std::string& text) {
    body_ += fmt::format("<h2>{}</h2>\n", escaped_markup(text));
}

void Page::text(const std::string& text) {
    body_ += fmt::format("<p>{}</p>\n", escaped_markup(text));
}

void Page::problems(const std::string& heading, const std::vector<Problem>& problems) {
    if (problems.empty()) return;
    this->heading(heading);
    for (const Problem& problem : problems) text(problem.text());
}

void Page::table(const Table& table, const std::string& caption) {
    body_ += to_html(table) + fmt::format("<p class=\"caption\">{}</p>\n", escaped_markup(caption));
}

void Page::folded_table(const std::string& title, const Table& table) {
    body_ += fmt::format("<details><summary>{}</summary>\n{}</details>\n", escaped_markup(title),
                         to_html(table));
}

void Page::chart(Chart chart) {
    std::erase_if(chart.series, [](const Series& s) { return s.empty(); });
    if (chart.series.empty()) {
        text(chart.title + ": no values were measured.");
        return;
    }
    PageJson json{{"title", chart.title}, {"x_label", chart.x_label}, {"y_label", chart.y_label}};
    json["series"] = PageJson::array();
    for (const Series& s : chart.series) {
        json["series"].push_back({{"name", s.name},
                                  {"drawn", std::string(enum_name(s.drawn))},
                                  {"x", numbers(s.x)},
                                  {"y", numbers(s.y)},
                                  {"low", numbers(s.low)},
                                  {"high", numbers(s.high)},
                                  {"colour", s.colour}});
    }
    json["marks"] = PageJson::array();
    for (const Mark& mark : chart.marks)
        json["marks"].push_back({{"x", mark.x}, {"text", mark.text}});
    // a name from a file may be invalid UTF-8: it is shown with a replacement character
    const std::string data = json.dump(-1, ' ', false, PageJson::error_handler_t::replace);
    body_ += fmt::format(
        "<figure><div class=\"chart\" data-chart=\"{}\"></div><div class=\"legend\"></div>"
        "<figcaption class=\"caption\">{}</figcaption></figure>\n",
        escaped_markup(data), escaped_markup(chart.caption));
    ++charts_;
}

void Page::picture(const std::string& svg, const std::string& caption) {
    body_ += fmt::format(
        "<figure class=\"picture\">{}<figcaption class=\"caption\">{}</figcaption></figure>\n", svg,
        escaped_markup(caption));
}

std::string Page::html() const {
    const std::string hint =
        charts_ > 0 ? "<p class=\"hint caption\">Drag across a chart to zoom, Shift and drag to "
                      "move, double-click to see the whole chart again.</p>\n"
                    : "";
    const std::string who = fmt::format("<p class=\"who\">{}</p>\n", escaped_markup(who_));
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{0}</title>\n"
        "<style>\n{1}\n{2}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{8}<p class=\"origin\">{3}</p>\n"
        "{4}{5}{8}<p class=\"origin\">{3}</p>\n<script>\n{6}\n</script>\n<script>\n{7}</script>\n"
        "</body>\n</html>\n",
        escaped_markup(title_), kDygraphStyle, kPageStyle, escaped_markup(origin_), hint, body_,
        kDygraphScript, kPageScript, who);
}

}  // namespace dihaptic::analysis
