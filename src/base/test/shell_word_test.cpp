#include "base/shell_word.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <random>

#include "base/checksum.h"

namespace dihaptic::shell_word_test {
namespace {

/// Returns a word as bash reads it. The shell is bash because sh does not support $'...'.
std::string by_bash(const std::string& word) {
    const std::string command = "bash -c " + shell_word("printf %s " + word);
    std::FILE* const pipe = popen(command.c_str(), "r");
    std::string out;
    for (int letter = 0; (letter = std::fgetc(pipe)) != EOF;) out += static_cast<char>(letter);
    pclose(pipe);
    return out;
}

TEST(ShellWord, IsTheWordToAShellWhateverIsInIt) {
    for (const char* word :
         {"plain", "two words", "it's", "$(touch x)", "`a`", "a;b|c&d>e", "*?[", "\"", "a\\nb",
          "a\nb", "\x1b[2J'\\", "\x7f", "~", "#", "-x", "J\xC3\xBCrgen"}) {
        EXPECT_EQ(by_bash(shell_word(word)), word) << shell_word(word);
        for (const char letter : shell_word(word))
            EXPECT_GE(static_cast<unsigned char>(letter), ' ');
    }
    EXPECT_EQ(shell_word(""), "''");
    EXPECT_EQ(shell_word("rehearsals/a_1"), "rehearsals/a_1");
    EXPECT_EQ(shell_file("rehearsals/a_1"), "rehearsals/a_1");
    EXPECT_EQ(shell_file("-r f"), "'./-r f'");
}

TEST(ShellWord, CommandsAreTakenApartAgain) {
    std::mt19937_64 random(1);
    const std::string letters = "ab ';$\"|\\*";
    for (int i = 0; i < 2000; ++i) {
        std::vector<std::string> words;
        std::string command;
        for (size_t n = 1 + random() % 4; n > 0; --n) {
            std::string word;
            for (size_t k = random() % 5; k > 0; --k) word += letters[random() % letters.size()];
            words.push_back(word);
            command += (command.empty() ? "" : " ") + shell_word(word);
        }
        const auto back = shell_words(command);
        ASSERT_TRUE(back) << command;
        EXPECT_EQ(*back, words) << command;
    }
}

TEST(ShellWord, WhatDoesMoreThanToStartAProgramIsNoCommand) {
    for (const char* command :
         {"a; b", "a && b", "a > b", "a $(b)", "a `b`", "a\nb", "a 'b", "a  b", "a b'c",
          "a \"b c\"", "a *", "a &", "a $'\\033'", "a 'plain'"}) {
        EXPECT_FALSE(shell_words(command)) << command;
    }
}

TEST(Checksum, IsThatOfTheBytesInHoweverManyParts) {
    EXPECT_EQ(checksum_of("123456789"), "cbf43926");  // the check value of CRC-32
    EXPECT_EQ(checksum_of(""), "00000000");
    const std::string text = "123456789";
    Checksum sum;
    sum.add(std::as_bytes(std::span(text).first(4)));
    sum.add(std::as_bytes(std::span(text).subspan(4)));
    EXPECT_EQ(sum.text(), "cbf43926");
}

}  // namespace
}  // namespace dihaptic::shell_word_test
