// Tests what the editor of files opens, checks and writes.
#include "composer.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QPlainTextEdit>

#include "answer_until.h"
#include "testing/files.h"

namespace dihaptic::gui::composer_test {
namespace {

class ComposerTest : public ::testing::Test {
  protected:
    ComposerTest() {
        QObject::connect(&composer_, &Composer::edited, &composer_, [this] { ++checks_; });
    }
    QString write(const char* name, const std::string& text) {
        return QString::fromStdString(folder_.write(name, text));
    }
    QPlainTextEdit& text() { return *composer_.findChild<QPlainTextEdit*>(); }
    /// Whether the text is checked within a few seconds.
    bool is_checked() {
        const int before = checks_;
        return answer_until([&] { return checks_ > before; });
    }

    int count_ = 1;
    char name_[5] = "test";
    char* names_[2] = {name_, nullptr};
    const bool offscreen_ = qputenv("QT_QPA_PLATFORM", "offscreen");
    testing::TemporaryFolder folder_;
    const bool state_ = qputenv("XDG_STATE_HOME", QByteArray::fromStdString(folder_.path()));
    QApplication application_{count_, names_};
    Composer composer_;
    int checks_ = 0;
};

TEST_F(ComposerTest, ChecksTheTextAlsoWhenUndoingLeadsBackToTheFile) {
    composer_.open(write("scene.yaml", "title: one\n"));
    text().insertPlainText("# mine\n");
    ASSERT_TRUE(is_checked());
    EXPECT_TRUE(composer_.unsaved());
    composer_.undo();
    EXPECT_FALSE(composer_.changed());
    EXPECT_TRUE(is_checked());
    EXPECT_FALSE(composer_.unsaved());
    composer_.redo();
    EXPECT_TRUE(is_checked());
    EXPECT_TRUE(composer_.unsaved());
}

TEST_F(ComposerTest, LeavesTheFilesOfASessionAsTheyWereRecorded) {
    write("session.yaml", "state: complete\n...\n");
    const QString frozen = write("scene.yaml", "title: one\n");
    const QString own = write("../mine.yaml", "title: two\n");
    composer_.open(frozen);
    text().insertPlainText("# mine\n");
    EXPECT_FALSE(composer_.save());
    EXPECT_TRUE(composer_.refusal().contains("session's folder"))
        << composer_.refusal().toStdString();
    EXPECT_FALSE(composer_.save_as(frozen));
    EXPECT_EQ(testing::read_file(frozen.toStdString()), "title: one\n");
    EXPECT_TRUE(composer_.save_as(own));
    EXPECT_EQ(testing::read_file(own.toStdString()), "# mine\ntitle: one\n");
    std::remove(own.toStdString().c_str());
}

TEST_F(ComposerTest, SaysWhyAFileIsNotOpened) {
    EXPECT_EQ(Composer::why_not_to_open(write("scene.yaml", "title: one\n")), "");
    EXPECT_TRUE(Composer::why_not_to_open(write("binary.yaml", std::string("a\0b", 3)))
                    .contains("is not UTF-8 text"));
    EXPECT_TRUE(Composer::why_not_to_open(QString::fromStdString(folder_.file("none.yaml")))
                    .contains("does not exist"));
    EXPECT_NE(Composer::why_not_to_open(QString::fromStdString(folder_.path())), "");
}

}  // namespace
}  // namespace dihaptic::gui::composer_test
