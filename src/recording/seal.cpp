#include "recording/seal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/checksum.h"
#include "base/plural.h"
#include "base/regular_file.h"
#include "base/shell_word.h"
#include "base/text_file.h"

namespace dihaptic::recording {
namespace {

constexpr std::string_view kMade[] = {"trials.csv", "phases.csv",      "episodes.csv", "lifts.csv",
                                      "events.csv", "corrections.csv", "fault.csv"};
/// Tables written before the first tick or while the session ran.
constexpr std::string_view kGiven[] = {"procedures.csv", "trials-before.csv", "movement-faults.csv",
                                       "settings.csv",   "shown.csv",         "head.csv",
                                       "heard.csv",      "notes.csv"};
/// Every session has this table, but versions before 0.3 did not seal it.
constexpr std::string_view kSealedLater = "settings.csv";

/// Number of rows in a CSV file, not counting the header; a quoted cell may span several lines.
int rows_of(std::string_view csv) {
    int lines = 0;
    bool quoted = false;
    for (const char c : csv) {
        quoted = quoted != (c == '"');
        if (c == '\n' && !quoted) ++lines;
    }
    if (!csv.empty() && !csv.ends_with('\n')) ++lines;
    return std::max(0, lines - 1);
}

/// Computes the seal of a table. Throws Error when the file cannot be read.
TableSeal seal_of(const SessionFolder& folder, const std::string& name) {
    const std::string csv = read_bytes(folder.file(name), kMostTable);
    return {name, rows_of(csv), checksum_of(csv)};
}

const TableSeal* find(const SessionInfo& info, std::string_view name) {
    const auto found = std::ranges::find(info.tables, name, &TableSeal::file);
    return found == info.tables.end() ? nullptr : &*found;
}

/// Computes the seal of session.yaml itself.
std::string seal_of(const SessionInfo& info) {
    std::string all = fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n", info.identity, info.participant.id,
                                  info.seed, info.program, enum_name(info.state), info.ticks);
    for (const InputFile& input : info.inputs)
        all += fmt::format("{} {}\n", input.file, input.checksum);
    for (const TableSeal& table : info.tables)
        all += fmt::format("{} {} {}\n", table.file, table.rows, table.checksum);
    return checksum_of(all);
}

std::string remedy_for(const SessionFolder& folder, bool can_be_made) {
    if (can_be_made && is_there(folder.raw_log()))
        return "Rebuild it from raw.log: dihaptic recover " + shell_file(folder.path());
    return "Restore it from a backup. If there is none, the session has to be repeated; if a "
           "simulated person took part, remove the folder and repeat the rehearsal's command.";
}

/// Describes what is wrong with a table; "" if it is intact.
std::string fault_of(const SessionFolder& folder, std::string_view name, const TableSeal* sealed) {
    const std::string file(name);
    const bool there = is_there(folder.file(file));
    if (sealed == nullptr)
        return there && name != kSealedLater
                   ? "did not exist when the session ended: it belongs to something else"
                   : "";
    const std::string then =
        fmt::format("it had {} when the session ended", counted(sealed->rows, "row"));
    if (!there) return "is gone: " + then;
    try {
        const TableSeal now = seal_of(folder, file);
        if (now.checksum == sealed->checksum) return "";
        if (now.rows != sealed->rows)
            return fmt::format("has {}; {}", counted(now.rows, "row"), then);
        return fmt::format("has been changed since the session ended (it still has {})",
                           counted(now.rows, "row"));
    } catch (const Error& e) {
        return e.problems().front().what + "; " + then;
    }
}

void add_faults(std::vector<Problem>& out, const SessionFolder& folder, const SessionInfo& info,
                Severity severity, std::span<const std::string_view> names, bool can_be_made) {
    for (const std::string_view name : names) {
        const std::string fault = fault_of(folder, name, find(info, name));
        if (fault.empty()) continue;
        out.push_back({severity,
                       {folder.file(std::string(name)), 0},
                       "",
                       fault,
                       remedy_for(folder, can_be_made)});
    }
}

}  // namespace

std::vector<std::string> tables_from_log() {
    return {std::begin(kMade), std::end(kMade)};
}

std::vector<std::string> other_tables() {
    return {std::begin(kGiven), std::end(kGiven)};
}

void seal(const SessionFolder& folder, SessionInfo& info) {
    std::vector<TableSeal> tables;
    for (const std::string_view name : kMade) {
        const std::string file(name);
        if (is_there(folder.file(file))) tables.push_back(seal_of(folder, file));
    }
    for (const std::string_view name : kGiven) {
        const std::string file(name);
        if (const TableSeal* before = find(info, name)) {
            tables.push_back(*before);
        } else if (is_there(folder.file(file))) {
            tables.push_back(seal_of(folder, file));
        }
    }
    constexpr const char* kNwb = "session.nwb";
    if (is_there(folder.file(kNwb)))
        tables.push_back({kNwb, info.ticks, folder.input(kNwb).checksum});
    info.tables = std::move(tables);
    info.seal = seal_of(info);
}

void unseal(SessionInfo& info, std::string_view name) {
    std::erase_if(info.tables, [&](const TableSeal& table) { return table.file == name; });
}

bool is_sealed(const SessionInfo& info) {
    return !info.seal.empty() || !info.tables.empty();
}

std::vector<Problem> broken_own_seal(const SessionFolder& folder, const SessionInfo& info,
                                     Severity severity) {
    if (!is_sealed(info) || seal_of(info) == info.seal) return {};
    const std::string again =
        "Restore the old version; if it was changed on purpose, seal it again: dihaptic recover ";
    return {{severity,
             {folder.file("session.yaml"), 0},
             "seal",
             "does not match: the session's identity, participant, seed, program, state, ticks, "
             "inputs or list of tables has been changed since it ended",
             is_there(folder.raw_log()) ? again + shell_file(folder.path())
                                        : remedy_for(folder, false)}};
}

std::vector<Problem> broken_seals(const SessionFolder& folder, const SessionInfo& info,
                                  Severity severity, std::span<const std::string_view> only) {
    if (!is_sealed(info)) return {};
    std::vector<Problem> out = broken_own_seal(folder, info, severity);
    const auto matters = [&](std::string_view name) {
        return only.empty() || std::ranges::find(only, name) != only.end();
    };
    const auto those_of = [&](std::span<const std::string_view> names) {
        std::vector<std::string_view> some;
        std::ranges::copy_if(names, std::back_inserter(some), matters);
        return some;
    };
    add_faults(out, folder, info, severity, those_of(kMade), true);
    add_faults(out, folder, info, severity, those_of(kGiven), false);
    return out;
}

std::vector<Problem> broken_for_good(const SessionFolder& folder, const SessionInfo& info,
                                     Severity severity) {
    std::vector<Problem> out;
    if (is_sealed(info)) add_faults(out, folder, info, severity, kGiven, false);
    return out;
}

}  // namespace dihaptic::recording
