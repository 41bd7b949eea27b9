#include "session_tables.h"

#include "analysis/dictionary.h"
#include "analysis/report/session_tables.h"
#include "base/regular_file.h"
#include "recording/moved_by.h"

namespace dihaptic::cli {

std::optional<TextTable> table_of(const std::string& session, const char* name) {
    const std::string file = session + "/" + name;
    if (!is_there(file)) return std::nullopt;
    const auto folder = recording::SessionFolder::open_tables(session);
    auto rows = read_csv(file);
    TextTable out{name, analysis::described_columns(folder, name, rows.front()), {}};
    rows.erase(rows.begin());
    out.rows = std::move(rows);
    return out;
}

std::vector<TextTable> tables_of(const std::string& session) {
    std::vector<TextTable> out;
    for (const char* name : {"trials.csv", "lifts.csv", "corrections.csv"}) {
        if (auto table = table_of(session, name)) out.push_back(std::move(*table));
    }
    const analysis::FittedSession fitted(analysis::SessionData::read(session));
    const analysis::SessionTables made = analysis::session_tables(fitted);
    const auto add = [&](const char* name, const Table& table) {
        if (!table.rows.empty())
            out.push_back(text_of(recording::marked(table, fitted.data.info.moved_by), name));
    };
    add("adaptation.csv", made.adaptation);
    add("fits.csv", made.fits);
    add("thresholds.csv", made.thresholds);
    return out;
}

}  // namespace dihaptic::cli
