#include "study/study_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "base/checksum.h"
#include "base/choices.h"
#include "base/installed.h"
#include "study/facts.h"
#include "task/plan/trials.h"

namespace dihaptic::study {
namespace {

constexpr std::string_view kGroup = "{group}", kCondition = "{condition}";

std::string replaced(std::string text, std::string_view what, const std::string& with) {
    for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at))
        text.replace(at, what.size(), with), at += with.size();
    return text;
}

bool uses(const SessionSpec& session, std::string_view placeholder) {
    return session.experiment.find(placeholder) != std::string::npos;
}

/// The name of a session's experiment for a group and a condition.
std::string named_for(const SessionSpec& session, const std::string& group,
                      const std::string& condition) {
    return replaced(replaced(session.experiment, kGroup, group), kCondition, condition);
}

/// Whether a word contains only letters, digits and the characters in `others`, and can be part of
/// a file name.
bool is_word(const std::string& word, const char* others) {
    return !word.empty() && std::all_of(word.begin(), word.end(), [&](unsigned char c) {
        return std::isalnum(c) != 0 ||
               std::string_view(others).find(static_cast<char>(c)) != std::string_view::npos;
    });
}

/// Checks the rules of a study file that visit() cannot express.
class Checker {
  public:
    Checker(const StudyFile& study, Diagnostics& diagnostics)
        : study_(study), diagnostics_(diagnostics) {}

    void run() {
        check_groups();
        check_allocation();
        check_facts();
        check_include();
        check_conditions();
        check_sessions();
    }

  private:
    void error(const Place& place, const char* key, const std::string& what,
               const std::string& remedy) {
        diagnostics_.error(place, key, what, remedy);
    }

    /// Reports a name that is empty, that contains characters other than letters, digits and
    /// `others`, or that occurs twice.
    void check_name(const Place& place, const char* key, const std::string& name,
                    const char* others, std::set<std::string>& names) {
        if (!is_word(name, others)) {
            error(place, key, fmt::format("'{}' is not a name", name),
                  fmt::format(
                      "Use letters and digits{}{}, because the name becomes part of files' names.",
                      *others == 0 ? "" : ", and any of ", others));
        } else if (!names.insert(name).second) {
            error(place, key, fmt::format("'{}' is listed twice", name), "Give each its own name.");
        }
    }

    void check_groups() {
        std::set<std::string> names;
        for (const Group& group : study_.groups)
            check_name(group.place, "name", group.name, "-_", names);
        if (study_.groups.empty())
            error(study_.place, "groups", "are missing",
                  "Write one group at least: groups: [{ name: all, people: 12 }].");
        std::set<std::string> codes;
        for (const Group& group : study_.groups) codes.insert(study_.code_of(group.name));
        if (codes.size() < names.size())
            error(study_.allocation.place, "seed", "gives two groups the same code",
                  "Choose another seed.");
    }

    void check_allocation() {
        const Allocation& a = study_.allocation;
        const int smallest = smallest_block(study_);
        if (a.block != 0 && a.method != Method::blocks)
            error(a.place, "block", "is only used with 'method: blocks'", "Leave it out.");
        if (a.block != 0 && smallest > 0 && a.block % smallest != 0)
            error(a.place, "block",
                  fmt::format("is {}, in which the groups cannot be in proportion", a.block),
                  fmt::format("Use a multiple of {}.", smallest));
        const bool minimises = a.method == Method::minimisation;
        if (minimises == a.over.empty())
            error(
                a.place, "over",
                minimises ? "is missing" : "is only used with 'method: minimisation'",
                minimises ? "Name the facts that it balances, e.g. over: [sex]." : "Leave it out.");
        check_group_fact();
        for (const std::string& fact : a.over) {
            if (!is_known(study_, fact)) {
                unknown_fact(a.place, "over", fact);
            } else if (is_number(study_, fact)) {
                error(a.place, "over",
                      fmt::format("'{}' is a number, and few people have the same one", fact),
                      "Add a fact with a few values, e.g. facts: [{ name: age_band, values: "
                      "[young, old] }].");
            }
        }
    }

