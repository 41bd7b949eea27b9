// Tests expressions: values, dimensions and names are compared with hand-written cases, and
// arithmetic with Python; each mistake must give its message.
#include "task/expression/expression.h"
#include "base/number.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "base/random.h"
#include "testing/allocation_guard.h"
#include "testing/files.h"

namespace dihaptic::task::expression_test {
namespace {

/// Two fingers that hold a block over a table.
struct Grasp {
    Grasp() {
        last.time = std::chrono::milliseconds(1500);
        last.grip_force = 2.5;
        last.fingers.resize(2);
        last.fingers[0].p_WH = {-1, -1, -1};  // position in the last tick, which must not be used
        last.fingers[0].p_WP = {-0.02, 0, 0.05};
        last.fingers[1].normal_force = 2;
        last.fingers[1].buttons = 5;
        last.bodies.resize(3);
        last.bodies[1].X_WB.p = {0.1, 0.2, 0.06};
        last.bodies[1].v_WB = {0, 0.03, 0.04};
        last.bodies[2].X_WB.p = {0, 0, 1};
        last.joints.resize(2);
        last.joints[0].displacement = 0.03;
        last.joints[1].angle = 0.5;
        last.joints[1].f_B_W = {0, 0, 4};
        press(1, 3, 2);
        press(4, 1, 3);
        press(0, 1, 0.5);
        press(2, 3, 0);
        quantities.set(quantities.region(size_t{0}), Vec3(0.1, 0.2, 0.05));
        quantities.set(quantities.region(size_t{0}) + 3, 0.02);
        quantities.set(quantities.start(1), Vec3(0.1, 0.2, 0.02));
        quantities.set(quantities.define("wait", dimension(Quantity::time), Kind::draw).slot, 0.7);
        quantities.set(quantities.define("step", {}, Kind::factor).slot, -1);
        quantities.set(quantities.define("score", {}, Kind::variable).slot, 30);
        const Symbol surface = quantities.define_text("surface", {"silk", "suede"}, Kind::factor);
        quantities.set(surface.slot, quantities.text("suede"));
        quantities.set(Quantities::kTrial, 12);
    }
    void press(int a, int b, double force) {
        frame::ContactFrame& contact = last.contacts.emplace_back();
        contact.a = a;
        contact.b = b;
        contact.normal_force = force;
    }
    Expression compile(const std::string& text) {
        return Expression::compile(text, quantities, {"task.yaml", 7}, "when", diagnostics);
    }
    double value(const std::string& text) {
        const Expression expression = compile(text);
        for (const Problem& problem : diagnostics.problems()) ADD_FAILURE() << problem.text();
        quantities.update(last, handles);
        return expression(quantities.values());
    }

