#include "study_collection.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "base/number.h"
#include "base/plural.h"
#include "common/console.h"
#include "session/study_session.h"
#include "session_tables.h"
#include "task/file/experiment.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

/// The first columns of each row. Experiments have columns of their own, so these say that they are
/// the study's, apart from the names that no experiment may use.
const std::vector<std::string> kFront{
    "seed", "group", "id", "study_number", "study_session", "study_condition", "study_version"};

/// Tables of different experiments under one another: a cell is empty where its session lacks the
/// column.
class JoinedTable {
  public:
    void add(const std::vector<std::string>& front, const Rows& table) {
        if (table.empty()) return;
        std::vector<size_t> places;
        for (const std::string& name : table[0]) places.push_back(place_of(name));
        for (size_t i = 1; i < table.size(); ++i) {
            std::vector<std::string> row(columns_.size());
            for (size_t k = 0; k < table[i].size() && k < places.size(); ++k)
                row[places[k]] = table[i][k];
            rows_.emplace_back(front, std::move(row));
        }
    }

    Rows rows() const {
        Rows out(1, kFront);
        out[0].insert(out[0].end(), columns_.begin(), columns_.end());
        for (const auto& [front, row] : rows_) {
            out.push_back(front);
            out.back().insert(out.back().end(), row.begin(), row.end());
            out.back().resize(out[0].size());
        }
        return out;
    }

  private:
    size_t place_of(const std::string& name) {
        if (std::ranges::find(kFront, name) != kFront.end()) {
            throw Error({"", 0}, name, "is a column that the joined tables have of the study",
                        "Rename the factor, draw, variable or measure of this name.");
        }
        const auto [at, is_new] = places_.emplace(name, columns_.size());
        if (is_new) columns_.push_back(name);
        return at->second;
    }

    std::vector<std::string> columns_;
    std::map<std::string, size_t> places_;
    std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> rows_;
};

class Collector {
  public:
    Collector(const study::StudyFile& study, bool reveal)
        : study_(study), reveal_(reveal), roster_(study::read_roster(study)) {}

    /// Adds every complete session, and lists those that are missing.
    void run() {
        ProgressLine line("collecting");
        double done = 0;
        for (const study::Member& member : roster_.participants) {
            add(member);
            line.show(++done / static_cast<double>(roster_.participants.size()));
        }
        line.clear();
    }

    void write(const std::string& folder) const {
        fs::create_directories(folder);
        std::string names = "participants.csv";
        write_rows(participants(), folder + "/participants.csv");
        for (const auto& [name, table] : tables_) {
            write_rows(table.rows(), folder + "/" + name);
            names += ", " + name;
        }
        for (const std::string& text : missing_) fmt::print("{}\n", text);
        fmt::print("{} of {} people: in {}: {}\n",
                   counted(static_cast<int64_t>(sessions_), "session"), roster_.participants.size(),
                   folder, names);
    }

  private:
    std::string group_of(const study::Member& member) const {
        return reveal_ ? member.group : study_.shown_group(member.group);
    }

    void add(const study::Member& member) {
        const auto visits = session::visits_of(study_, member);
        for (size_t i = 0; i < study_.sessions.size(); ++i) {
            const auto complete = std::ranges::find_if(
                visits, [&](const study::Visit& v) { return v.session == i && v.complete; });
            if (complete != visits.end()) {
                add_session(member, complete->folder);
            } else if (member.takes_part()) {
                missing_.push_back(
                    fmt::format("missing: {} of {}", study_.sessions[i].name, member.id));
            }
        }
    }

    void add_session(const study::Member& member, const std::string& folder) {
        const auto info = recording::SessionFolder::open_tables(folder).read_info();
        const recording::InStudy place = info.in_study.value_or(recording::InStudy{});
        const std::vector<std::string> front{info.seed,
                                             group_of(member),
                                             member.id,
                                             number_text(member.number),
                                             place.session,
                                             place.condition,
                                             number_text(place.version)};
        for (const auto& [name, rows] : tables_of(folder)) {
            if (!rows.empty()) tables_[name].add(front, rows);
        }
        ++sessions_;
    }

    Rows participants() const {
        Rows out{{"id", "group", "number", "age", "sex", "handedness"}};
        for (const study::FactSpec& fact : study_.facts) out[0].push_back(fact.name);
        for (const char* name : {"added", "version", "withdrawn"}) out[0].emplace_back(name);
        for (const study::Member& m : roster_.participants) {
            out.push_back({m.id, group_of(m), number_text(m.number), m.age, m.sex, m.handedness});
            for (const study::FactSpec& fact : study_.facts)
                out.back().push_back(m.fact(fact.name));
            for (const std::string& text : {m.added, number_text(m.version), m.withdrawn})
                out.back().push_back(text);
        }
        return out;
    }

    const study::StudyFile& study_;
    bool reveal_;
    study::Roster roster_;
    std::map<std::string, JoinedTable> tables_;
    std::vector<std::string> missing_;
    size_t sessions_ = 0;
};

}  // namespace

bool is_study(const std::string& file) {
    std::error_code unreadable;
    return fs::is_regular_file(file, unreadable) && task::kind_of(file) == task::FileKind::study;
}

void collect_study(const StudyCollection& collection) {
    study::StudyFile study = study::read_study(collection.file);
    if (!collection.rehearsed.empty()) {
        if (!fs::is_directory(collection.rehearsed))
            throw Error({"--rehearsed", 0}, collection.rehearsed, "is not a folder",
                        "Name the folder in which the study was rehearsed, or rehearse it first.");
        study.data = collection.rehearsed;
    }
    Collector collector(study, collection.reveal_groups);
    collector.run();
    if (collection.reveal_groups && study.allocation.concealed)
        study::log(study, "reveal groups", "", collection.out);
    collector.write(collection.out.empty() ? study.data + "/tables" : collection.out);
}

}  // namespace dihaptic::cli
