#include "base/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/diagnostics.h"
#include "base/given_table.h"
#include "base/number.h"
#include "base/plural.h"
#include "base/text_file.h"
#include "base/unmeasured.h"

namespace dihaptic {

std::string to_csv(const Table::Cell& cell) {
    if (const double* number = std::get_if<double>(&cell))
        return std::isnan(*number) ? "" : number_text(*number, 9);
    const std::string& text = std::get<std::string>(cell);
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"') quoted += '"';
        quoted += c;
    }
    return quoted + "\"";
}

std::string to_csv(const Table& table) {
    std::string out;
    const auto line = [&](const auto& cells, const auto& text) {
        for (size_t i = 0; i < cells.size(); ++i) {
            if (i > 0) out += ",";
            out += text(cells[i]);
        }
        out += "\n";
    };
    line(table.columns,
         [](const Table::Column& column) { return to_csv(Table::Cell(column.name)); });
    for (const auto& row : table.rows)
        line(row, [](const Table::Cell& cell) { return to_csv(cell); });
    return out;
}

std::string to_text(const Table::Cell& cell) {
    const double* number = std::get_if<double>(&cell);
    if (number == nullptr) return std::get<std::string>(cell);
    return std::isnan(*number) ? "-" : fmt::format("{:.6g}", *number);
}

std::string to_text(const Table& table) {
    std::vector<std::string> lines(table.rows.size() + 1);
    for (size_t c = 0; c < table.columns.size(); ++c) {
        std::vector<std::string> words{table.columns[c].name};
        bool numbers = true;
        for (const auto& row : table.rows) {
            words.push_back(to_text(row[c]));
            numbers = numbers && std::holds_alternative<double>(row[c]);
        }
        size_t width = 0;
        for (const std::string& word : words) width = std::max(width, word.size());
        for (size_t i = 0; i < words.size(); ++i) {
            const std::string space(width - words[i].size(), ' ');
            if (c > 0) lines[i] += "  ";
            lines[i] += numbers ? space + words[i] : words[i] + space;
        }
    }
    return fmt::format("{}\n", fmt::join(lines, "\n"));
}

void write_csv(const Table& table, const std::string& file) {
    write_file(to_csv(table), file);
}

namespace {

constexpr size_t kMostColumns = 10'000;
constexpr size_t kMostCells = 20'000'000;  // a cell takes more memory than its text

class CsvParser {
  public:
    CsvParser(const std::string& text, const std::string& file) : text_(text), file_(file) {}

    std::vector<std::vector<std::string>> run() {
        for (; at_ < text_.size(); ++at_) {
            if (quoted_) {
                take_quoted();
            } else {
                take(text_[at_]);
            }
        }
        if (!cell_.empty() || !row_.empty()) {
            row_.push_back(std::move(cell_));
            rows_.push_back(std::move(row_));
        }
        return std::move(rows_);
    }

  private:
    void take_quoted() {
        const char c = text_[at_];
        if (c == '"' && at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
            cell_ += text_[++at_];
        } else if (c == '"') {
            quoted_ = false;
        } else {
            if (c == '\n') ++line_;
            cell_ += c;
        }
    }
    void take(char c) {
        if (c == '"') {
            quoted_ = true;
        } else if (c == ',' || c == '\n') {
            end_cell(c == '\n');
        } else if (c != '\r') {
            cell_ += c;
        }
    }
    void end_cell(bool and_line) {
        row_.push_back(std::move(cell_));
        cell_.clear();
        cells_ += and_line ? 3 : 1;  // an empty line takes as much memory as three cells
        check_size();
        if (!and_line) return;
        ++line_;
        rows_.push_back(std::move(row_));
        row_.clear();
    }
    /// Refuses a table that would use up all memory, since even a single comma makes a cell.
    void check_size() const {
        if (row_.size() <= kMostColumns && cells_ <= kMostCells) return;
        throw Error({file_, line_}, "",
                    row_.size() > kMostColumns
                        ? fmt::format("this line has more than {} cells", kMostColumns)
                        : fmt::format("from here on the table has more than {} cells", kMostCells),
                    "Check that it is the right file, or make it smaller.");
    }