    Quantities quantities{
        {.fingers = {"thumb", "index"},
         .bodies = {"table", "block", "left plate"},
         .joints = {"drawer", "hinge"},
         .regions = {"goal", "far side"},
         .hands = {{"left", scene::first_fingers(2)}, {"one", scene::finger_set(1)}}}};
    frame::Frame last;
    std::vector<frame::Handle> handles{{{0, 0, 0.05}, {0.3, 0, 0.4}},
                                       {{0.04, 0, 0.07}, {0.01, 0, 0}}};
    Diagnostics diagnostics;
};

struct Case {
    const char* text;
    double value;
};

class Value : public ::testing::TestWithParam<Case> {};

TEST_P(Value, IsAsComputedByHand) {
    EXPECT_NEAR(Grasp().value(GetParam().text), GetParam().value, 1e-12) << GetParam().text;
}

INSTANTIATE_TEST_SUITE_P(
    Expression, Value,
    ::testing::Values(
        Case{"1 + 2 * 3 ^ 2", 19}, Case{"-2 ^ 2", -4},
        Case{"2 ^ 3 ^ 0.5", std::pow(2, std::sqrt(3))}, Case{"2 ^ -1", 0.5}, Case{"8 - 3 - 2", 3},
        Case{"(8 - (3 - 2)) / 7", 1}, Case{"-7 % 3", 2}, Case{"1 < 2 < 3", 1}, Case{"1 < 3 < 2", 0},
        Case{"not 1 < 2 or 2 >= 2 and 1 != 2", 1}, Case{"not not 1 < 2", 1},
        Case{"5 if 1 > 2 else 6 if 2 > 1 else 7", 6}, Case{".5e1", 5},
        Case{"min(3, 1, 2) + max(3, 1, 2) + clamp(7, 0, 5)", 9}, Case{"round(2.5) + sign(-3)", 2},
        Case{"atan2(1, 0) - 90 deg", 0}, Case{"hypot(3, 4) + abs(-1)", 6}, Case{"log(exp(2))", 2},
        // units
        Case{"5 mm + 1 m", 1.005}, Case{"20 mm/s", 0.02}, Case{"20 mm_s", 0.02},
        Case{"1 / 20 mm/s", 50}, Case{"9.81 m/s^2 * 2 s^2", 19.62}, Case{"3 N*s/m", 3},
        Case{"2 kg*m/s^2 == 2 N", 1}, Case{"sqrt(4 m^2) < 2001 mm", 1}, Case{"200ms", 0.2},
        Case{"block.z / 1 mm", 60}, Case{"min(1, 2, 3, block.z) < 61 mm", 1},
        // quantities measured in each tick
        Case{"grip_force", 2.5}, Case{"time", 1.5}, Case{"index.normal_force", 2},
        Case{"index.buttons % 8", 5}, Case{"block.position.y", 0.2}, Case{"block.speed", 0.05},
        Case{"block.x + block.y", 0.3}, Case{"block.orientation.w", 1},
        Case{"norm(block.velocity)", 0.05}, Case{"thumb.z", 0.05},
        Case{"thumb.handle_position.z", 0.05}, Case{"thumb.speed", 0.5},
        Case{"thumb.proxy_position.x", -0.02}, Case{"thumb.handle_velocity.x", 0.3},
        Case{"left.x", 0.02}, Case{"hand.position.z", 0.06}, Case{"one.speed", 0.01},
        Case{"\"left plate\".z", 1}, Case{"trial_num", 12}, Case{"index.shown.x", 0.04},
        Case{"distance(block, goal)", 0.01}, Case{"norm(2 * (block - goal) / 4)", 0.005},
        Case{"dot(thumb.handle_velocity, thumb.handle_velocity)", 0.25}, Case{"goal.radius", 0.02},
        Case{"drawer.displacement", 0.03}, Case{"hinge.angle > 20 deg", 1},
        Case{"hinge.force.z", 4}, Case{"hinge.force.z > 3 N and drawer.displacement < 4 cm", 1},
        Case{"block.z - block.start.z", 0.04}, Case{"goal.x", 0.1},
        // conditions
        Case{"inside(block, goal)", 1}, Case{"outside(thumb, goal)", 1},
        Case{"inside(hand, goal)", 0}, Case{"inside('left plate', \"far side\")", 0},
        Case{"touched(block)", 1}, Case{"touched(block, thumb)", 1}, Case{"touched(table)", 0},
        Case{"touched('left plate')", 0}, Case{"released(block, index)", 0},
        Case{"gripped(block)", 1}, Case{"gripped(block, left)", 1}, Case{"gripped(block, one)", 0},
        Case{"lifted(block)", 1}, Case{"lifted(block, 40.1 mm)", 0},
        Case{"lifted(block, 0.039)", 1}, Case{"still(index)", 1}, Case{"still(hand, 20 mm/s)", 0},
        Case{"still()", 0}, Case{"still(block, 0.06)", 1}, Case{"contact_force(block, table)", 0.5},
        Case{"contact_force(hand, block)", 5}, Case{"contact_force(block, index)", 3},
        // texts, draws, factors, variables
        Case{"surface == \"suede\"", 1}, Case{"'silk' == surface", 0}, Case{"surface != 'silk'", 1},
        Case{"wait + 200 ms", 0.9}, Case{"wait > 0.6 and step < 0", 1},
        Case{"10 * step + score", 20}, Case{"grip_force > 2 and block.z - 10 mm > 0.04", 1}));

TEST(Expression, UnitsHaveDimensions) {
    EXPECT_EQ(dimension(Quantity::damping), (Dimension{0, 1, -1}));
    EXPECT_EQ(dimension(Quantity::density), (Dimension{-3, 1, 0}));
    EXPECT_EQ(dimension(Quantity::turn_damping), (Dimension{2, 1, -1}));
    EXPECT_EQ(dimension(Quantity::angle), Dimension{});
    EXPECT_EQ(unit_in_si("ns").si, 1e-9);
    EXPECT_EQ(find_unit_in_si("mNm")->si, 1e-3);
    EXPECT_FALSE(find_unit_in_si("furlong").has_value());
    EXPECT_EQ(si_symbol(dimension(Quantity::acceleration)), "m/s^2");
    EXPECT_EQ(si_symbol(Dimension{2, 0, 0}), "m^2");
    EXPECT_EQ(si_symbol(Dimension{}), "1");
}

TEST(Expression, SaysWhatItIs) {
    Grasp grasp;
    EXPECT_EQ(grasp.compile("wait + 1").dimension(), dimension(Quantity::time));
    EXPECT_EQ(grasp.compile("2 N / (4 m)").dimension(), dimension(Quantity::stiffness));
    EXPECT_EQ(grasp.compile("2 * 3").dimension(), Dimension{});
    EXPECT_EQ(grasp.compile("wait > 1").type(), Expression::Type::truth);
    EXPECT_EQ(grasp.compile("surface").type(), Expression::Type::text);
    EXPECT_TRUE(grasp.compile("wait * step + goal.x / (1 m/s)").frozen());
    EXPECT_FALSE(grasp.compile("step + score").frozen());
    EXPECT_FALSE(grasp.compile("time_in_state > wait").follows_tick());
    EXPECT_TRUE(grasp.compile("touched(block)").follows_tick());
    EXPECT_TRUE(grasp.compile("still()").follows_tick());
    EXPECT_TRUE(grasp.diagnostics.problems().empty());
    EXPECT_TRUE(Expression().empty());
    EXPECT_EQ(Expression()({}), 0);
}

TEST(Expression, EveryQuantityOfTheFrameHasAName) {
    Grasp grasp;
    int found = 0;
    for (const std::string& name : grasp.quantities.names()) {
        Quantities copy = grasp.quantities;
        const bool rotation = name.ends_with("orientation");
        EXPECT_TRUE(copy.find(rotation ? name + ".w" : name).has_value()) << name;
        copy.update(grasp.last, grasp.handles);
        ++found;
    }
    EXPECT_GT(found, 100);
    // one device does not measure the orientation of its handle, and the list does not show which
    // device this is
    EXPECT_TRUE(std::isnan(grasp.value("index.torque_sent.x")));
    grasp.last.turns.resize(2);
    grasp.last.turns[1].t_sent_W.x() = 0.25;
    EXPECT_EQ(grasp.value("index.torque_sent.x"), 0.25);
    // a quantity used in two expressions is read only once
    EXPECT_EQ(grasp.quantities.pressing(1, 3), grasp.quantities.pressing(1, 3));
    EXPECT_NE(grasp.quantities.pressing(1, 3), grasp.quantities.pressing(1, 1));
    // no values are known before the first tick
    grasp.last = {};
    EXPECT_TRUE(std::isnan(grasp.value("block.z")));
    EXPECT_EQ(grasp.value("touched(block)"), 0);
}

struct Wrong {
    const char* text;
    int column;
    const char* said;
};

class MistakenExpression : public ::testing::TestWithParam<Wrong> {};

TEST_P(MistakenExpression, IsRefusedWithFileLineKeyColumnAndRemedy) {
    Grasp grasp;
    EXPECT_TRUE(grasp.compile(GetParam().text).empty());
    ASSERT_EQ(grasp.diagnostics.problems().size(), 1u) << GetParam().text;
    const Problem& problem = grasp.diagnostics.problems().front();
    const std::string begin =
        "task.yaml:7: error: when: column " + number_text(GetParam().column) + ": ";
    EXPECT_TRUE(problem.text().starts_with(begin)) << problem.text();
    EXPECT_NE(problem.text().find(GetParam().said), std::string::npos) << problem.text();
    EXPECT_FALSE(problem.remedy.empty()) << problem.text();
}

INSTANTIATE_TEST_SUITE_P(
    Expression, MistakenExpression,
    ::testing::Values(
        Wrong{"", 1, "ends where a value"}, Wrong{"1 +", 4, "ends where a value"},
        Wrong{"(1 + 2", 7, "')' is missing"}, Wrong{"1 2", 3, "'2' is not expected"},
        Wrong{"grip_force >> 2", 13, "'>' is given where"}, Wrong{"1 = 2", 3, "Write =="},
        Wrong{"1 < 2 && 2 < 3", 7, "Write and"}, Wrong{"!touched(block)", 1, "Write not"},
        Wrong{"2 ** 3", 3, "Write ^"}, Wrong{"1 ? 2 : 3", 3, "a if c else b"},
        Wrong{"block#z", 6, "'#' has no meaning here"}, Wrong{"'open", 1, "Close the quotes"},
        Wrong{"1e999", 1, "too large"}, Wrong{"1 if 2 > 1", 11, "'else' is missing"},
        Wrong{"grip_forc > 2", 1, "Did you mean grip_force?"},
        Wrong{"1 + blok.z", 5, "Did you mean block.z?"},
        Wrong{"block.handle_position.x > 0", 1, "is not a quantity"},
        Wrong{"block.orientation > 0", 1, "is not a quantity"},
        Wrong{"m > 1", 1, "Write it after a number"},
        Wrong{"touchd(block)", 1, "Did you mean touched?"}, Wrong{"sqrt()", 1, "has 0 arguments"},
        Wrong{"grip_force > block.z", 12, "one side is in N, but the other is in m"},
        Wrong{"grip_force > 10 * step", 12, "but the other is a pure number"},
        Wrong{"min(wait, 1, block.z) > 0", 14, "but the other is in m"},
        Wrong{"block.z < 1 < wait", 13, "but the other is in s"},
        Wrong{"wait + 5 mm", 6, "one side is in s, but the other is in m"},
        Wrong{"sin(wait)", 5, "x / (1 s)"},
        Wrong{"wait ^ step", 8, "Write a number as the exponent"},
        Wrong{"sqrt(wait)", 6, "no valid unit"}, Wrong{"2 ^ wait", 5, "but must be a pure number"},
        Wrong{"block > 1", 7, "one side is a vector"}, Wrong{"block.position", 1, "is a vector"},
        Wrong{"norm(wait)", 6, "but must be a vector"},
        Wrong{"block + 1", 1, "but must be a number"}, Wrong{"1 and 2 > 1", 1, "Compare it"},
        Wrong{"not grip_force", 5, "Compare it"}, Wrong{"(1 < 2) + 1", 2, "1 if ... else 0"},
        Wrong{"(1 < 2) < (2 < 3)", 9, "Use only == and !="},
        Wrong{"surface == silk", 12, "Put texts in quotes: \"silk\"."},
        Wrong{"surface == 'sued'", 12, "Did you mean \"suede\"?"},
        Wrong{"surface == 1", 9, "quoted texts"},
        Wrong{"surface < 'silk'", 9, "Use only == and !="},
        Wrong{"inside(blok, goal)", 8, "Did you mean block?"},
        Wrong{"inside(block)", 13, "',' is missing"},
        Wrong{"inside(block, gaol)", 15, "is not a region"},
        Wrong{"inside(block, 3)", 15, "a region is missing"},
        Wrong{"touched(thumb)", 9, "'thumb' is not a body"},
        Wrong{"touched(block, table)", 16, "neither a finger nor a hand"},
        Wrong{"lifted(block, 2 N)", 15, "but the other is in m"},
        Wrong{"still(20 mm/s)", 7, "is missing"}));

TEST(Expression, NumbersWithoutAUnitThatAreHardlyMeantInSiAreRemarkedOn) {
    const auto remarks = [](const std::string& text) {
        Grasp grasp;
        EXPECT_FALSE(grasp.compile(text).empty());
        EXPECT_FALSE(grasp.diagnostics.has_errors());
        return grasp.diagnostics.problems();
    };
    const auto fast = remarks("norm(block.velocity) > 40");
    ASSERT_EQ(fast.size(), 1u);
    EXPECT_EQ(fast[0].what, "column 24: 40 has no unit and is read in m/s");
    EXPECT_EQ(fast[0].remedy, "Write its unit after it, as in 40 mm/s.");
    EXPECT_EQ(remarks("block.z > -50 and 700 > wait").size(), 2u);
    for (const char* meant : {"norm(block.velocity) > 0.04", "norm(block.velocity) > 40 m/s",
                              "wait < 3", "grip_force > 40", "score > 1000", "block.z > 2"})
        EXPECT_TRUE(remarks(meant).empty()) << meant;
}

TEST(Expression, NestingAndLengthHaveLimits) {
    const auto said = [](const std::string& text) {
        Grasp grasp;
        grasp.compile(text);
        return grasp.diagnostics.problems().empty() ? "" : grasp.diagnostics.problems()[0].text();
    };
    EXPECT_NE(
        said(std::string(900, '(') + "1" + std::string(900, ')')).find("too many nested brackets"),
        std::string::npos);
    EXPECT_NE(said(std::string(1500, '-') + "1").find("too many signs"), std::string::npos);
    EXPECT_NE(said("1" + std::string(3000, ' ')).find("is too long"), std::string::npos);
    std::string deep = "score";
    for (int i = 0; i < 36; ++i) deep = "score + (" + deep + ")";
    EXPECT_NE(said(deep).find("is too long"), std::string::npos);
    std::string wide = "score";
    for (int i = 0; i < 200; ++i) wide += " + score";
    EXPECT_EQ(said(wide), "");
    // part of a chain is evaluated twice, part of that part four times, and so on
    std::string chain = "score";
    for (int i = 0; i < 15; ++i) chain = "(1 if 1 < " + chain + " < 2 else 2)";
    EXPECT_NE(said(chain).find("is too long"), std::string::npos);
}

/// Returns a random integer from 0 to n - 1.
size_t below(Random& random, size_t n) {
    return static_cast<size_t>(random.uniform(0, static_cast<double>(n)));
}

/// Writes random expressions in x, y and z.
class Writer {
  public:
    explicit Writer(Random& random) : random_(random) {}

