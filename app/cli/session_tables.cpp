#include "session_tables.h"

#include "analysis/report/session_page.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "recording/moved_by.h"

namespace dihaptic::cli {

Rows text_of(const Table& table) {
    if (table.rows.empty()) return {};
    Rows out(1);
    for (const Table::Column& column : table.columns) out[0].push_back(column.name);
    for (const auto& row : table.rows) {
        out.emplace_back();
        for (const Table::Cell& cell : row) {
            const auto* text = std::get_if<std::string>(&cell);
            out.back().push_back(text != nullptr ? *text : to_csv(cell));
        }
    }
    return out;
}

std::vector<std::pair<std::string, Rows>> tables_of(const std::string& session) {
    std::vector<std::pair<std::string, Rows>> out;
    for (const char* name : {"trials.csv", "lifts.csv"}) {
        const std::string file = session + "/" + name;
        if (is_there(file)) out.emplace_back(name, read_csv(file));
    }
    const auto data = analysis::SessionData::read(session);
    const auto page = analysis::session_page(data, "", [](double) {});
    const auto add = [&](const char* name, const Table& table) {
        out.emplace_back(name, text_of(recording::marked(table, data.info.moved_by)));
    };
    add("adaptation.csv", page.adaptation);
    add("fits.csv", page.fits);
    add("thresholds.csv", page.thresholds);
    return out;
}

void write_rows(const Rows& rows, const std::string& file) {
    std::string text;
    for (const auto& row : rows) {
        for (size_t i = 0; i < row.size(); ++i)
            text += (i == 0 ? "" : ",") + to_csv(Table::Cell(row[i]));
        text += "\n";
    }
    write_file(text, file);
}

}  // namespace dihaptic::cli
