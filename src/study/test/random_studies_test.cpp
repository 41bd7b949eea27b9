// Tests random studies that are filled with people, some of whom withdraw, and checks that each
// person is allocated as designed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "base/random.h"
#include "study/allocation.h"
#include "study/facts.h"

namespace dihaptic::study {
namespace {

constexpr int kStudies = 200;

class RandomStudy {
  public:
    explicit RandomStudy(int n) : random_(static_cast<uint64_t>(n), "random study") {
        file_.allocation.seed = n;
        file_.allocation.method = static_cast<Method>(n % 3);
        const int base = 1 + below(6);
        for (int g = 0, count = 1 + below(4); g < count; ++g)
            file_.groups.push_back({fmt::format("g{}", g), base * (1 + below(3)), {}});
        if (file_.allocation.method == Method::minimisation)
            file_.allocation.over = {"sex", "handedness"};
        if (file_.allocation.method == Method::blocks)
            file_.allocation.block = smallest_block(file_) * below(4);
        for (int s = 0, count = 1 + below(4); s < count; ++s) {
            file_.sessions.push_back({});
            file_.sessions.back().name = fmt::format("day{}", s + 1);
            file_.sessions.back().experiment = "{condition}.yaml";
            file_.conditions.push_back(fmt::format("c{}", s));
        }
        file_.order = static_cast<task::Order>(below(4));
    }

    /// Adds people until all groups are full; after each addition, a person withdraws with a
    /// probability of one in eight.
    void fill() {
        while (active() < file_.people()) {
            add();
            check();
            if (below(8) == 0) withdraw();
        }
    }

    const StudyFile& file() const { return file_; }
    const Roster& roster() const { return roster_; }
    int active() const {
        int out = 0;
        for (const Group& group : file_.groups) out += roster_.active(group.name);
        return out;
    }

  private:
    int below(int n) { return static_cast<int>(random_.uniform(0, n)); }

    void add() {
        Member person;
        person.id = fmt::format("S{:03d}", roster_.participants.size() + 1);
        person.sex = below(2) == 0 ? "F" : "M";
        person.handedness = below(5) == 0 ? "left" : "right";
        const Allocated where = allocate(file_, roster_, person);
        const Allocated again = allocate(file_, roster_, person);
        EXPECT_EQ(where.group, again.group);
        EXPECT_EQ(where.number, again.number);
        person.group = where.group;
        person.number = where.number;
        roster_.participants.push_back(person);
    }

    void withdraw() {
        Member& one = roster_.participants[static_cast<size_t>(
            below(static_cast<int>(roster_.participants.size())))];
        one.withdrawn = "2026-01-31T09:30:00+01:00";
        withdrawn_ = true;
    }

    /// Checks that no group exceeds its target number, that no two people have the same place and
    /// that, without withdrawals, the size of each group is within one person of its share.
    void check() const {
        std::set<std::pair<std::string, int>> places;
        for (const Member& member : roster_.participants) {
            if (!member.takes_part()) continue;
            const bool alone = places.emplace(member.group, member.number).second;
            EXPECT_TRUE(alone);
        }
        for (const Group& group : file_.groups) {
            EXPECT_LE(roster_.active(group.name), group.people);
            if (file_.allocation.method != Method::in_turn || withdrawn_) continue;
            const double share = static_cast<double>(active()) * group.people / file_.people();
            EXPECT_LE(std::abs(roster_.active(group.name) - share), 1) << group.name;
        }
    }

    Random random_;
    StudyFile file_;
    Roster roster_;
    bool withdrawn_ = false;
};

TEST(RandomStudies, AreFilledAsDesigned) {
    for (int n = 1; n <= kStudies; ++n) {
        SCOPED_TRACE(n);
        RandomStudy study(n);
        study.fill();
        for (const Group& group : study.file().groups)
            EXPECT_EQ(study.roster().active(group.name), group.people);
        EXPECT_THROW(allocate(study.file(), study.roster(), {}), Error);
    }
}

TEST(RandomStudies, AreFilledAlikeWhenRepeated) {
    for (int n = 1; n <= kStudies; ++n) {
        SCOPED_TRACE(n);
        RandomStudy one(n), two(n);
        one.fill();
        two.fill();
        ASSERT_EQ(one.roster().participants.size(), two.roster().participants.size());
        for (size_t i = 0; i < one.roster().participants.size(); ++i) {
            EXPECT_EQ(one.roster().participants[i].group, two.roster().participants[i].group);
            EXPECT_EQ(one.roster().participants[i].number, two.roster().participants[i].number);
        }
    }
}

TEST(RandomStudies, GiveEachParticipantEveryConditionOnce) {
    for (int n = 1; n <= kStudies; ++n) {
        RandomStudy study(n);
        study.fill();
        for (const Member& member : study.roster().participants) {
            std::set<std::string> met;
            for (size_t i = 0; i < study.file().sessions.size(); ++i)
                met.insert(study.file().condition_of(i, member.group, member.number));
            EXPECT_EQ(met.size(), study.file().conditions.size());
        }
    }
}

}  // namespace
}  // namespace dihaptic::study
