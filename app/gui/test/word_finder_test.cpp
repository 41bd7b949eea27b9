// Tests which words are offered where in a file.
#include "word_finder.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QDeadlineTimer>

#include "testing/files.h"

namespace dihaptic::gui::word_finder_test {
namespace {

/// The words offered where `text` has a |.
class Words {
  public:
    explicit Words(QString text, const std::string& name = "file.yaml") {
        const auto cursor = static_cast<int>(text.indexOf('|'));
        text.remove(cursor, 1);
        place = word_place(text, cursor);
        WordFinder finder;
        bool done = false;
        QObject::connect(&finder, &WordFinder::found,
                         [&](const WordPlace&, const std::vector<Choice>& words) {
                             found = words;
                             done = true;
                         });
        finder.find(QString::fromStdString(folder.file(name)), place);
        const QDeadlineTimer patience(60000);
        while (!done && !patience.hasExpired()) QCoreApplication::processEvents();
        EXPECT_TRUE(done);
        EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "files were left";
    }
    bool has(const std::string& word) const {
        return std::any_of(found.begin(), found.end(),
                           [&](const Choice& choice) { return choice.word == word; });
    }

    testing::TemporaryFolder folder;
    WordPlace place;
    std::vector<Choice> found;
};

class WordFinderTest : public ::testing::Test {
    int count_ = 1;
    char name_[5] = "test";
    char* names_[1] = {name_};
    QCoreApplication application_{count_, names_};
};

TEST_F(WordFinderTest, OffersKeysWithTheirSentencesThatAreNotYetThere) {
    const Words words("bodies:\n  - name: block\n    shape: box\n    si|\n    mass_g: 100\n");
    EXPECT_TRUE(words.place.is_key);
    EXPECT_EQ(words.place.typed, "si");
    ASSERT_TRUE(words.has("size_mm"));
    EXPECT_TRUE(words.has("colour"));
    EXPECT_FALSE(words.has("mass_g")) << "it is there";
    EXPECT_FALSE(words.has("mass_kg")) << "in another unit";
    EXPECT_FALSE(words.has("devices")) << "it is a rig's";
    for (const Choice& choice : words.found) EXPECT_NE(choice.what, "") << choice.word;
}

TEST_F(WordFinderTest, OffersKeysInBracesAndBeforeAColon) {
    EXPECT_TRUE(Words("bodies:\n  - { name: block, shape: box, | }\n").has("size_mm"));
    const Words words("bodies:\n  - { name: block, shape: box, siz|e_mm: [40, 40, 40] }\n");
    EXPECT_TRUE(words.place.has_colon);
    EXPECT_TRUE(words.has("size_mm"));
}

TEST_F(WordFinderTest, OffersNamesBehindAKey) {
    const Words words("bodies:\n  - name: block\n    shape: |\n");
    EXPECT_FALSE(words.place.is_key);
    EXPECT_TRUE(words.has("sphere"));
    EXPECT_TRUE(words.has("plane"));
}

TEST_F(WordFinderTest, OffersKeysOfRigs) {
    EXPECT_TRUE(
        Words("devices:\n  - finger: index\n    backend: simulated\nheads|\n").has("headset"));
}

TEST_F(WordFinderTest, HasNothingToOfferInATextThatIsNoYaml) {
    EXPECT_TRUE(Words("bodies: [\n  - na|\n").found.empty());
}

}  // namespace
}  // namespace dihaptic::gui::word_finder_test
