#include "base/field_reader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/field_table.h"
#include "base/field_writer.h"

namespace dihaptic::field_reader_test {
namespace {

enum class Fruit { apple, pear };
constexpr auto enum_names(Fruit) {
    return std::array{"apple", "pear"};
}

struct Inner {
    double stiffness = 100;
    std::optional<double> damping;
    template <class V>
    void visit(V& v) {
        v("stiffness", stiffness, Field::of(Quantity::stiffness).positive());
        v("damping", damping, Field::of(Quantity::damping).at_least(0));
    }
};

struct Outer {
    std::string name;
    Vec3 size{1, 2, 3};
    int count = 4;
    bool on = false;
    Fruit fruit = Fruit::apple;
    Inner inner;
    std::vector<Inner> list;
    Mat3 matrix = Mat3::Zero();
    Texts texts;
    template <class V>
    void visit(V& v) {
        v("name", name, Field::text().required());
        v("size", size, Field::length().positive());
        v("count", count, Field::number().at_least(1).at_most(10));
        v("on", on);
        v("fruit", fruit);
        v("inner", inner);
        v("list", list);
        v("matrix", matrix, Field::of(Quantity::stiffness).within(-10, 10));
        v("texts", texts);
    }
};

struct Read {
    Outer value;
    Diagnostics diagnostics;
    Origins origins;

