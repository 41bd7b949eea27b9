#include "session/rehearsed.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/plural.h"
#include "base/regular_file.h"
#include "base/table.h"
#include "recording/seal.h"

namespace dihaptic::session {
namespace {

using recording::SessionState;

constexpr const char* kAgain =
    "Restore this person's own folder, or remove it: the rehearsal's command then repeats this "
    "person again.";

class Look {
  public:
    Look(const std::string& folder, std::string id, const Rehearsal& rehearsal)
        : folder_(recording::SessionFolder::open_tables(folder + "/" + id)),
          info_(folder_.read_info()),
          id_(std::move(id)),
          rehearsal_(rehearsal) {}

    Rehearsed run() {
        add(recording::broken_seals(folder_, info_, Severity::error));
        add(folder_.changed(info_.inputs, Severity::error));
        check_session();
        check_person();
        check_inputs();
        for (const char* name : {"trials.csv", "lifts.csv"}) check_cells(name);
        // a different program version may order the trials differently
        const bool own = info_.program == recording::program_version();
        if (problems_.empty() && own && trials_left(folder_.path()))
            refuse("trials.csv", "",
                   "has unfinished trials, although the session is marked as complete");
        return {info_.identity, recording::is_sealed(info_), std::move(problems_)};
    }

  private:
    void add(const std::vector<Problem>& problems) {
        problems_.insert(problems_.end(), problems.begin(), problems.end());
    }
    void refuse(const std::string& name, const std::string& key, const std::string& what,
                int line = 0) {
        problems_.push_back({Severity::error, {folder_.file(name), line}, key, what, kAgain});
    }
    void expect(const char* key, const std::string& value, const std::string& wanted,
                const char* of) {
        if (value == wanted) return;
        refuse("session.yaml", key, fmt::format("is {}; in the {} it is {}", value, of, wanted));
    }

    void check_session() {
        expect("program", info_.program, rehearsal_.program, "rehearsal");
        expect("seed", info_.seed, rehearsal_.seed, "rehearsal");
        expect("participant", info_.participant.id, id_, "folder's name");
        if (info_.state == SessionState::running || info_.state == SessionState::interrupted)
            refuse("session.yaml", "state",
                   fmt::format("is {}: not all trials were done", enum_name(info_.state)));
    }

    /// Checks person.yaml. A simulated person's traits are an input like any other, with a
    /// checksum.
    void check_person() {
        if (!is_input("person.yaml"))
            return refuse("session.yaml", "inputs",
                          "do not include person.yaml, with the person's traits");
        try {
            const Node* const id = read_yaml(folder_.file("person.yaml")).find("id");
            if (id != nullptr && id->scalar != id_)
                refuse("person.yaml", "id",
                       fmt::format("is {}; the folder belongs to {}", id->scalar, id_));
        } catch (const Error& e) {
            add(e.problems());
        }
    }
    bool is_input(const std::string& name) const {
        return std::ranges::find(info_.inputs, name, &recording::InputFile::file) !=
               info_.inputs.end();
    }

    /// Checks the inputs that all people of a rehearsal share; these are listed in rehearsal.yaml.
    void check_inputs() {
        for (const recording::InputFile& input : info_.inputs) {
            if (input.file == "person.yaml" || input.file == "trial-list.csv") continue;
            const Node* const wanted = rehearsal_.inputs.find(input.file);
            if (wanted == nullptr) {
                refuse(input.file, "",
                       "is not an input of this rehearsal: rehearsal.yaml does not list it");
            } else if (!is_same(input, *wanted)) {
                refuse(input.file, "", "differs from this rehearsal's, which is in rehearsal.yaml");
            }
        }
        for (const Node::Entry& wanted : rehearsal_.inputs.entries) {
            if (!is_input(wanted.key))
                refuse(wanted.key, "",
                       "is not an input of this session, but was an input of its rehearsal");
        }
    }
    bool is_same(const recording::InputFile& input, const Node& wanted) const {
        if (wanted.kind == Node::Kind::scalar) return input.checksum == wanted.scalar;
        try {
            return to_yaml(read_yaml(folder_.file(input.file))) == to_yaml(wanted);
        } catch (const Error&) {
            return false;
        }
    }

    void check_cells(const char* name) {
        const std::string file = folder_.file(name);
        if (std::string_view(name) == "lifts.csv" && !is_there(file)) return;
        try {
            const auto rows = read_csv(file);
            for (size_t i = 1; i < rows.size(); ++i) {
                if (rows[i].size() == rows[0].size()) continue;
                return refuse(name, "",
                              fmt::format("has a row of {}; its header has {}",
                                          counted(static_cast<int64_t>(rows[i].size()), "cell"),
                                          rows[0].size()),
                              static_cast<int>(i) + 1);
            }
        } catch (const Error& e) {
            if (!recording::is_sealed(info_))
                add(e.problems());  // if it is sealed, its seal has reported it
        }
    }

    const recording::SessionFolder folder_;
    const recording::SessionInfo info_;
    const std::string id_;
    const Rehearsal& rehearsal_;
    std::vector<Problem> problems_;
};

}  // namespace

Rehearsed look_at(const std::string& folder, const std::string& id, const Rehearsal& rehearsal) {
    try {
        return Look(folder, id, rehearsal).run();
    } catch (const Error& e) {
        return {"", false, e.problems()};
    }
}

}  // namespace dihaptic::session