    std::string number(int depth) {
        if (depth == 0) return leaf();
        switch (below(random_, 9)) {
            case 0:
                return leaf();
            case 1:
                return "-" + bracketed(number(depth - 1), 3);
            case 2:
                return one_of({"abs", "sqrt", "exp", "log", "sin", "cos", "tan", "floor", "ceil",
                               "round", "sign"}) +
                       "(" + number(depth - 1) + ")";
            case 3:
                return one_of({"min", "max", "hypot", "atan2"}) + "(" + number(depth - 1) + ", " +
                       number(depth - 1) + ")";
            case 4:
                return "clamp(" + number(depth - 1) + ", " + number(depth - 1) + ", " +
                       number(depth - 1) + ")";
            case 5:
                return bracketed(number(depth - 1), 2) + " if " + truth(depth - 1) + " else " +
                       number(depth - 1);
            default:
                return bracketed(number(depth - 1), 3) +
                       one_of({" + ", " - ", " * ", " / ", " % ", "^", "+", "*"}) +
                       bracketed(number(depth - 1), 3);
        }
    }

    std::string truth(int depth) {
        if (depth == 0) return leaf() + comparison() + leaf();
        switch (below(random_, 5)) {
            case 0:
                return "not " + bracketed(truth(depth - 1), 2);
            case 1:
            case 2:
                return bracketed(truth(depth - 1), 2) + one_of({" and ", " or "}) +
                       bracketed(truth(depth - 1), 2);
            case 3:
                return compared(depth) + comparison() + compared(depth) + comparison() +
                       compared(depth);
            default:
                return compared(depth) + comparison() + compared(depth);
        }
    }