    const std::string& text_;
    const std::string& file_;
    size_t at_ = 0;
    bool quoted_ = false;
    std::string cell_;
    std::vector<std::string> row_;
    std::vector<std::vector<std::string>> rows_;
    int line_ = 1;
    size_t cells_ = 0;
};

}  // namespace

std::vector<std::vector<std::string>> read_csv(const std::string& file) {
    const std::string text = read_text_file(file, kMostTable);
    auto rows = CsvParser(text, file).run();
    for (const auto& [separator, name] : {std::pair{';', "semicolons"}, std::pair{'\t', "tabs"}}) {
        if (!rows.empty() && rows[0].size() == 1 && rows[0][0].find(separator) != std::string::npos)
            throw Error({file, 1}, "",
                        fmt::format("is separated by {}: another program has saved it", name),
                        "Replace it with a backup; dihaptic recover rebuilds a session's tables "
                        "from raw.log.");
    }
    if (rows.empty()) {
        throw Error(
            {file, 0}, "", "is empty: even the line that names its columns is missing",
            "Replace it with a backup; dihaptic recover rebuilds a session's tables from raw.log.");
    }
    return rows;
}

CsvFile::CsvFile(const std::string& file) : file_(file), rows_(read_csv(file)) {
    header_ = std::move(rows_.front());
    rows_.erase(rows_.begin());
}

namespace {

/// Checks that no two columns have the same name. Otherwise, one of them would be ignored without
/// notice.
void check_names(const CsvFile& table) {
    std::set<std::string> seen;
    for (size_t i = 0; i < table.columns().size(); ++i) {
        const std::string& name = table.columns()[i];
        if (name.empty() || seen.insert(name).second) continue;
        throw Error(table.head(), shortened(name),
                    fmt::format("column {} repeats an earlier one", i + 1), "Keep one of the two.");
    }
}

}  // namespace

CsvFile CsvFile::given(const std::string& file, Diagnostics& diagnostics,
                       const std::function<void(const CsvFile&)>& check_columns) {
    const std::string text = read_text_file(file, kMostTable);
    GivenTable table(text, file);
    CsvFile out;
    out.file_ = file;
    auto cells = table.next();
    if (!cells) throw Error({file, 0}, "", "is empty", "Its first line names its columns.");
    if (cells->front().starts_with('#'))
        throw Error(table.place(), "", "starts with a comment (#), not with the columns' names",
                    "Delete this line.");
    out.head_ = table.place().line;
    out.header_ = std::move(*cells);
    check_columns(out);
    check_names(out);
    size_t read = 0;
    while ((cells = table.next())) {
        if (cells->size() != out.header_.size())
            throw Error(
                table.place(), "",
                fmt::format("has {}, but line {} names {}",
                            counted(static_cast<int64_t>(cells->size()), "value"), out.head_,
                            counted(static_cast<int64_t>(out.header_.size()), "column")),
                fmt::format("Complete it. Values are separated by {} here; put a value "
                            "with a decimal comma in quotes, or put semicolons between "
                            "all values.",
                            table.separators()));
        read += cells->size();
        if (read > kMostCells)
            throw Error(table.place(), "", "from here on the table is too large",
                        "Check that it is the right file, or make it smaller.");
        for (std::string& cell : *cells) {
            // so that all later code can read the number
            if (table.number(cell)) std::replace(cell.begin(), cell.end(), ',', '.');
        }
        out.lines_.push_back(table.place().line);
        out.rows_.push_back(std::move(*cells));
    }
    table.tell_commas(diagnostics);
    return out;
}

std::optional<size_t> CsvFile::column(const std::string& name) const {
    const auto found = std::find(header_.begin(), header_.end(), name);
    if (found == header_.end()) return std::nullopt;
    return static_cast<size_t>(found - header_.begin());
}

const std::string& CsvFile::text(size_t row, std::optional<size_t> column) const {
    static const std::string missing;
    return column && *column < rows_[row].size() ? rows_[row][*column] : missing;
}

double CsvFile::number(size_t row, std::optional<size_t> column) const {
    return any_number(text(row, column)).value_or(kUnmeasured);
}

}  // namespace dihaptic
