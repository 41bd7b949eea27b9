// Tests what the editor writes into the file and what it writes into the draft.
#include "edited_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "base/diagnostics.h"
#include "base/text_file.h"
#include "draft.h"
#include "plain_text.h"
#include "testing/files.h"

namespace dihaptic::gui::edited_file_test {
namespace {

namespace fs = std::filesystem;

QString name_of(const std::string& file) {
    return QString::fromStdString(file);
}

TEST(EditedFile, NoticesWhatOthersDoToIt) {
    testing::TemporaryFolder folder;
    const std::string file = folder.write("a.yaml", "one");
    EditedFile edited(name_of(file));
    EXPECT_FALSE(edited.has_changed());
    write_file("two", file);
    EXPECT_TRUE(edited.has_changed());
    EXPECT_FALSE(edited.leads_elsewhere());
    edited.write("three");
    EXPECT_FALSE(edited.has_changed());
    fs::remove(file);
    EXPECT_TRUE(edited.has_changed());
    EXPECT_FALSE(edited.leads_elsewhere()) << "it may be written again";
    fs::create_symlink(folder.write("b.yaml", "three"), file);
    EXPECT_TRUE(edited.leads_elsewhere());
    EXPECT_THROW(edited.write("four"), Error);
    EXPECT_EQ(testing::read_file(folder.file("b.yaml")), "three");
}

TEST(EditedFile, IsWrittenWhereItsLinkLed) {
    testing::TemporaryFolder folder;
    const std::string file = folder.write("real.yaml", "one"), link = folder.file("link.yaml");
    ASSERT_EQ(chmod(file.c_str(), 0640), 0);
    fs::create_symlink(file, link);
    EditedFile edited(name_of(link));
    EXPECT_TRUE(edited.is_link());
    edited.write("two");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(testing::read_file(file), "two");
    EXPECT_EQ(fs::status(file).permissions(), fs::perms(0640));
    fs::remove(link);
    fs::create_symlink(folder.write("other.yaml", "one"), link);
    EXPECT_TRUE(edited.leads_elsewhere());
}

TEST(EditedFile, IsNoPipe) {
    testing::TemporaryFolder folder;
    ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
    const EditedFile edited(name_of(folder.file("pipe")));  // must not wait for a writer
    EXPECT_FALSE(edited.was_readable());
}

struct DraftTest : ::testing::Test {
    testing::TemporaryFolder folder;
    QString file = name_of(folder.file("study/a.yaml"));
    DraftTest() { setenv("XDG_STATE_HOME", folder.file("state").c_str(), 1); }
    ~DraftTest() override { unsetenv("XDG_STATE_HOME"); }
};

TEST_F(DraftTest, OutlivesItsWindow) {
    {
        Draft draft(file);
        ASSERT_TRUE(draft.take());
        EXPECT_FALSE(draft.left());
        draft.write("first");
        draft.write("text\n");
    }
    EXPECT_FALSE(fs::exists(folder.file("study")));
    Draft draft(file);
    ASSERT_TRUE(draft.take());
    EXPECT_EQ(draft.left()->text, "text\n");
    Draft other(name_of(folder.file("study/b.yaml")));
    ASSERT_TRUE(other.take());
    EXPECT_FALSE(other.left());
    draft.remove();
    EXPECT_FALSE(draft.left());
}

TEST_F(DraftTest, IsOfOneWindowAtATime) {
    Draft second(file);
    {
        Draft first(file);
        EXPECT_TRUE(first.take());
        EXPECT_TRUE(first.take());
        EXPECT_FALSE(second.take());
    }
    EXPECT_TRUE(second.take());
}

TEST_F(DraftTest, GoesThroughNoLink) {
    fs::create_directory(folder.file("state"));
    fs::create_directory(folder.file("theirs"));
    fs::create_symlink(folder.file("theirs"), folder.file("state/dihaptic"));
    Draft draft(file);
    EXPECT_THROW(draft.take(), Error);
    EXPECT_TRUE(fs::is_empty(folder.file("theirs")));
}

TEST(PlainText, TakesNoControlCharacters) {
    EXPECT_EQ(clean_text(QString::fromUtf8("a\x1b[D\x7f\tb\r\nc\rd\xe2\x80\xa8"
                                           "e\xc2\x85")),
              "a[D\tb\nc\nd\ne");
    EXPECT_EQ(clean_text(QString("a") + QChar(0) + "x"), "ax");
    EXPECT_EQ(clean_text(QString(QChar(0xd800)) + "x"), "?x") << "half a character is none";
    EXPECT_EQ(clean_text(QString::fromUtf8("Gr\xc3\xbc\xc3\x9f")),
              QString::fromUtf8("Gr\xc3\xbc\xc3\x9f"));
}

}  // namespace
}  // namespace dihaptic::gui::edited_file_test
