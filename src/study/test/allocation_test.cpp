#include "study/allocation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace dihaptic::study {
namespace {

StudyFile study_of(Method method, std::vector<std::pair<std::string, int>> groups) {
    StudyFile out;
    out.allocation.method = method;
    for (const auto& [name, people] : groups) out.groups.push_back({name, people, {}});
    return out;
}

std::vector<std::string> filled(const StudyFile& study) {
    Roster roster;
    std::vector<std::string> out;
    for (int i = 0; i < study.people(); ++i) {
        Member person;
        person.id = fmt::format("S{}", i);
        person.group = allocate(study, roster, person).group;
        roster.participants.push_back(person);
        out.push_back(person.group);
    }
    return out;
}

TEST(Allocation, TakesGroupsInTurn) {
    const auto study = study_of(Method::in_turn, {{"a", 2}, {"b", 2}});
    EXPECT_EQ(filled(study), (std::vector<std::string>{"a", "b", "a", "b"}));
}

TEST(Allocation, GivesTwiceAsManyPeopleToAGroupTwiceAsLarge) {
    const auto study = study_of(Method::in_turn, {{"a", 4}, {"b", 2}});
    EXPECT_EQ(filled(study), (std::vector<std::string>{"a", "b", "a", "a", "b", "a"}));
}

TEST(Allocation, EachBlockHoldsTheGroupsInProportion) {
    auto study = study_of(Method::blocks, {{"a", 20}, {"b", 20}});
    study.allocation.block = 4;
    const auto sequence = sequence_of(study, 40);
    bool shuffled = false;
    for (size_t i = 0; i < sequence.size(); i += 4) {
        const auto block = sequence.begin() + static_cast<std::ptrdiff_t>(i);
        EXPECT_EQ(std::count(block, block + 4, "a"), 2) << i;
        shuffled = shuffled || *block != "a" || *(block + 1) != "b";
    }
    EXPECT_TRUE(shuffled);
    study.allocation.seed = 2;
    EXPECT_NE(sequence_of(study, 40), sequence);
}

TEST(Allocation, OfABlockLargerThanTheStudyStillFillsEachGroup) {
    auto study = study_of(Method::blocks, {{"a", 3}, {"b", 3}});
    study.allocation.block = 100;
    const auto groups = filled(study);
    EXPECT_EQ(std::count(groups.begin(), groups.end(), "a"), 3);
}

TEST(Allocation, GivesAFreePlaceToTheNextParticipant) {
    const auto study = study_of(Method::in_turn, {{"a", 3}, {"b", 3}});
    Roster roster;
    for (const char* group : {"a", "b", "a", "b"}) {
        Member member;
        member.group = group;
        member.number = roster.active(group) + 1;
        roster.participants.push_back(member);
    }
    roster.participants[1].withdrawn = "2026-01-31T09:30:00+01:00";
    const Allocated next = allocate(study, roster, {});
    EXPECT_EQ(next.group, "b");
    EXPECT_EQ(next.number, 1);
}

/// The rule of Pocock and Simon, with chance 1, balances two facts where allocation in turn cannot.
TEST(Allocation, MinimisationBalancesFacts) {
    auto study = study_of(Method::minimisation, {{"a", 20}, {"b", 20}});
    study.allocation.over = {"sex", "handedness"};
    study.allocation.chance = 1;
    Roster roster;
    for (int i = 0; i < 40; ++i) {
        Member person;
        person.sex = i % 2 == 0 ? "F" : "M";  // in turn, all women would be in one group
        person.handedness = i % 5 == 0 ? "left" : "right";
        person.group = allocate(study, roster, person).group;
        roster.participants.push_back(person);
    }
    for (const auto& [fact, value] : {std::pair{"sex", "F"}, std::pair{"handedness", "left"}}) {
        std::map<std::string, int> count;
        for (const Member& member : roster.participants)
            if (member.fact(fact) == value) ++count[member.group];
        EXPECT_LE(std::abs(count["a"] - count["b"]), 1) << fact;
    }
}

TEST(Allocation, SaysThatTheStudyIsFull) {
    const auto study = study_of(Method::in_turn, {{"a", 1}});
    Member one;
    one.group = "a";
    const Roster roster{"", {one}};
    try {
        allocate(study, roster, {});
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("all 1 places are taken"), std::string::npos);
    }
}

}  // namespace
}  // namespace dihaptic::study
