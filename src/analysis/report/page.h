// A report's page: one HTML file that needs no other, with charts that zoom, and that reads well on
// paper.
#pragma once

#include <string>

#include "analysis/report/chart.h"
#include "base/table.h"

namespace dihaptic::analysis {

class Page {
  public:
    /// `who`: who moved the hands, and `origin`: what made the page; lines below the title, and at
    /// the page's end.
    Page(std::string title, std::string who, std::string origin);

    void heading(const std::string& text);
    void text(const std::string& text);
    /// Numbers with three digits or so; NaN is a dash. `caption` below it.
    void table(const Table& table, const std::string& caption);
    /// The same, folded away until it is asked for.
    void folded_table(const std::string& title, const Table& table);
    /// Series without a value are left out; a chart of none is a line that says so.
    void chart(Chart chart);

    std::string html() const;

  private:
    std::string title_;
    std::string who_;
    std::string origin_;
    std::string body_;
    int charts_ = 0;
};

}  // namespace dihaptic::analysis