  private:
    /// Returns the text in brackets or, in one out of `often` cases, without brackets, unless
    /// removing them would change which part is a number and which is a condition.
    std::string bracketed(const std::string& text, size_t often) {
        const bool binds =
            text.find(" if ") == std::string::npos && text.find(" or ") == std::string::npos &&
            text.find(" and ") == std::string::npos && text.find("not ") == std::string::npos;
        return binds && below(random_, often) == 0 ? text : "(" + text + ")";
    }
    std::string compared(int depth) { return bracketed(number(depth - 1), 2); }
    std::string comparison() { return one_of({" < ", " <= ", " > ", " >= ", " == ", " != "}); }
    std::string leaf() {
        if (below(random_, 2) == 0) return one_of({"x", "y", "z"});
        return one_of({"0", "1", "2", "3", "0.5", "7.25", "1e3", "2.5e-3", ".125", "10"});
    }
    std::string one_of(const std::vector<std::string>& words) {
        return words[below(random_, words.size())];
    }

    Random& random_;
};

/// Whether two values agree to within the tolerance of the test.
bool agree(double a, double b) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
    return a == b || std::abs(a - b) <= 1e-12 * std::max(std::abs(a), std::abs(b));
}

TEST(Expression, TenThousandAgreeWithPython) {
    constexpr size_t kExpressions = 10000;
    Quantities quantities;
    const std::array names{"x", "y", "z"};
    for (const char* name : names) quantities.define(name, {}, Kind::draw);
    const testing::TemporaryFolder folder;
    Random random(20, "expressions");
    Writer writer(random);
    std::vector<std::string> texts;
    std::vector<double> ours;
    size_t allocations = 0;
    size_t refused = 0;
    {
        std::ofstream file(folder.file("expressions.txt"));
        file << "x y z\n";
        while (texts.size() < kExpressions) {
            const std::string text = below(random, 3) == 0 ? writer.truth(3) : writer.number(4);
            Diagnostics diagnostics;
            const Expression expression =
                Expression::compile(text, quantities, {}, "", diagnostics);
            if (diagnostics.has_errors()) {  // Python computes these, but nobody means them
                const std::string told = diagnostics.problems().front().text();
                ASSERT_TRUE(told.find("that is not a number") != std::string::npos ||
                            told.find("by which nothing can be divided") != std::string::npos)
                    << text << "\n"
                    << told;
                ++refused;
                continue;
            }
            ASSERT_TRUE(diagnostics.problems().empty()) << text;
            texts.push_back(text);
            for (const char* name : names) {
                const double value = below(random, 8) == 0 ? 0 : 3 * random.normal();
                quantities.set(quantities.find(name)->slot, value);
                file << number_text(value) + " ";
            }
            file << "\t" << texts.back() << "\n";
            ours.emplace_back();
            const testing::AllocationGuard guard;
            ours.back() = expression(quantities.values());
            allocations += guard.count();
        }
    }
    EXPECT_EQ(allocations, 0u);
    EXPECT_LT(refused, kExpressions / 5);
    const std::string command = "/usr/bin/python3 src/task/test/evaluate.py " +
                                folder.file("expressions.txt") + " > " + folder.file("values.txt");
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::ifstream values(folder.file("values.txt"));
    int finite = 0;
    std::string line;
    for (size_t i = 0; i < texts.size(); ++i) {
        ASSERT_TRUE(std::getline(values, line)) << i;
        const double theirs =
            line == "nan" ? std::numeric_limits<double>::quiet_NaN() : any_number(line).value();
        EXPECT_TRUE(agree(ours[i], theirs)) << texts[i] << "\n" << ours[i] << " " << theirs;
        finite += std::isfinite(theirs) ? 1 : 0;
    }
    EXPECT_GT(finite, static_cast<int>(kExpressions / 2));
}

/// The grip force increases by 7 N/s and, after a gap, by 3 N/s.
TEST(Expression, RatesAreDifferencesOverTheLastTicks) {
    Grasp grasp;
    const Expression rate = grasp.compile("rate(grip_force)");
    EXPECT_EQ(rate.dimension(), dimension(Quantity::force) / dimension(Quantity::time));
    EXPECT_TRUE(rate.follows_tick());
    const auto at = [&](int64_t tick, double force) {
        grasp.last.sequence = tick;
        grasp.last.time = std::chrono::milliseconds(tick);
        grasp.last.grip_force = force;
        grasp.quantities.update(grasp.last, grasp.handles);
        return rate(grasp.quantities.values());
    };
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(std::isnan(at(i, 7e-3 * i))) << i;
    for (int i = 10; i < 25; ++i) EXPECT_NEAR(at(i, 7e-3 * i), 7, 1e-9) << i;
    for (int i = 30; i < 40; ++i) EXPECT_TRUE(std::isnan(at(i, 3e-3 * i))) << i;
    for (int i = 40; i < 60; ++i) EXPECT_NEAR(at(i, 3e-3 * i), 3, 1e-9) << i;
}

TEST(Expression, OnlyWhatIsMeasuredInATickHasARate) {
    for (const char* text : {"rate(3 N)", "rate(grip_force + 1 N)", "rate(score)", "rate(block)",
                             "rate(goal.x)", "rate(touched(block))", "rate()"}) {
        Grasp grasp;
        EXPECT_TRUE(grasp.compile(text).empty()) << text;
        EXPECT_TRUE(grasp.diagnostics.has_errors()) << text;
    }
    Grasp grasp;
    for (const char* text :
         {"rate(block.z)", "rate(index.speed)", "rate(contact_force(block, hand))"})
        EXPECT_FALSE(grasp.compile(text).empty()) << text;
}

TEST(Expression, AllocatesNothingInTheTick) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    Grasp grasp;
    const Expression expression = grasp.compile(
        "grip_force > 2 and gripped(block, left) and inside(block, goal) and still(index) and "
        "contact_force(block, hand) > 1 and surface == 'suede' and hand.shown.x < 10 and "
        "sin(time_in_state / 1 s) < 2 ^ 0.5 and not rate(grip_force) > 1 N / 1 s");
    ASSERT_FALSE(expression.empty());
    const testing::AllocationGuard guard;
    double sum = 0;
    for (int i = 0; i < 1000; ++i) {
        grasp.quantities.set(Quantities::kTimeInState, i * 1e-3);
        grasp.quantities.update(grasp.last, grasp.handles);
        sum += expression(grasp.quantities.values());
    }
    EXPECT_EQ(guard.count(), 0u);
    EXPECT_EQ(sum, 1000);
}

