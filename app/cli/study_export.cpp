#include "study_export.h"

#include <fmt/format.h>

#include <filesystem>

#include "analysis/bids.h"
#include "analysis/psych_ds.h"
#include "base/plural.h"
#include "base/regular_file.h"
#include "common/console.h"

namespace dihaptic::cli {
namespace {

void tell_missing(const StudySessions& sessions) {
    for (const std::string& text : sessions.missing()) fmt::print("{}\n", text);
}

/// Throws Error when the motion recording is missing, as in a rehearsal that keeps only tables.
void check_recording(const std::string& folder, const StudyData& data) {
    if (is_there(folder + "/raw.log")) return;
    throw Error({folder, 0}, "", "has no recording of the motion: raw.log is missing",
                data.rehearsed.empty()
                    ? "Restore it, or export the tables alone: --psych-ds."
                    : "Rehearse the study again: dihaptic rehearse STUDY --keep-recordings --out "
                      "FOLDER. Or export the tables alone: --psych-ds.");
}

/// Adds a recording unless the data set already contains it. Returns the number of recordings
/// added.
size_t add(const std::string& folder, const std::string& data_set,
           const std::function<void(double)>& progress) {
    const auto session = recording::SessionFolder::open(folder);
    if (analysis::is_exported(session, data_set)) return 0;
    try {
        const analysis::Exported exported = analysis::export_bids(session, data_set, progress);
        print(exported.changed);
        for (const std::string& what : exported.log) fmt::print("{}: raw.log: {}\n", folder, what);
        return 1;
    } catch (const Error&) {
        if (!analysis::is_exported(session, data_set)) throw;
        return 0;  // another program has just added the recording
    }
}

}  // namespace

void export_bids(const StudyData& data, const std::string& data_set) {
    const study::StudyFile study = study_of(data);
    const StudySessions sessions(study);
    size_t added = 0;
    double done = 0;
    for (const CompleteSession& complete : sessions.complete()) {
        const double all = static_cast<double>(sessions.complete().size());
        for (const std::string& part : complete.parts) {
            check_recording(part, data);
            ProgressLine line("adding sessions");
            added +=
                add(part, data_set, [&](double share) { line.show_or_stop((done + share) / all); });
        }
        ++done;
    }
    tell_missing(sessions);
    fmt::print("{} added to {}; the study has {} of {} people\n",
               counted(static_cast<int64_t>(added), "recording"), data_set,
               counted(static_cast<int64_t>(sessions.complete().size()), "session"),
               sessions.roster().participants.size());
}

void export_psych_ds(const StudyData& data, const std::string& folder) {
    const study::StudyFile study = study_of(data);
    const StudySessions sessions(study);
    analysis::PsychDs out;
    out.study = std::filesystem::path(data.file).stem().string();
    out.title = study.title;
    out.description =
        study.about.empty() ? "Tables of the study " + study.title + "." : study.about;
    out.program = recording::program_version();
    for (const CompleteSession& complete : sessions.complete()) {
        const auto info = recording::SessionFolder::open_tables(complete.folder).read_info();
        out.simulated |= info.moved_by.simulated() == "yes";
        if (out.authors.empty()) out.authors = info.study.experimenters;
    }
    out.tables = tables_of(study, sessions, data);
    const std::vector<std::string> files = analysis::write_psych_ds(out, folder);
    note_revealed(study, data, folder);
    tell_missing(sessions);
    std::string names;
    for (const std::string& name : files) names += (names.empty() ? "" : ", ") + name;
    fmt::print("{} of {} people: in {}/data: {}\n",
               counted(static_cast<int64_t>(sessions.complete().size()), "session"),
               sessions.roster().participants.size(), folder, names);
}

}  // namespace dihaptic::cli
