#include "identifiers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "recording/moved_by.h"
#include "study/identifier.h"
#include "task/plan/trials.h"

namespace dihaptic::gui {
namespace {

bool is_digit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The text before the number at the end.
std::string stem_of(const std::string& id) {
    const auto end = std::find_if_not(id.rbegin(), id.rend(), is_digit);
    return {id.begin(), end.base()};
}

/// The identifier in capital letters, without signs.
std::string plain(const std::string& id) {
    std::string out;
    for (const char c : id) {
        if (c != '-' && c != '_')
            out += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    return out;
}

/// plain(), with letters that look like digits as digits, and without zeros before a number.
std::string folded(const std::string& id) {
    std::string digits = plain(id);
    for (char& c : digits) {
        if (c == 'O') c = '0';
        if (c == 'I' || c == 'L') c = '1';
    }
    std::string out;
    for (size_t i = 0; i < digits.size(); ++i) {
        const bool begins = out.empty() || !is_digit(out.back());
        const bool continues = i + 1 < digits.size() && is_digit(digits[i + 1]);
        if (digits[i] != '0' || !begins || !continues) out += digits[i];
    }
    return out;
}

/// Whether one character was changed, left out or added, or two neighbours were swapped.
bool one_slip_apart(const std::string& a, const std::string& b) {
    if (a.size() > b.size()) return one_slip_apart(b, a);
    if (b.size() > a.size() + 1) return false;
    const auto [in_a, in_b] = std::mismatch(a.begin(), a.end(), b.begin());
    const std::string rest_a(in_a, a.end()), rest_b(in_b, b.end());
    if (a.size() < b.size()) return rest_a == rest_b.substr(1);
    if (rest_a.size() < 2) return true;
    const bool swapped = rest_a[0] == rest_b[1] && rest_a[1] == rest_b[0];
    return rest_a.substr(1) == rest_b.substr(1) ||
           (swapped && rest_a.substr(2) == rest_b.substr(2));
}

bool contains(const std::vector<std::string>& known, const std::string& id) {
    return std::ranges::find(known, id) != known.end();
}

}  // namespace

QString fault_of_identifier(const std::string& typed, bool needs_number) {
    switch (study::fault_of_identifier(typed)) {
        case study::IdentifierFault::none:
            break;
        case study::IdentifierFault::empty:
            return QObject::tr("Type the participant's identifier, e.g. S07.");
        case study::IdentifierFault::sign:
            return QObject::tr("Only the letters A to Z, digits, - and _ are allowed.");
        case study::IdentifierFault::too_long:
            return QObject::tr("At most %1 characters are allowed.").arg(study::kLongestIdentifier);
        case study::IdentifierFault::simulated:
            return QObject::tr("Identifiers that begin with %1 are those of simulated people.")
                .arg(recording::kSimulatedPrefix);
        case study::IdentifierFault::no_digit:
            return QObject::tr("It has no digit, and may be a person's name: use e.g. S07.");
    }
    if (needs_number && task::participant_number(typed) < 0)
        return QObject::tr("It must end in a number, which orders the trials.");
    return "";
}

std::string resembled(const std::string& typed, const std::vector<std::string>& known) {
    if (contains(known, typed)) return "";
    const auto found = [&](const auto& resembles) {
        const auto it = std::ranges::find_if(known, resembles);
        return it == known.end() ? "" : *it;
    };
    const std::string same =
        found([&](const std::string& id) { return folded(id) == folded(typed); });
    if (!same.empty()) return same;
    return found([&](const std::string& id) {
        const std::string a = plain(typed), b = plain(id);
        return one_slip_apart(a, b) || (b.size() > 1 && (a.starts_with(b) || a.ends_with(b)));
    });
}

std::string next_identifier(const std::vector<std::string>& known) {
    std::map<std::string, int> people;  // by the text before the number
    for (const std::string& id : known) {
        if (task::participant_number(id) >= 0) ++people[stem_of(id)];
    }
    if (people.empty()) return "S01";
    const auto most = std::ranges::max_element(
        people, [](const auto& a, const auto& b) { return a.second < b.second; });
    int last = 0;
    size_t digits = 1;
    for (const std::string& id : known) {
        const int number = task::participant_number(id);
        if (number < last || stem_of(id) != most->first) continue;
        last = number;
        digits = id.size() - most->first.size();
    }
    return fmt::format("{}{:0{}}", most->first, last + 1, digits);
}

bool out_of_turn(const std::string& typed, const std::vector<std::string>& known) {
    if (contains(known, typed)) return false;
    const std::string next = next_identifier(known);
    return typed != next && !known.empty() && stem_of(typed) == stem_of(next);
}

}  // namespace dihaptic::gui
