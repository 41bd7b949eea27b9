#include "analysis/recovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/field_table.h"
#include "base/regular_file.h"
#include "base/text.h"
#include "base/text_file.h"
#include "frame/settings.h"
#include "recording/raw_log.h"
#include "recording/seal.h"

namespace dihaptic::analysis {
namespace {

/// Whether the last line of the file is cut off.
bool is_cut(const std::string& file) {
    return is_there(file) && !read_bytes(file, kMostTable).ends_with('\n');
}

/// Rebuilds settings.csv from settings.yaml, keeping those origins that settings.csv still
/// contains.
void mend_settings(const recording::SessionFolder& folder, recording::SessionInfo& info,
                   Diagnostics& diagnostics) {
    frame::Settings settings;
    try {
        Diagnostics unreadable(UnknownKeys::are_left_out);
        read_fields(settings, read_yaml(folder.file("settings.yaml")), unreadable);
        unreadable.throw_if_errors();
    } catch (const Error&) {
        return;  // the fault is reported when the checksums of the inputs are checked
    }
    Table was;
    try {
        was = read_settings(folder);
        if (is_cut(folder.file("settings.csv")) && !was.rows.empty()) was.rows.pop_back();
    } catch (const Error&) {
        was.rows.clear();  // treat all rows as lost
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
                        fmt::format("is damaged or missing. It is rebuilt from settings.yaml; the "
                                    "origins of {} of {} settings are lost",
                                    lost, table.rows.size()),
                        "");
    write_csv(table, folder.file("settings.csv"));
    recording::unseal(info, "settings.csv");
}

/// Whether a YAML text contains a control character or an escape sequence (which may stand for
/// one). Large files are parsed only in this case.
bool may_have_control_characters(const std::string& text) {
    return find_fault(text) || text.find('\\') != std::string::npos;
}

/// Returns the readable text of a session file that cannot be read because of invalid characters;
/// nullopt if the file has another fault.
std::optional<std::string> mended_text(const std::string& file) {
    const bool yaml = file.ends_with(".yaml");
    const int64_t most = yaml ? kMostYaml : kMostTable;
    try {
        if (!yaml) {
            read_text_file(file, most);
        } else if (may_have_control_characters(read_bytes(file, most))) {
            read_yaml(file);
        }
        return std::nullopt;
    } catch (const Error&) {
    }
    try {
        const std::string text = mended(read_bytes(file, most));
        if (!yaml) return text;
        const char* const end =
            text.ends_with("...\n") ? "...\n" : "";  // last line of session.yaml
        return to_yaml(parse_yaml(text, file, Words::mended)) + end;
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// Copies a file that is about to be rebuilt to the first free name of the form FILE.before,
/// FILE.before-2 and so on, and returns that name.
std::string keep_before(const std::string& file) {
    std::string name = file + ".before";
    for (int n = 2; is_there(name); ++n) name = fmt::format("{}.before-{}", file, n);
    write_file(read_bytes(file, kMostTable), name);
    return std::filesystem::path(name).filename().string();
}

/// Returns the contents of session.yaml or, if it cannot be read, as much as can be known without
/// it. A copy of an unreadable file is kept.
recording::SessionInfo read_or_mend_info(const recording::SessionFolder& folder,
                                         const recording::Setup& setup, Diagnostics& diagnostics) {
    Diagnostics unreadable;
    recording::SessionInfo info = folder.read_info(setup, unreadable);
    for (Problem problem : unreadable.problems()) {
        if (is_there(problem.place.file))
            problem.remedy += " " + keep_before(problem.place.file) + " is the old file.";
        diagnostics.add({problem});
    }
    return info;
}

/// Replaces the control characters and invalid bytes that versions before 0.3 allowed in a
/// session's files. Returns the repaired files, with their previous checksums.
std::vector<recording::InputFile> mend_texts(const recording::SessionFolder& folder,
                                             Diagnostics& diagnostics) {
    std::vector<recording::InputFile> out;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        const std::string kind = entry.path().extension().string();
        if (!entry.is_regular_file() || (kind != ".yaml" && kind != ".csv")) continue;
        const std::string name = entry.path().filename().string();
        const std::string file = folder.file(name);
        if (const auto text = mended_text(file)) {
            out.push_back(folder.input(name));
            const std::string before = keep_before(file);
            write_file(*text, file);
            diagnostics.warning(
                {file, 0}, "",
                "contained control characters, or bytes that are not UTF-8 text. They "
                "have been replaced by U+FFFD; " +
                    before + " is the old file",
                "If you know the original characters, insert them and recover the "
                "session again, which rebuilds its tables.");
        }
    }
    return out;
}

/// Updates the checksums of repaired input files, if the files matched the recording before the
/// repair.
void renew(std::vector<recording::InputFile>& inputs,
           const std::vector<recording::InputFile>& before,
           const recording::SessionFolder& folder) {
    for (recording::InputFile& input : inputs) {
        for (const recording::InputFile& was : before) {
            if (was.file == input.file && was.checksum == input.checksum)
                input = folder.input(was.file);
        }
    }
}

}  // namespace

Recovery recover_session(const recording::SessionFolder& folder,
                         const std::function<void(double)>& progress) {
    const recording::SessionLock lock(folder);
    const recording::RawLogReader log(folder.raw_log());
    Recovery out;
    Diagnostics diagnostics;
    const std::vector<recording::InputFile> before = mend_texts(folder, diagnostics);
    out.info = read_or_mend_info(folder, log.head(), diagnostics);
    renew(out.info.inputs, before, folder);
    // raw.log is more reliable than a session.yaml that was changed
    if (!recording::broken_own_seal(folder, out.info, Severity::warning).empty() &&
        !log.head().seed.empty())
        out.info.seed = log.head().seed;
    out.had_ended = out.info.state != recording::SessionState::running;
    const bool mended = !diagnostics.problems().empty();
    if (!out.had_ended || mended) out.info.state = recording::SessionState::recovered;
    diagnostics.add(folder.changed(out.info.inputs, Severity::warning));
    diagnostics.add(recording::broken_for_good(folder, out.info, Severity::warning));
    mend_settings(folder, out.info, diagnostics);
    out.warnings = diagnostics.problems();
    for (const Problem& warning : out.warnings) add_note(out.info, warning.text());
    out.figures = finish_session(folder, out.info, progress);
    return out;
}

}  // namespace dihaptic::analysis
