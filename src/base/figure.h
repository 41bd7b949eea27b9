// A struct of results lists its figures once, each with its unit and a description:
//
//     struct Lift {
//         double peak_grip = kUnmeasured;
//         double height = kUnmeasured;
//
//         template <class Self, class Visitor>
//         static void visit(Self& f, Visitor& v) {
//             v("peak_grip", f.peak_grip, "N", "mean of the digits");
//             v("height", f.height, "mm", "in the hold");
//         }
//     };
//
// This list determines the columns of CSV and NWB files, their descriptions in BIDS, the tables on
// pages and in the documentation, and the keys in JSON. Members are in SI units. A column is in the
// listed unit, which is appended to its name: peak_grip_N, height_mm. If the name in the list
// already ends in the unit, the member itself is in that unit. Pure numbers have the unit "1", and
// texts have the empty unit "".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/field.h"
#include "base/table.h"
#include "base/unmeasured.h"

namespace dihaptic {

/// How a figure is written: the name of its column, and the factor by which its member is
/// multiplied.
struct FigureForm {
    std::string key;
    double scale = 1;
};
/// `unit` is in the usual notation, e.g. "N/s"; base/unit.h must know it.
FigureForm figure_form(std::string_view name, std::string_view unit);
/// Like FigureForm, with the sentence that describes the figure.
struct FigureColumn {
    Table::Column column;
    double scale = 1;
};
FigureColumn figure_column(std::string_view name, std::string_view unit, std::string_view what);

/// Collects figures as the columns and cells of a table. The figures may come from a struct or from
/// direct calls.
class FigureLister {
  public:
    template <class T>
    void operator()(std::string_view name, const T& value, std::string_view unit,
                    std::string_view what) {
        FigureColumn figure = figure_column(name, unit, what);
        columns.push_back(std::move(figure.column));
        cells.push_back(cell(value, figure.scale));
    }
    /// A figure in a nested struct gets both names: "awake.median_us".
    template <class T>
    requires requires(const T& figures, FigureLister& lister) { T::visit(figures, lister); }
    void operator()(std::string_view name, const T& value, std::string_view, std::string_view) {
        FigureLister inner;
        T::visit(value, inner);
        for (Table::Column& column : inner.columns) {
            column.name = std::string(name) + "." + column.name;
            columns.push_back(std::move(column));
        }
        cells.insert(cells.end(), inner.cells.begin(), inner.cells.end());
    }

    std::vector<Table::Column> columns;
    std::vector<Table::Cell> cells;

  private:
    template <class T>
    static Table::Cell cell(const T& value, double scale) {
        if constexpr (std::is_same_v<T, bool>) {
            return value ? "yes" : "no";
        } else if constexpr (NamedEnum<T>) {
            return std::string(enum_name(value));
        } else if constexpr (std::is_arithmetic_v<T>) {
            return scale * static_cast<double>(value);
        } else if constexpr (requires { value.has_value(); }) {
            return value ? cell(*value, scale) : kUnmeasured;
        } else {
            return std::string(value);
        }
    }
};

template <class Figures>
FigureLister list_figures(const Figures& figures) {
    FigureLister out;
    Figures::visit(figures, out);
    return out;
}

/// Adds a row for each item of `rows`, a range of Figures.
template <class Figures, class Rows>
Table figure_table(const Rows& rows) {
    Table out{list_figures(Figures{}).columns, {}};
    for (const Figures& row : rows) out.rows.push_back(list_figures(row).cells);
    return out;
}

/// Adds the columns of a struct to a table, and the struct's values to a row of that table.
template <class Figures>
void add_columns(Table& table) {
    for (Table::Column& column : list_figures(Figures{}).columns)
        table.columns.push_back(std::move(column));
}
template <class Figures>
void add_cells(std::vector<Table::Cell>& row, const Figures& figures) {
    for (Table::Cell& cell : list_figures(figures).cells) row.push_back(std::move(cell));
}

/// Finds the column of one member of a struct.
class FigureFinder {
  public:
    explicit FigureFinder(const void* member) : member_(member) {}
    template <class T>
    void operator()(std::string_view name, const T& value, std::string_view unit,
                    std::string_view what) {
        if (static_cast<const void*>(&value) == member_) found = figure_column(name, unit, what);
    }
    FigureColumn found;

  private:
    const void* member_;
};
/// Returns the column of a member that the struct lists.
template <class Figures, class Member>
FigureColumn figure_column(Member Figures::*member) {
    const Figures figures{};
    FigureFinder finder(&(figures.*member));
    Figures::visit(figures, finder);
    return finder.found;
}

/// Adds a row to a table, and sets the columns of the table.
void add_row(Table& table, FigureLister row);

/// Writes a struct's figures as a JSON object (`Json` is nlohmann::ordered_json). Structs that list
/// figures become objects, vectors become arrays, and empty optionals become null.
template <class Json>
class FigureJson {
  public:
    template <class T>
    void operator()(std::string_view name, const T& value, std::string_view unit,
                    std::string_view) {
        const FigureForm form = figure_form(name, unit);
        json[form.key] = of(value, form.scale);
    }

    template <class T>
    static Json of(const T& value, double scale = 1) {
        if constexpr (NamedEnum<T>) {
            return std::string(enum_name(value));
        } else if constexpr (std::is_convertible_v<const T&, std::string_view>) {
            return std::string(value);
        } else if constexpr (std::is_floating_point_v<T>) {
            return scale * value;
        } else if constexpr (std::is_integral_v<T>) {
            return value;
        } else if constexpr (requires { value.has_value(); }) {
            return value ? of(*value, scale) : Json();
        } else if constexpr (requires { value.begin(); }) {
            Json out = Json::array();
            for (const auto& item : value) out.push_back(of(item, scale));
            return out;
        } else {
            FigureJson inner;
            T::visit(value, inner);
            return inner.json;
        }
    }

    Json json = Json::object();
};

}  // namespace dihaptic