    /// Checks that, if a fact determines the groups, the values of this fact are the names of the
    /// groups.
    void check_group_fact() {
        const Allocation& a = study_.allocation;
        const bool by_fact = a.method == Method::fact;
        if (by_fact == a.fact.empty()) {
            error(a.place, "fact", by_fact ? "is missing" : "is only used with 'method: fact'",
                  by_fact ? "Name the fact, e.g. fact: diagnosis." : "Leave it out.");
            return;
        }
        if (!by_fact) return;
        const FactSpec* spec = spec_of(study_, a.fact);
        std::vector<std::string> names;
        for (const Group& group : study_.groups) names.push_back(group.name);
        if (spec == nullptr || spec->values != names)
            error(a.place, "fact",
                  fmt::format("the values of '{}' are not the names of the groups", a.fact),
                  fmt::format("Write facts: [{{ name: {}, values: [{}] }}].", a.fact,
                              fmt::join(names, ", ")));
    }

    void unknown_fact(const Place& place, const char* key, const std::string& fact) {
        std::vector<std::string> known{kStandardFacts.begin(), kStandardFacts.end()};
        for (const FactSpec& spec : study_.facts) known.push_back(spec.name);
        error(place, key, fmt::format("'{}' is not a fact of this study", fact),
              fmt::format("Known: {}. Others are listed under 'facts'.", listed(known)));
    }

    void check_facts() {
        std::set<std::string> names(kStandardFacts.begin(), kStandardFacts.end());
        for (const FactSpec& fact : study_.facts) {
            check_name(fact.place, "name", fact.name, "_", names);
            if (std::ranges::find(kParticipantColumns, fact.name) != kParticipantColumns.end())
                error(fact.place, "name",
                      fmt::format("'{}' is another column of participants.csv", fact.name),
                      "Give the fact another name.");
        }
    }

    void check_include() {
        for (const Criterion& c : study_.include) {
            const bool bounds = c.at_least || c.at_most;
            if (!is_known(study_, c.fact)) {
                unknown_fact(c.place, "fact", c.fact);
            } else if (c.at_least && c.at_most && *c.at_least > *c.at_most) {
                error(c.place, "at_least", "is greater than at_most", "Exchange the two.");
            } else if (c.is.empty() && !bounds) {
                error(c.place, "fact", "has no condition", "Add 'is', 'at_least' or 'at_most'.");
            } else if (bounds && !is_number(study_, c.fact)) {
                error(c.place, "fact", fmt::format("'{}' is not a number", c.fact),
                      "Use is: [value].");
            } else if (const auto values = values_of(study_, c.fact); !values.empty()) {
                for (const std::string& value : c.is) {
                    if (std::ranges::find(values, value) == values.end())
                        error(c.place, "is",
                              fmt::format("'{}' is not a value of {}", value, c.fact),
                              fmt::format("Known: {}.", listed(values)));
                }
            }
        }
    }

    void check_conditions() {
        std::set<std::string> names;
        for (const std::string& name : study_.conditions)
            check_name(study_.place, "conditions", name, "-_", names);
        const auto with = std::ranges::count_if(
            study_.sessions, [](const SessionSpec& s) { return uses(s, kCondition); });
        if (static_cast<size_t>(with) != study_.conditions.size())
            error(study_.place, "conditions",
                  fmt::format("are {}, but {} sessions name {{condition}} in their experiment",
                              study_.conditions.size(), with),
                  "Give as many conditions as there are such sessions.");
        constexpr size_t kMost = 8;  // 40,320 orders
        if (study_.order == task::Order::counterbalanced && study_.conditions.size() > kMost)
            error(study_.place, "order", "has more than 40,320 orders", "Use latin_square.");
    }

    void check_sessions() {
        std::set<std::string> names;
        if (study_.sessions.empty())
            error(study_.place, "sessions", "are missing",
                  "Write e.g. sessions: [{ name: day1, experiment: baseline.yaml }].");
        for (size_t i = 0; i < study_.sessions.size(); ++i) {
            const SessionSpec& session = study_.sessions[i];
            check_name(session.place, "name", session.name, "", names);
            check_placeholders(session);
            if (i == 0 && (session.least_gap || session.most_gap || !session.needs.empty()))
                error(session.place, "name",
                      "has conditions on a previous session, but is the first",
                      "Leave out least_gap_h, most_gap_h and 'needs'.");
            if (session.least_gap && session.most_gap && *session.least_gap > *session.most_gap)
                error(session.place, "least_gap_h", "is greater than most_gap_h",
                      "Exchange the two.");
            for (const Condition& need : session.needs) check_need(need);
        }
    }

