#include "base/text_table.h"

namespace dihaptic {

TextTable text_of(const Table& table, const std::string& name) {
    TextTable out{name, table.columns, {}};
    for (const auto& row : table.rows) {
        out.rows.emplace_back();
        for (const Table::Cell& cell : row) {
            const auto* text = std::get_if<std::string>(&cell);
            out.rows.back().push_back(text != nullptr ? *text : to_csv(cell));
        }
    }
    return out;
}

std::string to_csv(const TextTable& table) {
    std::string out;
    for (size_t i = 0; i < table.columns.size(); ++i)
        out += (i == 0 ? "" : ",") + to_csv(Table::Cell(table.columns[i].name));
    out += "\n";
    for (const auto& row : table.rows) {
        for (size_t i = 0; i < row.size(); ++i)
            out += (i == 0 ? "" : ",") + to_csv(Table::Cell(row[i]));
        out += "\n";
    }
    return out;
}

}  // namespace dihaptic