    explicit Read(const std::string& yaml) {
        read_fields(value, parse_yaml(yaml, "test.yaml"), diagnostics, &origins);
    }
    /// The text of the only problem. The test fails unless there is exactly one.
    std::string problem() const {
        EXPECT_EQ(diagnostics.problems().size(), 1u);
        return diagnostics.problems().empty() ? "" : diagnostics.problems().front().text();
    }
};

TEST(FieldReader, ReadsValuesInAnyUnitOfTheRightKind) {
    const Read in(
        "name: a\nsize_mm: [10, 20, 30]\ncount: 7\non: yes\nfruit: pear\ninner: {stiffness_N_mm: "
        "2}\n"
        "list: [{stiffness_N_m: 1}, {damping_Ns_m: 0}]\n");
    EXPECT_TRUE(in.diagnostics.problems().empty());
    EXPECT_EQ(in.value.name, "a");
    EXPECT_TRUE(in.value.size.isApprox(Vec3(0.01, 0.02, 0.03)));
    EXPECT_EQ(in.value.count, 7);
    EXPECT_TRUE(in.value.on);
    EXPECT_EQ(in.value.fruit, Fruit::pear);
    EXPECT_EQ(in.value.inner.stiffness, 2000);
    ASSERT_EQ(in.value.list.size(), 2u);
    EXPECT_EQ(in.value.list[1].damping, 0.0);
    EXPECT_EQ(in.value.list[1].stiffness, 100);
}

TEST(FieldReader, KeepsWhatTheFileDoesNotGive) {
    const Read in("name: a\n");
    EXPECT_EQ(in.value.count, 4);
    EXPECT_FALSE(in.value.inner.damping);
}

struct Bad {
    const char* yaml;
    const char* says;  // a part of the expected message
};
void PrintTo(const Bad& bad, std::ostream* out) {
    *out << bad.says;
}

class BadInput : public ::testing::TestWithParam<Bad> {};

TEST_P(BadInput, IsReportedWithLineKeyAndRemedy) {
    EXPECT_NE(Read(GetParam().yaml).problem().find(GetParam().says), std::string::npos)
        << Read(GetParam().yaml).problem();
}

INSTANTIATE_TEST_SUITE_P(
    FieldReader, BadInput,
    ::testing::Values(
        Bad{"count: 3\n", "test.yaml:1: error: name: is missing. Add name."},
        Bad{"name: a\ncuont: 3\n",
            "test.yaml:2: error: cuont: is not known here. Did you mean count?"},
        Bad{"name: a\nsize: [1, 2, 3]\n",
            "test.yaml:2: error: size: needs its unit in the key. Write size_m"},
        Bad{"name: a\nsize_kg: [1, 2, 3]\n",
            "size_kg: is not a unit of length. Write size_m, size_mm, size_cm or size_um."},
        Bad{"name: a\nsize_mm: [1, 2]\n",
            "size_mm: must be three numbers. Write size_mm: [x, y, z]."},
        Bad{"name: a\nsize_mm: [1, 2, x]\n", "must be a number, but is 'x'"},
        Bad{"name: a\nsize_mm: [1, 2, 3 mm]\n", "Write the number alone; its unit is in the key."},
        Bad{"name: a\nsize_mm: [1, -2, 3]\n", "size_mm: must be positive, but is -2"},
        Bad{"name: a\nsize_m: [1, 1, 1]\nsize_mm: [1, 1, 1]\n",
            "size_mm: the same size is also given as size_m"},
        Bad{"name: a\ncount: 11\n", "count: must be at least 1 and at most 10, but is 11"},
        Bad{"name: a\ncount: 2.5\n", "must be a whole number"},
        Bad{"name: a\ncount: nan\n", "must be a number, but is 'nan'"},
        Bad{"name: a\ncount: [1]\n", "must be a number, but is a list"},
        Bad{"name: a\non: maybe\n", "must be yes or no"},
        Bad{"name: a\nfruit: plum\n", "'plum' is not known. Use apple or pear."},
        Bad{"name: a\ninner: 3\n", "inner: must have keys of its own"},
        Bad{"name: a\nlist: 3\n", "list: must be a list"},
        Bad{"name: a\nlist: [{stiffness_N_m: 0}]\n", "stiffness_N_m: must be positive, but is 0"},
        Bad{"name: [a]\n", "name: must be a single word or text"},
        Bad{"name: ''\n", "test.yaml:1: error: name: is empty"},
        Bad{"name: a\nmatrix_N_m: [1, 2, 3]\n",
            "matrix_N_m: must be three rows of three numbers. Write matrix_N_m: [[0, 0, 0], "},
        Bad{"name: a\nmatrix_N_m: [[1, 2, 3], [1, 2, 3], [1, 2]]\n", "three rows of three"},
        Bad{"name: a\nmatrix_N_m: [[1, 2, 3], [1, 20, 3], [1, 2, 3]]\n",
            "matrix_N_m: must be at least -10 and at most 10, but is 20"},
        Bad{"name: a\nmatrix: [[1, 2, 3], [1, 2, 3], [1, 2, 3]]\n", "needs its unit in the key"},
        Bad{"name: a\ntexts: { a: 1 }\n",
            "texts: must be a text or a list of texts. Write texts: a"},
        Bad{"name: a\ntexts: [a, [b]]\n", "texts: must be a single word or text"},
        Bad{"name: a\ncount:\n", "must be a number, but is nothing"}));

struct Renamed {
    double wait = 0;  // [s]
    template <class V>
    void visit(V& v) {
        v("wait", wait, Field::of(Quantity::time).required().formerly("hold"));
    }
};

TEST(FieldReader, AnOldNameIsReadWithAWarningAndWithoutOneInWhatWasFrozen) {
    const Node node = parse_yaml("hold_ms: 250\n", "old.yaml");
    Renamed read;
    Diagnostics frozen(UnknownKeys::are_left_out);
    read_fields(read, node, frozen);
    EXPECT_TRUE(frozen.problems().empty());
    EXPECT_DOUBLE_EQ(read.wait, 0.25);
    Diagnostics written;
    read.wait = 0;
    read_fields(read, node, written);
    EXPECT_DOUBLE_EQ(read.wait, 0.25);
    EXPECT_FALSE(written.has_errors());
    ASSERT_EQ(written.problems().size(), 1u);
    EXPECT_EQ(written.problems()[0].key, "hold_ms");
    EXPECT_EQ(written.problems()[0].place.line, 1);
    EXPECT_EQ(written.problems()[0].what, "is now called wait_ms");
    Diagnostics both;
    read_fields(read, parse_yaml("wait_ms: 100\nhold_ms: 250\n", "both.yaml"), both);
    EXPECT_TRUE(both.has_errors());
    EXPECT_DOUBLE_EQ(read.wait, 0.1);
}

TEST(FieldReader, ReportsAllProblemsOfAFile) {
    const Read in("cuont: 3\nfruit: plum\n");
    EXPECT_EQ(in.diagnostics.problems().size(), 3u);  // the third problem is the missing name
    EXPECT_THROW(in.diagnostics.throw_if_errors(), Error);
}

TEST(FieldReader, SaysWhichWordsAreKnownWhereOneIsNot) {
    const Read in("cuont: 3\nsize_mm: 3\nfruit: plum\nname: x\n");
    const auto words_of = [&](const std::string& key) {
        std::string words;
        for (const Problem& problem : in.diagnostics.problems()) {
            if (problem.key != key) continue;
            for (const Choice& choice : problem.choices) words += choice.word + " ";
        }
        return words;
    };
    EXPECT_NE(words_of("cuont").find("count "), std::string::npos);
    EXPECT_EQ(words_of("cuont").find("size"), std::string::npos) << "that is given";
    EXPECT_NE(words_of("fruit"), "") << "its names";
}

TEST(FieldReader, RemembersWhereEachSettingCameFromAndLetsLaterFilesOverride) {
    Inner inner;
    Diagnostics diagnostics;
    Origins origins;
    read_fields(inner, parse_yaml("stiffness_N_m: 5\ndamping_Ns_m: 1\n", "first.yaml"), diagnostics,
                &origins);
    read_fields(inner, parse_yaml("\nstiffness_N_m: 7\n", "second.yaml"), diagnostics, &origins);
    EXPECT_EQ(inner.stiffness, 7);
    EXPECT_EQ(inner.damping, 1.0);
    EXPECT_EQ(origins["stiffness"], "second.yaml:2");
    EXPECT_EQ(origins["damping"], "first.yaml:2");
    const Table table = list_fields(inner, origins);
    EXPECT_EQ(to_csv(table),
              "setting,value,origin\nstiffness_N_m,7,second.yaml:2\ndamping_Ns_m,1,first.yaml:2\n");
}

TEST(FieldWriter, WhatIsWrittenReadsBackToTheBit) {
    Outer out;
    out.name = "a: \"strange\" name";
    out.size = {0.1, 1.0 / 3, 1e-17};
    out.inner.damping = 0.1 + 0.2;
    out.list.resize(2);
    const Read in(to_yaml(write_fields(out)));
    EXPECT_TRUE(in.diagnostics.problems().empty());
    EXPECT_EQ(in.value.name, out.name);
    EXPECT_EQ(in.value.size, out.size);
    EXPECT_EQ(in.value.inner.damping, out.inner.damping);
    EXPECT_EQ(in.value.list.size(), 2u);
}

TEST(FieldReader, ReadsMatricesByRowsAndTextsWithOrWithoutAList) {
    const Read one(
        "name: a\nmatrix_N_mm: [[1e-3, 2e-3, 0], [0, 0, 5e-3], [0, 0, 0]]\ntexts: b c\n");
    EXPECT_TRUE(one.diagnostics.problems().empty());
    EXPECT_EQ(one.value.matrix(0, 1), 2);
    EXPECT_EQ(one.value.matrix(1, 2), 5);
    EXPECT_EQ(one.value.texts, Texts({"b c"}));
    const Read two(to_yaml(write_fields(one.value)));
    EXPECT_EQ(two.value.matrix, one.value.matrix);
    EXPECT_EQ(two.value.texts, one.value.texts);
    EXPECT_NE(to_yaml(write_fields(one.value)).find("texts: b c"), std::string::npos);
    const Read more("name: a\ntexts: [b, c]\n");
    EXPECT_EQ(more.value.texts, Texts({"b", "c"}));
    EXPECT_EQ(Read(to_yaml(write_fields(more.value))).value.texts, more.value.texts);
    EXPECT_TRUE(Read("name: a\ntexts: ''\n").value.texts.empty());
}

TEST(Node, ReportsBrokenYamlWithItsLine) {
    try {
        parse_yaml("a: 1\nb: [1, 2\nc: 3\n", "broken.yaml");
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("broken.yaml:"), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find("is not YAML"), std::string::npos) << e.what();
    }
}

TEST(Node, ReportsAKeyThatIsBeingTypedInItsLine) {
    const auto said = [](const std::string& yaml) {
        try {
            parse_yaml(yaml, "typed.yaml");
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_EQ(
        said("a: 1\nmas\n# a remark\n\nb: 2\n"),
        "typed.yaml:2: error: mas: is a key without a value. Write e.g. mas: 1, with a colon.");
    EXPECT_TRUE(said("a: 1\nb\nc: [1, 2\nd: 3\n").starts_with("typed.yaml:")) << "another mistake";
    EXPECT_NE(said("a:\n  - left\n  b: 2\n").find("is not YAML"), std::string::npos)
        << "left is an item of a list, not a key";
}

TEST(Node, RefusesAKeyGivenTwice) {
    try {
        parse_yaml("a: 1\nb: 2\na: 3\n", "twice.yaml");
        FAIL();
    } catch (const Error& e) {
        EXPECT_STREQ(e.what(),
                     "twice.yaml:3: error: a: is given twice. Keep one of the two lines.");
    }
}

/// The message with which parse_yaml() refuses a text.
std::string refusal_of(const std::string& yaml) {
    try {
        parse_yaml(yaml, "far.yaml");
    } catch (const Error& e) {
        return e.what();
    }
    return "nothing";
}

TEST(Node, RefusesAliasesWithoutEnd) {
    std::string doubling = "a0: &a0 [x, x]\n";
    for (int i = 0; i < 30; ++i) doubling += fmt::format("a{1}: &a{1} [*a{0}, *a{0}]\n", i, i + 1);
    EXPECT_TRUE(
        refusal_of(doubling).starts_with("far.yaml:16: error: is too large: from here on "
                                         "it has more than 500000 keys and values."))
        << refusal_of(doubling);
    EXPECT_TRUE(refusal_of("a: &a\n  - *a\n")
                    .starts_with(
                        "far.yaml:2: error: an alias (*name) is inside the part that it refers to"))
        << refusal_of("a: &a\n  - *a\n");
}

TEST(Node, RefusesWhatIsNestedTooDeeply) {
    EXPECT_EQ(refusal_of(std::string(32, '[') + std::string(32, ']')), "nothing");
    // brackets that are never closed, and levels inside an alias
    const std::string half = std::string(17, '[') + "x" + std::string(17, ']');
    const std::string twice =
        "a: &a " + half + "\nb: " + std::string(17, '[') + "*a" + std::string(17, ']') + "\n";
    for (const std::string& yaml : {std::string(100'000, '['), std::string(100'000, '{'), twice}) {
        EXPECT_NE(refusal_of(yaml).find("error: is nested too deeply"), std::string::npos)
            << refusal_of(yaml);
    }
    EXPECT_TRUE(refusal_of(twice).starts_with("far.yaml:2:")) << refusal_of(twice);
}

TEST(Node, RepeatsWhatAnAliasNames) {
    const Node root = parse_yaml("a: &a [1, {b: &b 2}]\nc: *a\n*b : *b\n", "alias.yaml");
    ASSERT_EQ(root.entries.size(), 3U);
    EXPECT_EQ(root.find("c")->items[1].find("b")->scalar, "2");
    EXPECT_EQ(root.find("c")->place.line, 2);
    EXPECT_EQ(root.find("2")->scalar, "2");
}

TEST(Node, RefusesASecondDocument) {
    try {
        parse_yaml("a: 1\n---\nb: 2\n", "two.yaml");
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("two.yaml:3: error: a second YAML document"),
                  std::string::npos)
            << e.what();
    }
}

TEST(Node, RefusesAStrayComma) {
    EXPECT_THROW(parse_yaml(",", "comma.yaml"), Error);  // reading this text used to run for ever
    EXPECT_THROW(parse_yaml("{ a: 1 }, { b: 2 }", "comma.yaml"), Error);
    EXPECT_EQ(parse_yaml("", "empty.yaml").kind, Node::Kind::null);
}

TEST(Node, SaysWhyAFileCannotBeRead) {
    try {
        read_yaml("/nowhere/scene.yaml");
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("No such file"), std::string::npos) << e.what();
    }
}

struct Placed {
    double size = 0;
    double size_ratio = 1;
    Place place;
    template <class V>
    void visit(V& v) {
        v("size", size, Field::length());
        v("size_ratio", size_ratio);
    }
};

TEST(FieldReader, AProblemWithAFieldIsInItsKeysLine) {
    Placed value;
    Diagnostics diagnostics;
    read_fields(value, parse_yaml("\nsize_ratio: 2\nsize_mm:\n  3\n", "a.yaml"), diagnostics);
    diagnostics.error(value.place, "size", "is odd", "Mend it.");
    diagnostics.warning(value.place, "size_mm", "is odd", "Mend it.");
    diagnostics.error(value.place, "size_ratio", "is odd", "Mend it.");
    diagnostics.error(value.place, "colour", "is missing", "Add it.");
    std::string said;
    for (const Problem& problem : diagnostics.problems()) said += problem.text() + "\n";
    EXPECT_EQ(said,
              "a.yaml:3: error: size: is odd. Mend it.\n"
              "a.yaml:3: warning: size_mm: is odd. Mend it.\n"
              "a.yaml:2: error: size_ratio: is odd. Mend it.\n"
              "a.yaml:2: error: colour: is missing. Add it.\n");
    EXPECT_EQ(Error(value.place, "size", "is odd", "").problems().front().place.line, 3);
}

}  // namespace
}  // namespace dihaptic::field_reader_test