    void check_need(const Condition& need) {
        if (!need.at_least && !need.at_most)
            error(need.place, "column", "has no condition", "Add at_least or at_most.");
        if (need.column == "outcome" && need.is.empty())
            error(need.place, "is", "is missing: an outcome is a text, and has no mean",
                  "Write the outcome whose share of trials is meant, e.g. is: reached.");
        if (!need.is.empty() && std::max(need.at_least.value_or(0), need.at_most.value_or(0)) > 1)
            error(need.place, "at_least", "is a share of trials, which is at most 1",
                  "Write e.g. 0.8 for 80 %.");
    }

    void check_placeholders(const SessionSpec& session) {
        const std::string rest = replaced(replaced(session.experiment, kGroup, ""), kCondition, "");
        if (rest.find_first_of("{}") != std::string::npos)
            error(session.place, "experiment", "has a placeholder that is not known",
                  "Known: {group}, {condition}.");
    }

    const StudyFile& study_;
    Diagnostics& diagnostics_;
};

}  // namespace

int StudyFile::people() const {
    int out = 0;
    for (const Group& group : groups) out += group.people;
    return out;
}

int StudyFile::orders() const {
    return task::orders_of(static_cast<int>(conditions.size()), order);
}

const Group& StudyFile::group(const std::string& name) const {
    return *std::ranges::find(groups, name, &Group::name);
}

std::vector<std::string> StudyFile::conditions_of(const std::string& group, int number) const {
    Random random(static_cast<uint64_t>(allocation.seed),
                  fmt::format("conditions/{}/{}", group, number));
    std::vector<std::string> out;
    for (const int i :
         task::ordered(static_cast<int>(conditions.size()), order, number - 1, random))
        out.push_back(conditions[static_cast<size_t>(i)]);
    return out;
}

std::string StudyFile::condition_of(size_t index, const std::string& group, int number) const {
    if (!uses(sessions[index], kCondition)) return "";
    const auto before =
        std::count_if(sessions.begin(), sessions.begin() + static_cast<std::ptrdiff_t>(index),
                      [](const SessionSpec& s) { return uses(s, kCondition); });
    return conditions_of(group, number)[static_cast<size_t>(before)];
}

std::string StudyFile::experiment_name(size_t index, const std::string& group, int number) const {
    return named_for(sessions[index], group, condition_of(index, group, number));
}

std::string StudyFile::experiment_of(size_t index, const std::string& group, int number) const {
    return named_in(folder, experiment_name(index, group, number));
}

std::vector<std::string> StudyFile::experiments_of(const SessionSpec& session,
                                                   const Group& group) const {
    std::vector<std::string> out;
    const std::vector<std::string> one{""};
    for (const std::string& condition : uses(session, kCondition) ? conditions : one)
        out.push_back(named_for(session, group.name, condition));
    return out;
}

std::map<std::string, std::string> StudyFile::experiments_of(size_t index) const {
    std::map<std::string, std::string> out;
    for (const Group& group : groups) {
        for (const std::string& name : experiments_of(sessions[index], group))
            out[name] = named_in(folder, name);
    }
    return out;
}

bool StudyFile::is_done_by(const SessionSpec& session, const std::string& name,
                           const Group& group) const {
    return std::ranges::count(experiments_of(session, group), name) > 0;
}

std::string StudyFile::code_of(const std::string& name) const {
    return "arm " + checksum_of(fmt::format("{}/{}", allocation.seed, name)).substr(0, 4);
}

std::string StudyFile::shown_group(const std::string& name) const {
    return allocation.concealed ? code_of(name) : name;
}

std::string StudyFile::group_shown(const std::string& shown) const {
    for (const Group& group : groups) {
        if (group.name == shown || code_of(group.name) == shown) return group.name;
    }
    return "";
}

StudyFile read_study(const std::string& file) {
    StudyFile out;
    Diagnostics diagnostics;
    read_fields(out, read_yaml(file), diagnostics);
    Checker(out, diagnostics).run();
    diagnostics.throw_if_errors();
    out.folder = std::filesystem::path(file).parent_path().string();
    if (out.folder.empty()) out.folder = ".";
    out.data = out.folder;
    return out;
}

}  // namespace dihaptic::study
