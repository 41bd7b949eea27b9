// Tests which words are offered at which positions of a file.
#include "word_finder.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QDeadlineTimer>

#include "base/text_file.h"
#include "testing/files.h"

namespace dihaptic::gui::word_finder_test {
namespace {

/// The words offered at the position of the character | in `text`.
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

TEST_F(WordFinderTest, OffersHowABodyMayLook) {
    const QString box = "bodies:\n  - name: b\n    shape: box\n    size_mm: [9, 9, 9]\n    ";
    const Words keys(box + "pict|\n");
    for (const char* key : {"finish", "picture", "seen"}) EXPECT_TRUE(keys.has(key)) << key;
    EXPECT_TRUE(Words(box + "finish: |\n").has("metal"));
    EXPECT_TRUE(Words(box + "picture: { file: a.png, | }\n").has("width_mm"));
    EXPECT_TRUE(Words(box + "seen: { file: a.ply, unit: | }\n").has("mm"));
}

TEST_F(WordFinderTest, OffersKeysOfRigs) {
    EXPECT_TRUE(
        Words("devices:\n  - finger: index\n    backend: simulated\nheads|\n").has("headset"));
}

const char* const kScene =
    "object: block\n"
    "bodies:\n"
    "  - { name: table, shape: plane, fixed: yes }\n"
    "  - { name: block, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [0, 0, 20] }\n"
    "  - { name: bar 1, shape: box, size_mm: [40, 40, 40], mass_g: 100, position_mm: [0, 0, 70] "
    "}\n";

TEST_F(WordFinderTest, OffersBodiesWhereTheyMayStand) {
    const QString scene(kScene);
    const Words object(QString(scene).replace("object: block", "object: |"));
    EXPECT_FALSE(object.place.is_key);
    EXPECT_TRUE(object.has("block"));
    EXPECT_TRUE(object.has("bar 1"));
    EXPECT_FALSE(object.has("table")) << "it cannot move";
    for (const char* between :
         {"pairs:\n  - between: [block, |]\n    friction: 1\n",
          "pairs:\n  - { between: [|, block], friction: 1 }\n",
          "pairs:\n  - friction: 1\n    between: [\n      block,\n      b|\n",
          "pairs:\n  - friction: 1\n    between:\n      - block\n      - |\n"}) {
        const Words pair(scene + between);
        EXPECT_TRUE(!pair.place.is_key || !pair.place.otherwise.empty()) << between;
        EXPECT_TRUE(pair.has("table")) << between;
        EXPECT_TRUE(pair.has("index")) << between;
    }
    const Words joint(scene + "joints:\n  - { name: j, kind: ball, between: [table, |] }\n");
    EXPECT_TRUE(joint.has("block"));
    EXPECT_FALSE(joint.has("index")) << "no joint holds a finger";
    EXPECT_TRUE(Words(scene + "joints:\n  - { name: j, kind: ball, between: [block], in: | }\n")
                    .has("bar 1"));
}

TEST_F(WordFinderTest, OffersWordsInBracketsThatAreNotClosedYet) {
    const Words key("bodies:\n  - { name: a, sha|\n  - { name: b, shape: plane, fixed: yes }\n");
    EXPECT_TRUE(key.has("shape"));
    EXPECT_TRUE(
        Words(QString(kScene) + "joints:\n  - { name: j, kind: ball, between: [b|\n").has("block"));
}

TEST_F(WordFinderTest, KnowsWhetherAKeyOrAValueStandsThere) {
    const auto is_key = [](QString text) {
        const auto cursor = static_cast<int>(text.indexOf('|'));
        return word_place(text.remove(cursor, 1), cursor).is_key;
    };
    EXPECT_TRUE(is_key("a:\n  |"));
    EXPECT_TRUE(is_key("a:\n  - - b|"));
    EXPECT_TRUE(is_key("{ a: [1, 2], b|"));
    EXPECT_TRUE(is_key("a: {\n  \"b: {\": 1,\n  c|"));
    EXPECT_TRUE(is_key("a: it's [ # not { \n|"));
    EXPECT_TRUE(is_key("a: 'it''s { \\'\n|"));
    EXPECT_TRUE(is_key("a: \"\\\"{\"\n|"));
    EXPECT_FALSE(is_key("a: b|"));
    EXPECT_FALSE(is_key("a: b > c|"));
    EXPECT_FALSE(is_key("- b > c|"));
    EXPECT_FALSE(is_key("a: [b, c|"));
    EXPECT_FALSE(is_key("{ a: b|"));
    EXPECT_FALSE(is_key("{ a: \"f(x, y|"));
    EXPECT_FALSE(is_key("\"a|"));
}

/// The words offered in a shipped experiment in which `from` is replaced with `to`.
Words in_experiment(const QString& from, const QString& to) {
    QString text = QString::fromStdString(read_text_file("experiments/first-trials.yaml"));
    const QString here = QString::fromStdString(std::filesystem::current_path().string());
    EXPECT_TRUE(text.contains(from)) << from.toStdString();
    text.replace("../", here + "/");
    return Words(text.replace(text.indexOf(from), from.size(), to));
}

TEST_F(WordFinderTest, OffersWhatAnExperimentGivesAName) {
    EXPECT_TRUE(in_experiment("to: hold", "to: |").has("put down"));
    EXPECT_TRUE(in_experiment("show: [away]", "show: [aw|]").has("away"));
    EXPECT_TRUE(in_experiment("region: away", "region: |").has("away"));
    EXPECT_TRUE(in_experiment("perturb: thrice", "perturb: |").has("twice"));
    EXPECT_TRUE(in_experiment("body: { body: block", "body: { body: |").has("block"));
    EXPECT_TRUE(in_experiment("when: lifted, body: block", "when: lifted, body: |").has("block"));
    const Words when = in_experiment("when: inside, region: away", "when: |");
    EXPECT_TRUE(when.has("lifted"));
    EXPECT_TRUE(when.has("grip_force"));
    const Words member = in_experiment("when: inside, region: away", "when: block.| > 2 mm");
    EXPECT_EQ(member.place.typed, "block.");
    EXPECT_TRUE(member.has("block.z"));
    EXPECT_TRUE(
        in_experiment("when: inside, region: away", "when: \"inside(block, |)\"").has("away"));
    EXPECT_TRUE(in_experiment("\"Lift {trial_num}", "\"Lift {tr|}").has("trials"));
}

TEST_F(WordFinderTest, HasNothingToOfferInATextThatIsNoYaml) {
    EXPECT_TRUE(Words("bodies: [\n  - na|\n").found.empty());
}

}  // namespace
}  // namespace dihaptic::gui::word_finder_test
