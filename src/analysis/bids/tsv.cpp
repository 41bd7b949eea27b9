#include "analysis/bids/tsv.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "base/diagnostics.h"
#include "base/output.h"
#include "base/regular_file.h"
#include "base/table.h"
#include "base/text_file.h"

namespace dihaptic::analysis::bids {
namespace {

std::string cell(std::string text) {
    if (text.empty()) return "n/a";
    for (char& c : text) {
        if (c == '\t' || c == '\n' || c == '\r') c = ' ';
    }
    return text;
}

Row split(const std::string& line) {
    Row row;
    for (size_t at = 0; at <= line.size();) {
        const size_t end = std::min(line.find('\t', at), line.size());
        row.push_back(line.substr(at, end - at));
        at = end + 1;
    }
    return row;
}

}  // namespace

std::string to_tsv(const std::vector<Row>& rows) {
    std::string out;
    for (const Row& row : rows) {
        for (size_t i = 0; i < row.size(); ++i) out += (i > 0 ? "\t" : "") + cell(row[i]);
        out += "\n";
    }
    return out;
}

Tsv::Tsv(const std::string& file, const std::string& key) : file_(file), columns_{key} {
    if (!is_there(file)) return;
    std::istringstream in(read_text_file(file, kMostTable));
    int number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        if (line.ends_with('\r')) line.pop_back();
        if (number == 1) {
            columns_ = split(line);
            if (columns_.front() == key) continue;
            throw Error({file, 1}, columns_.front(), "is its first column, but BIDS expects " + key,
                        "Put that column first, or name another folder.");
        }
        if (line.empty()) continue;
        rows_.push_back(split(line));
        if (rows_.back().size() == columns_.size()) continue;
        throw Error({file, number}, "",
                    fmt::format("has {} cells, but its header has {}", rows_.back().size(),
                                columns_.size()),
                    "Repair the line: one cell per column, separated by tabs.");
    }
}

size_t Tsv::find(const std::string& key) const {
    const auto same = [&](const Row& row) { return row.front() == key; };
    return static_cast<size_t>(std::find_if(rows_.begin(), rows_.end(), same) - rows_.begin());
}

size_t Tsv::column(const std::string& name) const {
    return static_cast<size_t>(std::find(columns_.begin(), columns_.end(), name) -
                               columns_.begin());
}

std::string Tsv::text(size_t row, const std::string& name) const {
    const size_t place = column(name);
    if (row >= rows_.size() || place >= columns_.size() || rows_[row][place] == "n/a") return "";
    return rows_[row][place];
}

std::string Tsv::text(const std::string& key, const std::string& name) const {
    return text(find(key), name);
}

void Tsv::put(const std::vector<std::string>& columns, const Row& cells) {
    for (const std::string& name : columns) {
        if (column(name) < columns_.size()) continue;
        columns_.push_back(name);
        for (Row& row : rows_) row.emplace_back("n/a");
    }
    const size_t at = find(cells.front());
    if (at == rows_.size()) rows_.emplace_back(columns_.size(), "n/a");
    for (size_t i = 0; i < columns.size(); ++i) rows_[at][column(columns[i])] = cell(cells[i]);
}

void Tsv::write() const {
    std::vector<Row> all{columns_};
    all.insert(all.end(), rows_.begin(), rows_.end());
    remove_dead_parts(file_);  // left behind by an interrupted export
    write_file(to_tsv(all), file_);
}

}  // namespace dihaptic::analysis::bids
