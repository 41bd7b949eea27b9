#include "session_tables.h"

#include "analysis/dictionary.h"
#include "analysis/report/session_page.h"
#include "base/regular_file.h"
#include "recording/moved_by.h"

namespace dihaptic::cli {

std::vector<TextTable> tables_of(const std::string& session) {
    std::vector<TextTable> out;
    const auto folder = recording::SessionFolder::open_tables(session);
    for (const char* name : {"trials.csv", "lifts.csv", "corrections.csv"}) {
        const std::string file = session + "/" + name;
        if (!is_there(file)) continue;
        auto rows = read_csv(file);
        out.push_back({name, analysis::described_columns(folder, name, rows.front()), {}});
        rows.erase(rows.begin());
        out.back().rows = std::move(rows);
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