/// Each of many fingers must be distinguished from every other finger, even if their indices differ
/// by a multiple of 32.
TEST(Expression, AnyNumberOfFingersAreToldApart) {
    for (const size_t count : {2, 31, 32, 33, 64, 65, 200}) {
        SCOPED_TRACE(count);
        Quantities::Names names;
        for (size_t i = 0; i < count; ++i) names.fingers.push_back(fmt::format("f{}", i));
        names.bodies = {"block"};
        names.hands = {{"last", scene::finger_set(count - 1)}};
        Quantities quantities(names);
        Diagnostics diagnostics;
        frame::Frame last;
        last.bodies.resize(1);
        last.fingers.resize(count);
        last.contacts.resize(2);
        std::vector<frame::Handle> handles(count);
        for (size_t i = 0; i < count; ++i) handles[i].p_WH.x() = static_cast<double>(i);
        const auto value = [&](const std::string& text) {
            const Expression expression =
                Expression::compile(text, quantities, {"task.yaml", 7}, "when", diagnostics);
            for (const Problem& problem : diagnostics.problems()) ADD_FAILURE() << problem.text();
            quantities.update(last, handles);
            return expression(quantities.values());
        };
        for (const size_t touching : {size_t{0}, count / 2, count - 1}) {
            last.contacts[0] = {.a = 0, .b = static_cast<int>(1 + touching), .normal_force = 2};
            last.contacts[1] = last.contacts[0];  // a second contact point on the same finger
            double touched = 0;
            for (size_t i = 0; i < count; ++i) {
                const std::string finger = fmt::format("f{}", i);
                const double here = i == touching;
                EXPECT_EQ(value("1 if touched(block, " + finger + ") else 0"), here) << finger;
                EXPECT_EQ(value("contact_force(block, " + finger + ") / 1 N"), 4 * here) << finger;
                touched += value("1 if touched(block, " + finger + ") else 0");
            }
            EXPECT_EQ(touched, 1);
            EXPECT_EQ(value("1 if gripped(block) else 0"), 0);
            EXPECT_EQ(value("1 if touched(block) else 0"), 1);
            EXPECT_EQ(value("1 if touched(block, last) else 0"), touching == count - 1);
        }
        EXPECT_NEAR(value("hand.x / 1 m"), static_cast<double>(count - 1) / 2, 1e-9);
        EXPECT_EQ(value("last.x / 1 m"), static_cast<double>(count - 1));
        last.contacts[0] = {.a = 0, .b = 1, .normal_force = 2};
        last.contacts[1] = {.a = 0, .b = static_cast<int>(count), .normal_force = 2};
        EXPECT_EQ(value("1 if gripped(block) else 0"), 1);
    }
}

}  // namespace
}  // namespace dihaptic::task::expression_test
