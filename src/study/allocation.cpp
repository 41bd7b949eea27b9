#include "study/allocation.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "base/random.h"
#include "study/facts.h"
#include "task/plan/trials.h"

namespace dihaptic::study {
namespace {

uint64_t seed_of(const StudyFile& study) {
    return static_cast<uint64_t>(study.allocation.seed);
}

int block_size(const StudyFile& study) {
    const int smallest = smallest_block(study);
    if (study.allocation.method != Method::blocks) return smallest;
    return study.allocation.block == 0 ? 2 * smallest : study.allocation.block;
}

/// Returns one block. The groups take turns, and groups with a larger target number occur more
/// often.
std::vector<std::string> block_of(const StudyFile& study) {
    const int size = block_size(study);
    std::vector<double> given(study.groups.size(), 0);
    std::vector<std::string> out;
    for (int i = 0; i < size; ++i) {
        size_t next = 0;
        // next is the group that has received the smallest part of its share
        for (size_t g = 1; g < given.size(); ++g) {
            const auto part = [&](size_t k) { return (given[k] + 0.5) / study.groups[k].people; };
            if (part(g) < part(next) - 1e-12) next = g;
        }
        ++given[next];
        out.push_back(study.groups[next].name);
    }
    return out;
}

/// Returns the group of the first free place in the sequence.
std::string next_in_sequence(const StudyFile& study, const Roster& roster) {
    std::map<std::string, int> seen;
    // long enough to reach every group's target number, even if the last block is not filled
    const auto count = static_cast<size_t>(study.people() + 2 * block_size(study));
    for (const std::string& group : sequence_of(study, count)) {
        const int active = roster.active(group);
        if (active < study.group(group).people && ++seen[group] > active) return group;
    }
    return "";  // unreachable: the caller has checked that a group has a free place
}

/// Returns the imbalance that would result if the person joined the group `joined`: for each fact,
/// the range between groups of the proportion of people who share the person's value, summed over
/// the facts.
double imbalance(const StudyFile& study, const Roster& roster, const Member& person,
                 const std::string& joined) {
    double out = 0;
    for (const std::string& fact : study.allocation.over) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Group& group : study.groups) {
            double same = group.name == joined ? 1 : 0;
            for (const Member& other : roster.participants) {
                if (other.takes_part() && other.group == group.name &&
                    other.fact(fact) == person.fact(fact))
                    ++same;
            }
            low = std::min(low, same / group.people);
            high = std::max(high, same / group.people);
        }
        out += high - low;
    }
    return out;
}

std::string minimising(const StudyFile& study, const Roster& roster, const Member& person,
                       const std::vector<std::string>& open) {
    std::map<std::string, double> sums;
    double least = std::numeric_limits<double>::infinity();
    for (const std::string& group : open) {
        sums[group] = imbalance(study, roster, person, group);
        least = std::min(least, sums[group]);
    }
    std::vector<std::string> best, others;
    for (const std::string& group : open)
        (sums[group] < least + 1e-12 ? best : others).push_back(group);
    Random random(seed_of(study), fmt::format("minimisation/{}", roster.participants.size()));
    const bool follows = random.uniform(0, 1) < study.allocation.chance;
    const auto& from = follows || others.empty() ? best : others;
    const auto i = static_cast<size_t>(random.uniform(0, static_cast<double>(from.size())));
    return from[std::min(i, from.size() - 1)];  // uniform() may return its upper bound
}

/// Returns the group to which the person's fact assigns the person.
std::string by_fact(const StudyFile& study, const Member& person,
                    const std::vector<std::string>& open) {
    const std::string group = person.fact(study.allocation.fact);
    if (std::ranges::find(open, group) != open.end()) return group;
    throw Error(study.place, "groups",
                fmt::format("have no place for {0}: all {2} places of the group {1} are taken",
                            person.id, group, study.group(group).people),
                "For more, raise 'people' of the group, and accept the changed file.");
}

std::string chosen(const StudyFile& study, const Roster& roster, const Member& person,
                   const std::vector<std::string>& open) {
    switch (study.allocation.method) {
        case Method::minimisation:
            return minimising(study, roster, person, open);
        case Method::fact:
            return by_fact(study, person, open);
        case Method::in_turn:
        case Method::blocks:
            break;
    }
    return next_in_sequence(study, roster);
}

/// Returns the smallest number in the group that is not taken.
int free_number(const Roster& roster, const std::string& group) {
    std::set<int> held;
    for (const Member& member : roster.participants) {
        if (member.takes_part() && member.group == group) held.insert(member.number);
    }
    int out = 1;
    while (held.contains(out)) ++out;
    return out;
}

}  // namespace

std::vector<std::string> sequence_of(const StudyFile& study, size_t count) {
    const auto order =
        study.allocation.method == Method::blocks ? task::Order::shuffled : task::Order::sequential;
    const std::vector<std::string> block = block_of(study);
    std::vector<std::string> out;
    for (int n = 0; out.size() < count; ++n) {
        Random random(seed_of(study), fmt::format("block/{}", n));
        for (const int i : task::ordered(static_cast<int>(block.size()), order, 0, random))
            out.push_back(block[static_cast<size_t>(i)]);
    }
    out.resize(count);
    return out;
}

Allocated allocate(const StudyFile& study, const Roster& roster, const Member& person) {
    std::vector<std::string> open;
    for (const Group& group : study.groups) {
        if (roster.active(group.name) < group.people) open.push_back(group.name);
    }
    if (open.empty()) {
        throw Error(study.place, "groups",
                    fmt::format("are full: all {} places are taken", study.people()),
                    "For more, raise 'people' of the groups, and accept the changed file: dihaptic "
                    "participant accept STUDY --why TEXT.");
    }
    const std::string group = chosen(study, roster, person, open);
    return {group, free_number(roster, group)};
}

}  // namespace dihaptic::study
