#include "analysis/recovery.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/field_table.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "recording/raw_log.h"
#include "servo/settings.h"

namespace dihaptic::analysis {
namespace {

/// Whether the file's last line is cut off.
bool is_cut(const std::string& file) {
    return is_there(file) && !read_bytes(file, kMostTable).ends_with('\n');
}

/// Makes settings.csv anew from settings.yaml, with the origins that settings.csv still has.
void mend_settings(const recording::SessionFolder& folder, Diagnostics& diagnostics) {
    servo::Settings settings;
    try {
        Diagnostics unreadable(UnknownKeys::are_left_out);
        read_fields(settings, read_yaml(folder.file("settings.yaml")), unreadable);
        unreadable.throw_if_errors();
    } catch (const Error&) {
        return;  // reported with the inputs' checksums
    }
    Table was;
    try {
        was = read_settings(folder);
        if (is_cut(folder.file("settings.csv")) && !was.rows.empty()) was.rows.pop_back();
    } catch (const Error&) {
        was.rows.clear();  // all of it is lost
    }
    Table table = list_fields(settings, {});
    size_t lost = 0;
    for (auto& row : table.rows) {
        const auto same = [&](const auto& old) { return old[0] == row[0] && old[1] == row[1]; };
        const auto found = std::find_if(was.rows.begin(), was.rows.end(), same);
        const bool known = found != was.rows.end() && !std::get<std::string>((*found)[2]).empty();
        row[2] = known ? (*found)[2] : Table::Cell("not known");
        if (!known) ++lost;
    }
    if (lost == 0) return;
    diagnostics.warning({folder.file("settings.csv"), 0}, "",
                        fmt::format("is damaged or gone. It is made anew from settings.yaml; where "
                                    "{} of {} settings came from is not known any more",
                                    lost, table.rows.size()),
                        "");
    write_csv(table, folder.file("settings.csv"));
}

}  // namespace

Recovery recover_session(const recording::SessionFolder& folder,
                         const std::function<void(double)>& progress) {
    const recording::SessionLock lock(folder);
    const recording::RawLogReader log(folder.raw_log());
    Recovery out;
    Diagnostics diagnostics;
    out.info = folder.read_info(log.head(), diagnostics);
    out.had_ended = out.info.state != recording::SessionState::running;
    const bool mended = !diagnostics.problems().empty();
    if (!out.had_ended || mended) out.info.state = recording::SessionState::recovered;
    diagnostics.add(folder.changed(log.head().inputs, Severity::warning));
    mend_settings(folder, diagnostics);
    out.warnings = diagnostics.problems();
    for (const Problem& warning : out.warnings) add_note(out.info, warning.text());
    out.figures = finish_session(folder, out.info, progress);
    return out;
}

}  // namespace dihaptic::analysis
