// Tests that every quantity of a Frame is described, and that docs/quantities.md agrees with the
// descriptions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "base/unit.h"
#include "frame/frame.h"
#include "recording/codes.h"
#include "recording/schema.h"
#include "testing/files.h"

namespace dihaptic::recording::quantities_test {
namespace {

using namespace frame;

constexpr const char* kFile = "docs/quantities.md";

struct Row {
    Term term;
    std::string type;
};
struct List {
    std::string name;
    std::string meaning;
    std::vector<Row> rows;
};

/// Lists all quantities, in the order of the log.
class Lists {
  public:
    Lists() {
        const Frame frame;
        Frame::visit(frame, *this);
    }
    std::vector<List> all{{"tick", "What a tick has once.", {}}};

    // called by Frame::visit() for each field
    template <class T>
    void operator()(const T&, const Term& term) {
        all.back().rows.push_back({term, type_name<T>()});
    }
    template <class T>
    void each(const char* name, const std::vector<T>&, const char* meaning) {
        all.push_back({name, meaning, {}});
        const T item{};
        T::visit(item, *this);
    }
    template <class T>
    void changed(const char* name, const std::vector<T>& list, const std::vector<uint16_t>&,
                 const char* meaning) {
        each(name, list, meaning);
    }
};

std::set<std::string> known_units() {
    std::set<std::string> out{"ns", "rad/s", "J", "N*s", "N*m*s"};
    for (auto i = Quantity::none; i <= Quantity::inertia;
         i = static_cast<Quantity>(static_cast<int>(i) + 1))
        out.emplace(si_symbol(i));
    return out;
}

bool is_sentence(const std::string& text) {
    return text.size() > 1 && text.back() == '.' &&
           std::islower(static_cast<unsigned char>(text.front())) == 0 &&
           text.find_first_of("|\n") == std::string::npos;
}

TEST(Quantities, HaveANameOfTheirOwnAUnitAFrameAndASentence) {
    const std::set<std::string> units = known_units();
    std::set<std::string> lists;
    for (const List& list : Lists().all) {
        EXPECT_TRUE(lists.insert(list.name).second) << list.name;
        EXPECT_TRUE(is_sentence(list.meaning)) << list.name;
        EXPECT_FALSE(list.rows.empty()) << list.name;
        std::set<std::string> names;
        for (const auto& [term, type] : list.rows) {
            SCOPED_TRACE(list.name + ": " + term.name);
            EXPECT_TRUE(names.insert(term.name).second);
            EXPECT_TRUE(units.contains(term.unit)) << term.unit;
            EXPECT_TRUE(is_sentence(term.meaning)) << term.meaning;
            const bool has_axes = type.find('[') != std::string::npos;
            const std::string frame = term.frame;
            EXPECT_TRUE(has_axes ? frame == "W" || frame == "D" : frame.empty()) << frame;
        }
    }
}

std::string meaning(const Term& term) {
    const std::string name = term.name;
    if (name == "status") return std::string(term.meaning) + " The bits are listed below.";
    const std::string codes = codes_of(name, {});
    return term.meaning + (codes.empty() ? "" : " " + codes + ".");
}

std::string tables() {
    std::string out;
    for (const List& list : Lists().all) {
        out += fmt::format("## {}\n\n{}\n\n| name | type | unit | frame | meaning |\n", list.name,
                           list.meaning);
        out += "|---|---|---|---|---|\n";
        for (const auto& [term, type] : list.rows)
            out += fmt::format("| `{}` | {} | {} | {} | {} |\n", term.name, type, term.unit,
                               term.frame, meaning(term));
        out += "\n";
    }
    out += "## status\n\n| bit | meaning |\n|---|---|\n";
    for_each_status(kAllStatus, [&](Status bit) {
        out += fmt::format("| {} | {} |\n", static_cast<uint32_t>(bit), describe(bit).what);
    });
    return out;
}

/// Only the text before the tables is written by hand; the tables must match Frame::visit().
TEST(Quantities, AreTheReferences) {
    const std::string page = testing::read_file(kFile);
    const std::string made = page.substr(0, page.find("## tick")) + tables();
    if (std::getenv("DIHAPTIC_RENEW_QUANTITIES") != nullptr) {
        std::ofstream(kFile) << made;
    } else {
        EXPECT_EQ(page, made)
            << kFile << " says something else than visit(). Renew it in the same commit: "
            << "DIHAPTIC_RENEW_QUANTITIES=1 build/release/src/recording/recording_test "
            << "--gtest_filter='Quantities.*'";
    }
}

}  // namespace
}  // namespace dihaptic::recording::quantities_test
