#include "session_tables.h"

#include "analysis/dictionary.h"
#include "analysis/report/session_page.h"
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
    const auto data = analysis::SessionData::read(session);
    const auto page = analysis::session_page(data, "", [](double) {});
    const auto add = [&](const char* name, const Table& table) {
        if (!table.rows.empty())
            out.push_back(text_of(recording::marked(table, data.info.moved_by), name));
    };
    add("adaptation.csv", page.adaptation);
    add("fits.csv", page.fits);
    add("thresholds.csv", page.thresholds);
    return out;
}

}  // namespace dihaptic::cli
