#include "analysis/bids/data_set.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "analysis/bids/motion.h"
#include "analysis/bids/tsv.h"
#include "base/number.h"
#include "base/output.h"
#include "base/regular_file.h"
#include "base/text_file.h"
#include "rows/event_row.h"

namespace dihaptic::analysis::bids {
namespace {

/// Writes the file. Also removes an unfinished file that an interrupted export left behind.
void write_anew(const std::string& text, const std::string& file) {
    remove_dead_parts(file);
    write_file(text, file);
}

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
constexpr const char* kHedVersion = "HEDVersion";
constexpr const char* kSimulated = "Simulated";  // true or false in dataset_description.json

/// Whether dataset_description.json states that the data are simulated. Nullopt if it does not say,
/// as in files from earlier versions or other programs.
std::optional<bool> says_simulated(const std::string& file) {
    const Json json = Json::parse(read_text_file(file), nullptr, false);
    if (json.is_discarded() || !json.is_object()) {
        throw Error({file, 0}, "", "is not a JSON object", "Repair it, or name another folder.");
    }
    if (!json.contains(kSimulated) || !json[kSimulated].is_boolean()) return std::nullopt;
    return json[kSimulated].get<bool>();
}

std::string readme(const std::string& title, const std::string& program, bool simulated) {
    const std::string who =
        simulated ? "THIS DATA SET IS A SIMULATION. No person took part in it: the hand was moved "
                    "by a\nsimulated person, a script or a recorded movement, as the column "
                    "moved_by of\nparticipants.tsv states.\n"
                  : "Persons took part in it, at force-feedback devices, or by mouse at simulated "
                    "ones, as\nthe column moved_by of participants.tsv states.\n";
    return title + "\n\n" + who +
           "\nEach run contains the motion of each finger as a separate tracking system: the "
           "device's handle,\nthe finger in the virtual world (proxy), the force on the handle and "
           "the force of the touched\nbodies. The tracking system `objects` contains the virtual "
           "objects that can move. All are in the\nworld's axes: x to the right, y away from the "
           "person, z up, origin on the table top; in SI\nunits. Rows without a recording after "
           "damage are left out: the LATENCY column has each row's\ntime.\n\nevents.tsv has a row "
           "for each attempt at a trial (trial_type `trial`), with its block,\ncondition, "
           "perturbation, outcome and measures, and a row for each moment: phases, "
           "touches,\nmessages, markers, outcomes. events.json describes each column.\n\nAuthors, "
           "licence and funding are in dataset_description.json as far as they are "
           "known:\ncomplete them before you share the data.\n\nMade by " +
           program + " with `dihaptic export`.\n";
}

const Json kParticipantColumns{
    {"participant_id", {{"Description", "label of the participant"}}},
    {"participant", {{"Description", "identifier in the recorded sessions"}}},
    {"age", {{"Description", "of the participant"}, {"Units", "years"}}},
    {"sex",
     {{"Description", "as told"},
      {"Levels", {{"F", "female"}, {"M", "male"}, {"O", "other"}, {"U", "not stated"}}}}},
    {"handedness",
     {{"Description", "as told"},
      {"Levels", {{"right", "right-handed"}, {"left", "left-handed"}, {"both", "ambidextrous"}}}}},
    {"group", {{"Description", "group of the study, or the code that conceals it"}}},
    {"simulated",
     {{"Description", "whether no person took part"},
      {"Levels", {{"yes", "no person took part"}, {"no", "a person took part"}}}}},
    {"moved_by",
     {{"Description",
       "source of the hand's movement; if runs differ, all sources, separated by commas"},
      {"Levels",
       {{"devices", "a person held the devices"},
        {"mouse", "a person moved simulated devices by mouse"},
        {"recorded_movement", "a recording pulled the fingers of simulated devices"},
        {"script", "a script moved simulated devices"},
        {"simulated_person", "a model of a person moved simulated devices"}}}}},
    {"program", {{"Description", "program that simulated the person"}}},
    {"population", {{"Description", "population from which the simulated person was drawn"}}},
    {"seed", {{"Description", "seed with which the person was drawn"}}}};

/// Name of the column in participants.tsv for a fact that the study defines.
std::string column_of(const recording::Fact& fact) {
    return kParticipantColumns.contains(fact.name) ? "fact_" + fact.name : fact.name;
}

/// Adds an item to the comma-separated list in a cell, unless the list already contains the item.
std::string with(const std::string& list, const std::string& item) {
    if (item.empty() || ("," + list + ",").find("," + item + ",") != std::string::npos) return list;
    return list.empty() ? item : list + "," + item;
}

}  // namespace

Lock::Lock(const std::string& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    // on a file system without locks, flock() fails and the export continues without a lock
    if (descriptor_) ::flock(descriptor_.get(), LOCK_EX);
}

DataSet::DataSet(std::string folder, const recording::SessionFolder& session,
                 const recording::SessionInfo& info)
    : folder_(std::move(folder)),
      session_(session),
      info_(info),
      subject_("sub-" + label(info.participant.id.empty() ? "unknown" : info.participant.id)),
      visit_(info.in_study ? "ses-" + label(info.in_study->session) : "") {}

std::string DataSet::scans() const {
    return file(place() + "/" + stem() + "_scans.tsv");
}

void DataSet::check() const {
    check_kind();
    check_participant();
    check_recordings();
}

void DataSet::check_kind() const {
    const std::string description = file("dataset_description.json");
    if (!is_there(description)) return;
    const std::optional<bool> there = says_simulated(description);
    const bool simulated = info_.moved_by.simulated() == "yes";
    if (there == simulated || (!there && !simulated)) return;
    throw Error({description, 0}, kSimulated,
                simulated
                    ? "does not state that the data set is a simulation, but this session is one"
                    : "states that the data set is a simulation, but this session is not one",
                "Name another folder: simulations and persons have separate data sets.");
}

void DataSet::check_participant() const {
    const std::string name = file("participants.tsv");
    const Tsv people(name, "participant_id");
    const auto same = [&](const char* column, const std::string& here, const char* what) {
        const std::string there = people.text(subject_, column);
        if (there.empty() || here.empty() || there == here) return;
        throw Error(
            {name, 0}, subject_,
            fmt::format("is {} {} in the data set, but {} in this session", what, there, here),
            "Name another folder, or give one of them another identifier: BIDS labels have letters "
            "and digits only.");
    };
    same("participant", info_.participant.id, "participant");
    same("population", info_.moved_by.population, "of population");
    same("seed", info_.moved_by.seed, "of seed");
}

std::string DataSet::recording_there() const {
    const Tsv scans_table(scans(), "filename");
    const std::string own = fs::path(session_.path()).filename().string();
    for (size_t i = 0; i < scans_table.rows(); ++i) {
        const std::string recording = scans_table.text(i, "filename");
        // data sets made by earlier versions contain no session identities
        const std::string identity = scans_table.text(i, "identity");
        const bool same =
            identity.empty() ? scans_table.text(i, "session") == own : identity == info_.identity;
        if (same && is_there(file(place() + "/" + recording))) return recording;
    }
    return "";
}

void DataSet::check_recordings() const {
    const std::string there = recording_there();
    if (there.empty()) return;
    throw Error({scans(), 0}, fs::path(session_.path()).filename().string(),
                "is in the data set: " + there,
                "Export another session, or remove this one from the data set first.");
}

void DataSet::describe() const {
    const bool simulated = info_.moved_by.simulated() == "yes";
    const std::string title = info_.in_study ? info_.in_study->study : info_.title;
    if (const std::string name = file("dataset_description.json"); !is_there(name)) {
        const size_t blank = info_.program.find(' ');
        Json json{{"Name", simulated ? "Simulation: " + title : title},
                  {"BIDSVersion", "1.9.0"},
                  {kHedVersion, rows::kHedSchema},
                  {"DatasetType", "raw"},
                  {"GeneratedBy", Json::array({{{"Name", info_.program.substr(0, blank)},
                                                {"Version", blank == std::string::npos
                                                                ? "unknown"
                                                                : info_.program.substr(blank + 1)},
                                                {"Description", info_.moved_by.describe()}}})}};
        if (info_.moved_by.known()) json[kSimulated] = simulated;
        if (!info_.study.experimenters.empty()) json["Authors"] = info_.study.experimenters;
        if (!info_.study.keywords.empty()) json["Keywords"] = info_.study.keywords;
        write_anew(json.dump(2) + "\n", name);
    } else {
        add_hed_version();
    }
    if (!is_there(file("README")) && !is_there(file("README.md")))
        write_anew(readme(title, info_.program, simulated), file("README"));
    describe_participants();
}

/// A later session may bring facts that earlier sessions lacked.
void DataSet::describe_participants() const {
    const std::string name = file("participants.json");
    const bool there = is_there(name);
    Json columns = there ? Json::parse(read_text_file(name), nullptr, false) : kParticipantColumns;
    if (!columns.is_object()) return;  // the file comes from another program, or is damaged
    const Json before = columns;
    if (info_.in_study) {
        for (const recording::Fact& fact : info_.in_study->facts) {
            const std::string column = column_of(fact);
            if (!columns.contains(column))
                columns[column] = {{"Description", "fact about the participant, from the study"}};
        }
    }
    if (!there || columns != before) write_anew(columns.dump(2) + "\n", name);
}

/// Data sets made by earlier versions or by other programs have no HED tags.
void DataSet::add_hed_version() const {
    const std::string name = file("dataset_description.json");
    Json json = Json::parse(read_text_file(name), nullptr, false);
    if (json.contains(kHedVersion)) return;
    json[kHedVersion] = rows::kHedSchema;
    write_anew(json.dump(2) + "\n", name);
}

void DataSet::add_participant() const {
    Tsv people(file("participants.tsv"), "participant_id");
    const recording::Participant& p = info_.participant;
    const recording::MovedBy& by = info_.moved_by;
    std::vector<std::string> columns{"participant_id", "age",       "sex",     "handedness",
                                     "participant",    "simulated", "moved_by"};
    Row row{subject_,
            p.age,
            p.sex,
            p.handedness,
            p.id,
            by.simulated(),
            with(people.text(subject_, "moved_by"), by.name())};
    if (by.mover == recording::Mover::simulated_person) {
        columns.insert(columns.end(), {"program", "population", "seed"});
        row.insert(row.end(), {by.program, by.population, by.seed});
    }
    if (info_.in_study) {
        columns.emplace_back("group");
        row.push_back(info_.in_study->group);
        for (const recording::Fact& fact : info_.in_study->facts) {
            columns.push_back(column_of(fact));
            row.push_back(fact.value);
        }
    }
    if (people.has(subject_)) {
        // facts already stated about a participant are kept; only missing facts are added
        for (size_t i = 1; i < columns.size(); ++i) {
            const std::string there = people.text(subject_, columns[i]);
            if (columns[i] != "moved_by" && !there.empty()) row[i] = there;
        }
    }
    people.put(columns, row);
    people.write();
}

void DataSet::add_visit() const {
    Tsv visits(file(subject_ + "/" + subject_ + "_sessions.tsv"), "session_id");
    visits.put({"session_id", "acq_time", "condition", "study_version"},
               {visit_, info_.started.substr(0, 19), info_.in_study->condition,
                number_text(info_.in_study->version)});
    visits.write();
    const Json columns{
        {"condition", {{"Description", "condition of the session in the study"}}},
        {"study_version", {{"Description", "version of the study's files, from 1"}}}};
    const std::string json = file(subject_ + "/" + subject_ + "_sessions.json");
    if (!is_there(json)) write_anew(columns.dump(2) + "\n", json);
}

void DataSet::add(const std::vector<std::string>& recordings) const {
    describe();
    add_participant();
    if (info_.in_study) add_visit();
    Tsv table(scans(), "filename");
    for (const std::string& name : recordings) {
        table.put({"filename", "acq_time", "session", "identity", "simulated", "moved_by"},
                  {name, info_.started.substr(0, 19), fs::path(session_.path()).filename().string(),
                   info_.identity, info_.moved_by.simulated(), info_.moved_by.name()});
    }
    table.write();
    const Json columns{
        {"session", {{"Description", "folder of the recorded session"}}},
        {"identity", {{"Description", "identity of the recording, from its session.yaml"}}},
        {"simulated", {{"Description", recording::kMovedByColumns[0].description}}},
        {"moved_by", {{"Description", recording::kMovedByColumns[1].description}}}};
    const std::string json = file(place() + "/" + stem() + "_scans.json");
    if (!is_there(json)) write_anew(columns.dump(2) + "\n", json);
}

}  // namespace dihaptic::analysis::bids
