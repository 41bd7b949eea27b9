// Reads a session's table into the structs from which the table was written. Each row struct lists
// its figures once (base/figure.h): figure_table() writes a table of these structs, and RowFile
// reads the table back.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/field.h"
#include "base/figure.h"
#include "base/table.h"
#include "base/text_file.h"

namespace dihaptic::rows {

/// Lists the components of a vector, e.g. reach_from_x and so on for "reach_from", all with the
/// same description.
template <class Visitor, class Vector>
void visit_vector(Visitor& v, const std::string& name, Vector& value, std::string_view unit,
                  std::string_view what) {
    v(name + "_x", value.x(), unit, what);
    v(name + "_y", value.y(), unit, what);
    v(name + "_z", value.z(), unit, what);
}

/// Finds the columns that a struct lists, and reads rows of these columns into structs. If a column
/// is missing from the table, as it may be in an earlier version's table, the member of the struct
/// is left unchanged. The same applies to an empty cell, and to an invalid cell where an integer is
/// expected.
class RowReader {
  public:
    explicit RowReader(const CsvFile& table) : table_(table) {}

    /// Throws Error if a cell contains a word that is not allowed in its column.
    template <class Row>
    Row read(size_t row) {
        Row out;
        row_ = row;
        slot_ = 0;
        Row::visit(out, *this);
        return out;
    }

    template <class T>
    void operator()(std::string_view name, T& value, std::string_view unit, std::string_view) {
        if (slot_ == slots_.size()) {
            const FigureForm form = figure_form(name, unit);
            slots_.push_back({table_.column(form.key), form.scale});
        }
        const Slot& slot = slots_[slot_++];
        if (!slot.column) return;
        if constexpr (std::is_floating_point_v<T>) {
            value = table_.number(row_, slot.column) / slot.scale;
        } else {
            const std::string& text = table_.text(row_, slot.column);
            if (!text.empty()) take(value, text, *slot.column);
        }
    }

  private:
    struct Slot {
        std::optional<size_t> column;
        double scale;
    };

    void take(std::string& value, const std::string& text, size_t) { value = text; }
    void take(bool& value, const std::string& text, size_t) { value = text == "yes"; }
    template <std::integral T>
    void take(T& value, const std::string&, size_t column) {
        const double number = table_.number(row_, column);
        if (std::abs(number) < static_cast<double>(std::numeric_limits<T>::max()))
            value = static_cast<T>(number);
    }
    template <NamedEnum E>
    void take(E& value, const std::string& text, size_t column) {
        std::optional<E> named = enum_named<E>(text);
        if constexpr (requires { old_value(value); }) {
            if (text == old_name(value).was) named = old_value(value);
        }
        if (named) {
            value = *named;
            return;
        }
        throw Error(table_.place(row_), table_.columns()[column],
                    fmt::format("is '{}', which is not one of: {}", shortened(text),
                                fmt::join(enum_names(value), ", ")),
                    "Replace the table with a backup, or rebuild it: dihaptic recover.");
    }

    const CsvFile& table_;
    std::vector<Slot> slots_;
    size_t row_ = 0, slot_ = 0;
};

/// A session's table: a Row for each of its lines, and access to any further columns.
template <class Row>
class RowFile {
  public:
    /// Throws Error when the file cannot be read, or when it contains a word that is not allowed in
    /// its column.
    explicit RowFile(const std::string& file) : RowFile(CsvFile(file)) {}
    explicit RowFile(CsvFile table) : table_(std::move(table)) {
        RowReader reader(table_);
        rows_.reserve(table_.rows());
        for (size_t i = 0; i < table_.rows(); ++i) rows_.push_back(reader.read<Row>(i));
    }

    size_t size() const { return rows_.size(); }
    bool empty() const { return rows_.empty(); }
    const Row& operator[](size_t i) const { return rows_[i]; }
    auto begin() const { return rows_.begin(); }
    auto end() const { return rows_.end(); }
    const Row& back() const { return rows_.back(); }

    /// Index of the column with this name, for names that a task or a person chose; nullopt if
    /// there is none.
    std::optional<size_t> column(const std::string& name) const { return table_.column(name); }
    /// Text of a cell; empty if there is no such column.
    const std::string& text(size_t row, std::optional<size_t> column) const {
        return table_.text(row, column);
    }
    /// Number in a cell; NaN if the cell does not contain a number, or if there is no such column.
    double number(size_t row, std::optional<size_t> column) const {
        return table_.number(row, column);
    }

  private:
    CsvFile table_;
    std::vector<Row> rows_;
};

}  // namespace dihaptic::rows
