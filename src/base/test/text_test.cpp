// Tests that text that was written is read back unchanged.
#include "base/text.h"

#include <gtest/gtest.h>

#include <random>

#include "base/diagnostics.h"
#include "base/node.h"
#include "base/table.h"
#include "base/temporary_folder.h"
#include "base/text_file.h"

namespace dihaptic::text_test {
namespace {

TEST(Text, KnowsEachFormOfUtf8) {
    for (const char* whole : {"a", "\xc2\xa0", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf",
                              "\xee\x80\x80", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbd"}) {
        EXPECT_EQ(utf8_length(whole), std::string_view(whole).size()) << whole;
        EXPECT_FALSE(find_fault(whole)) << whole;
    }
    for (const char* broken :
         {"\x80", "\xc0\xaf", "\xc1\xbf", "\xc3", "\xe0\x9f\xbf", "\xe2\x82", "\xed\xa0\x80",
          "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5", "\xff", "\xe2\x82q"}) {
        EXPECT_EQ(utf8_length(broken), 0u);
        EXPECT_TRUE(find_fault(broken));
    }
}

TEST(Text, RefusesControlCharacters) {
    for (int code = 1; code < 0xa0; ++code) {
        if (code == 0x20) code = 0x7f;
        const std::string text = code < 0x80 ? std::string(1, static_cast<char>(code))
                                             : std::string("\xc2") + static_cast<char>(code);
        const bool is_white = code == '\t' || code == '\n';
        EXPECT_EQ(find_fault(text).has_value(), !is_white) << code;
        EXPECT_TRUE(find_fault(text, Lines::one)) << code;
    }
    // right-to-left override, isolate and line separator are allowed in pages, but not in names
    for (const char* text : {"a\xe2\x80\xae"
                             "b",
                             "a\xe2\x81\xa7"
                             "b",
                             "a\xe2\x80\xa8"
                             "b"}) {
        EXPECT_FALSE(find_fault(text));
        EXPECT_TRUE(find_fault(text, Lines::one));
    }
    EXPECT_TRUE(find_fault(std::string_view("a\0b", 3)));
    EXPECT_THROW(check_text("S\x1b[D", "--participant"), Error);
    EXPECT_NO_THROW(check_text("Jürgen", "--participant"));
}

TEST(Text, MendsWhatIsWrong) {
    EXPECT_EQ(mended("J\xfcrgen"), "J\xef\xbf\xbdrgen");
    EXPECT_EQ(mended("S\x1b[1"), "S\xef\xbf\xbd[1");
    EXPECT_EQ(mended("a\nb"), "a\nb");
    EXPECT_EQ(mended("a\nb", Lines::one),
              "a\xef\xbf\xbd"
              "b");
    EXPECT_EQ(mended("\xe2\x82"), "\xef\xbf\xbd\xef\xbf\xbd");
}

void append(std::string& text, unsigned code) {
    const auto put = [&](unsigned byte) { text += static_cast<char>(byte); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xc0 | code >> 6);
        put(0x80 | (code & 0x3f));
    } else if (code < 0x10000) {
        put(0xe0 | code >> 12);
        put(0x80 | (code >> 6 & 0x3f));
        put(0x80 | (code & 0x3f));
    } else {
        put(0xf0 | code >> 18);
        put(0x80 | (code >> 12 & 0x3f));
        put(0x80 | (code >> 6 & 0x3f));
        put(0x80 | (code & 0x3f));
    }
}

/// Returns words and characters that have a meaning in YAML, CSV or a shell, in random order.
std::string random_text(std::mt19937& random) {
    const auto below = [&](unsigned n) { return static_cast<unsigned>(random()) % n; };
    std::string out;
    for (unsigned n = below(12); n > 0; --n) {
        constexpr std::string_view kSigns =
            " \t\n\r\"'\\:,#-?|>&*!%@`[]{}~=<.0123456789eEnNyYxo_$;";
        switch (below(6)) {
            case 0:
                append(out, below(0x100));
                break;
            case 1:
                append(out, below(0x3000));
                break;
            case 2:
                append(out, below(0x110000));
                break;
            case 3:
                out += static_cast<char>(below(256));
                break;
            default:
                out += kSigns[below(kSigns.size())];
        }
    }
    return out;
}

TEST(Text, WhatIsWrittenIsReadAgainOrRefusedBefore) {
    std::mt19937 random(20261126);
    const TemporaryFolder folder;
    Table table;
    table.columns = {{"text", ""}, {"more", ""}};
    Node list = Node::mapping();
    list.set("texts", {});
    list.entries[0].value.kind = Node::Kind::sequence;
    int refused = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::string text = random_text(random);
        if (find_fault(text)) {
            ++refused;
            continue;
        }
        Node node = Node::mapping();
        node.set(text, Node::of(text));
        const Node back = parse_yaml(to_yaml(node), "test.yaml");
        ASSERT_EQ(back.entries.size(), 1u) << text;
        ASSERT_EQ(back.entries[0].key, text);
        ASSERT_EQ(back.entries[0].value.kind, Node::Kind::scalar) << "<" << text << ">";
        ASSERT_EQ(back.entries[0].value.scalar, text);
        table.rows.push_back({text, text});
        list.entries[0].value.items.push_back(Node::of(text));
    }
    EXPECT_GT(refused, 2000);
    EXPECT_GT(table.rows.size(), 5000u);
    const std::string file = folder.file("texts.csv");
    write_csv(table, file);
    const auto rows = read_csv(file);
    ASSERT_EQ(rows.size(), table.rows.size() + 1);
    for (size_t i = 0; i < table.rows.size(); ++i)
        ASSERT_EQ(rows[i + 1][1], std::get<std::string>(table.rows[i][1]));
    write_file(to_yaml(list), folder.file("texts.yaml"));
    const Node back = read_yaml(folder.file("texts.yaml"));
    ASSERT_EQ(back.entries[0].value.items.size(), table.rows.size());
    for (size_t i = 0; i < table.rows.size(); ++i)
        ASSERT_EQ(back.entries[0].value.items[i].scalar, std::get<std::string>(table.rows[i][0]));
}

TEST(Text, ControlCharactersInYamlAreToldWithTheirLine) {
    for (const char* text : {"title: \"a\\eb\"", "title: \"\\x01\"", "title: \"\\0\"",
                             "\"k\\x7f\": 1", "a: [1, \"\\x85\"]"}) {
        try {
            parse_yaml(std::string("first: 1\n") + text, "file.yaml");
            ADD_FAILURE() << text;
        } catch (const Error& e) {
            EXPECT_EQ(e.problems()[0].place.line, 2) << text;
            EXPECT_NE(std::string(e.what()).find("control character"), std::string::npos)
                << e.what();
        }
    }
    EXPECT_EQ(parse_yaml("text: |\r\n  a\r\n  b\r\n", "").entries[0].value.scalar, "a\nb\n");
}

}  // namespace
}  // namespace dihaptic::text_test
