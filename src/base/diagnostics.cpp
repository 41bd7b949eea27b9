#include "base/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/text.h"
#include "base/unit.h"

namespace dihaptic {

namespace {

void end_sentence(std::string& text) {
    if (text.empty() || std::string_view(".?!").find(text.back()) == std::string_view::npos)
        text += ".";
}

}  // namespace

std::string Problem::text() const {
    std::string out;
    if (!place.file.empty()) out += place.file + ":";
    if (place.line > 0) out += fmt::format("{}:", place.line);
    if (!out.empty()) out += " ";
    out += severity == Severity::error ? "error: " : "warning: ";
    if (!key.empty()) out += key + ": ";
    out += what;
    end_sentence(out);
    if (!remedy.empty()) out += " " + remedy;
    end_sentence(out);
    // names come from files and may contain characters that move a terminal's cursor
    return mended(out, Lines::one);
}

namespace {

/// The line of the key, which may be followed by a unit, if `place` is the place of a mapping that
/// contains the key; otherwise `place` itself.
Place place_of(const Place& place, const std::string& key) {
    Place out{place.file, place.line};
    if (!place.keys || key.empty()) return out;
    for (auto at = place.keys->lower_bound(key); at != place.keys->end(); ++at) {
        if (!at->first.starts_with(key)) break;
        const std::string_view rest = std::string_view(at->first).substr(key.size());
        if (!rest.empty() && (rest.front() != '_' || find_unit(rest.substr(1)) == nullptr))
            continue;
        out.line = at->second;
        break;
    }
    return out;
}

Problem problem(Severity severity, const Place& place, std::string key, std::string what,
                std::string remedy) {
    Place at = place_of(place, key);
    return {severity, std::move(at), std::move(key), std::move(what), std::move(remedy)};
}

std::string join(const std::vector<Problem>& problems) {
    std::string out;
    for (const Problem& problem : problems) {
        if (!out.empty()) out += "\n";
        out += problem.text();
    }
    return out;
}

}  // namespace

Error::Error(std::vector<Problem> problems)
    : std::runtime_error(join(problems)), problems_(std::move(problems)) {}

Error::Error(const Place& place, std::string key, std::string what, std::string remedy)
    : Error({problem(Severity::error, place, std::move(key), std::move(what), std::move(remedy))}) {
}

namespace {

/// The limit on reported problems: nobody corrects more at a time, and a file may contain a hundred
/// thousand.
constexpr size_t kMostErrors = 200;
constexpr size_t kMostWarnings = 1000;
constexpr const char* kMore = "there are more problems than those above";

/// Whether the list is full, so that further problems are left out.
bool is_full(const std::vector<Problem>& problems) {
    return !problems.empty() && problems.back().what == kMore;
}

size_t errors(const std::vector<Problem>& problems) {
    return static_cast<size_t>(
        std::count_if(problems.begin(), problems.end(),
                      [](const Problem& p) { return p.severity == Severity::error; }));
}

/// Adds the problem, unless the list is already full. The first error is
/// always kept, however many warnings there are.
void tell(std::vector<Problem>& problems, Problem next) {
    if (is_full(problems)) return;
    if (next.severity == Severity::warning && problems.size() >= kMostWarnings) return;
    problems.push_back(std::move(next));
    if (problems.size() < kMostErrors || errors(problems) < kMostErrors) return;
    problems.push_back({Severity::error, problems.back().place, "", kMore,
                        "Correct these first, and check again."});
}

}  // namespace

void Diagnostics::error(const Place& place, std::string key, std::string what, std::string remedy,
                        std::vector<Choice> choices) {
    Problem next =
        problem(Severity::error, place, std::move(key), std::move(what), std::move(remedy));
    next.choices = std::move(choices);
    tell(problems_, std::move(next));
}

void Diagnostics::warning(const Place& place, std::string key, std::string what,
                          std::string remedy) {
    tell(problems_,
         problem(Severity::warning, place, std::move(key), std::move(what), std::move(remedy)));
}

void Diagnostics::unknown_key(const Place& place, std::string key, std::string remedy,
                              std::vector<Choice> choices) {
    if (unknown_ == UnknownKeys::are_errors && key == "<<") {
        error(place, std::move(key), "is a merge, which is not supported",
              "Write the keys of the other mapping here.");
    } else if (unknown_ == UnknownKeys::are_errors) {
        error(place, std::move(key), "is not known here", std::move(remedy), std::move(choices));
    } else {
        warning(place, std::move(key), "is not known to this version of Dihaptic, and is left out",
                "");
    }
}

void Diagnostics::add(const std::vector<Problem>& problems) {
    for (const Problem& problem : problems) tell(problems_, problem);
}

bool Diagnostics::has_errors() const {
    return std::any_of(problems_.begin(), problems_.end(),
                       [](const Problem& p) { return p.severity == Severity::error; });
}

void Diagnostics::throw_if_errors() const {
    if (has_errors()) throw Error(problems_);
}

namespace {

/// Levenshtein distance, computed with a single row of the table.
size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
        }
    }
    return row[b.size()];
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
    std::string best;
    size_t best_distance = std::max<size_t>(2, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        const size_t distance = edit_distance(word, candidate);
        if (distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

}  // namespace dihaptic
