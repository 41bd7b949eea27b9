// Prints a struct's figures (base/figure.h) for people: first single figures, one a line, then
// lists of structs, each as a table.
#pragma once

#include "base/figure.h"

namespace dihaptic {

class FigureText {
  public:
    template <class T>
    void operator()(std::string_view name, const T& value, std::string_view unit,
                    std::string_view what) {
        single_(name, value, unit, what);
    }
    template <class T>
    void operator()(std::string_view, const std::vector<T>& rows, std::string_view,
                    std::string_view what) {
        tables_ += "\n" + std::string(what) + "\n" + to_text(figure_table<T>(rows));
    }

    std::string text() const {
        size_t width = 0;
        for (const Table::Column& column : single_.columns)
            width = std::max(width, column.name.size());
        std::string out;
        for (size_t i = 0; i < single_.columns.size(); ++i) {
            const std::string& name = single_.columns[i].name;
            out +=
                name + std::string(width + 2 - name.size(), ' ') + to_text(single_.cells[i]) + "\n";
        }
        return out + tables_;
    }

  private:
    FigureLister single_;
    std::string tables_;
};

template <class Figures>
std::string figure_text(const Figures& figures) {
    FigureText out;
    Figures::visit(figures, out);
    return out.text();
}

}  // namespace dihaptic
