// Makes a report's page: one self-contained HTML file, with zoomable charts, that also prints well.
#pragma once

#include <string>
#include <vector>

#include "analysis/report/chart.h"
#include "base/diagnostics.h"
#include "base/table.h"

namespace dihaptic::analysis {

class Page {
  public:
    /// `who` (who moved the hands) and `origin` (program and command) become lines below the title
    /// and at the page's end.
    Page(std::string title, std::string who, std::string origin);

    void heading(const std::string& text);
    void text(const std::string& text);
    /// Adds a heading and a line for each problem; without problems, adds nothing.
    void problems(const std::string& heading, const std::vector<Problem>& problems);
    /// Adds a table with `caption` below it. Numbers have four significant digits; NaN is a dash.
    void table(const Table& table, const std::string& caption);
    /// Adds a table that is collapsed until the reader opens it.
    void folded_table(const std::string& title, const Table& table);
    /// Adds a chart. Series without a value are left out; a chart without series is replaced by a
    /// note.
    void chart(Chart chart);
    /// Adds a picture, given as SVG text.
    void picture(const std::string& svg, const std::string& caption);

    std::string html() const;

  private:
    std::string title_;
    std::string who_;
    std::string origin_;
    std::string body_;
    int charts_ = 0;
};

}  // namespace dihaptic::analysis
