// Tests that nobody is recorded under a wrong name: identifiers that are typed in wrong ways start
// nothing, or only after a question.
#include "participant_dialog.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QTemporaryDir>

#include "base/text_file.h"
#include "identifiers.h"

namespace dihaptic::gui {
namespace {

const std::vector<std::string> kKnown{"S04", "S05", "S06"};

TEST(Identifiers, ResembleKnownOnesThatOneSlipWouldMakeOfThem) {
    for (const char* slip : {"s05", "S5", "S005", "SO5", "S-05", "S_05", "S05S05", "S055", "S50",
                             "S0", "S05b", "XS05", "D05", "05", "S15"}) {
        EXPECT_NE(resembled(slip, kKnown), "") << slip;
    }
    EXPECT_EQ(resembled("SO5", kKnown), "S05");
    EXPECT_EQ(resembled("s5", kKnown), "S05");
    EXPECT_EQ(resembled("S05S06", kKnown), "S05");
    for (const char* other : {"S05", "K12", "anna7", "S123"})
        EXPECT_EQ(resembled(other, kKnown), "") << other;
    EXPECT_EQ(resembled("S01", {}), "");
}

TEST(Identifiers, AreCounted) {
    EXPECT_EQ(next_identifier({}), "S01");
    EXPECT_EQ(next_identifier(kKnown), "S07");
    EXPECT_EQ(next_identifier({"S09"}), "S10");
    EXPECT_EQ(next_identifier({"C1", "P001", "P002"}), "P003");
    EXPECT_EQ(next_identifier({"anna"}), "S01");
    EXPECT_TRUE(out_of_turn("S99", kKnown));
    EXPECT_FALSE(out_of_turn("S07", kKnown));
    EXPECT_FALSE(out_of_turn("K01", kKnown));
    EXPECT_FALSE(out_of_turn("S99", {}));
}

TEST(Identifiers, ThatAreNoneHaveARemedy) {
    EXPECT_EQ(fault_of_identifier("S07", true), "");
    EXPECT_EQ(fault_of_identifier("7b", false), "");
    for (const char* wrong : {"", "S 07", "anna", "S07;", "M\u00fcller7", "sim-007", "../S07"})
        EXPECT_NE(fault_of_identifier(wrong, false), "") << wrong;
    EXPECT_NE(fault_of_identifier("7b", true), "");
    EXPECT_NE(fault_of_identifier(std::string(41, '7'), false), "");
}

class ParticipantDialogTest : public ::testing::Test {
  protected:
    /// A finished session of this person.
    void record(const std::string& id, const std::string& title = "Reaches",
                recording::SessionState state = recording::SessionState::complete) {
        const auto folder =
            recording::SessionFolder::create(folder_.path().toStdString(), "reaches_" + id);
        recording::SessionInfo info;
        info.title = title;
        info.participant = {id, "31", "F", "left"};
        info.state = state;
        info.started = "2026-01-31T09:30:00+01:00";
        info.moved_by.mover = recording::Mover::mouse;
        folder.write_info(info);
        write_file("", folder.raw_log());
    }
    void open() {
        const std::string folder = folder_.path().toStdString();
        dialog_.emplace(KnownPeople(folder, "Reaches", folder + "/experiment.yaml"), true, nullptr);
        dialog_->show();
    }
    QLineEdit& field() const { return *dialog_->findChild<QLineEdit*>(); }
    QCheckBox& sure() const { return *dialog_->findChild<QCheckBox*>(); }
    void type(const char* text) const { field().setText(text); }
    /// Whether Enter starts the session.
    bool starts() {
        dialog_->accept();
        const bool started = dialog_->result() == QDialog::Accepted;
        dialog_->setResult(QDialog::Rejected);
        dialog_->show();
        return started;
    }
    QString says() const {
        for (const QLabel* label : dialog_->findChildren<QLabel*>()) {
            if (label->wordWrap()) return label->text();
        }
        return "";
    }

    int count_ = 1;
    char name_[5] = "test";
    char* names_[2] = {name_, nullptr};
    const bool offscreen_ = qputenv("QT_QPA_PLATFORM", "offscreen");
    QApplication application_{count_, names_};
    QTemporaryDir folder_;
    std::optional<ParticipantDialog> dialog_;
};

TEST_F(ParticipantDialogTest, RecordsNoneOfTwelveWrongParticipants) {
    for (const std::string& id : kKnown) record(id);
    open();
    EXPECT_EQ(field().text(), "");
    for (const char* wrong : {"", "S05S05", "S5", "s05", "SO5", "S 05", "S005", "S50", "S04",
                              "anna", "S05S07", "S99"}) {
        type(wrong);
        EXPECT_FALSE(starts()) << wrong;
        EXPECT_NE(says(), "") << wrong;
    }
    type("S07");
    EXPECT_TRUE(starts());
    EXPECT_EQ(dialog_->participant().id, "S07");
}

TEST_F(ParticipantDialogTest, StartsAnUnusualOneOnceItsQuestionIsAnswered) {
    record("S05");
    open();
    for (const char* id : {"S05", "S5", "S99"}) {
        type(id);
        EXPECT_FALSE(starts()) << id;
        ASSERT_FALSE(sure().isHidden()) << id;
        sure().setChecked(true);
        EXPECT_TRUE(starts()) << id;
        type("S05S05");  // an answer is only for the identifier that was asked about
        EXPECT_FALSE(starts()) << id;
    }
}

TEST_F(ParticipantDialogTest, KnowsWhatWasSaidOfAPerson) {
    record("S05");
    record("S06", "Lifts");
    record("sim-001");
    open();
    EXPECT_EQ(dialog_->findChild<QTreeWidget*>()->topLevelItemCount(), 2);
    type("S05");
    EXPECT_EQ(dialog_->participant().age, "31");
    EXPECT_EQ(dialog_->participant().handedness, "left");
    EXPECT_TRUE(says().contains("already been completed")) << says().toStdString();
    type("S06");
    EXPECT_FALSE(says().contains("already been completed")) << says().toStdString();
    type("S07");
    EXPECT_EQ(dialog_->participant().age, "");
    EXPECT_EQ(dialog_->participant().sex, "U");
}

TEST_F(ParticipantDialogTest, ListsThePeopleOfTheStudyWithGroupAndNextSession) {
    const std::string folder = folder_.path().toStdString();
    write_file("title: Reaches\n", folder + "/experiment.yaml");
    write_file(
        "title: Adaptation\n"
        "groups: [{ name: fast, people: 10 }]\n"
        "sessions:\n"
        "  - { name: day1, experiment: experiment.yaml }\n"
        "  - { name: day2, experiment: experiment.yaml }\n",
        folder + "/study.yaml");
    write_file(
        "study: Adaptation\n"
        "participants: [{ id: S07, group: fast, number: 1, age: \"31\" }]\n",
        folder + "/participants.yaml");
    open();
    const QTreeWidget& list = *dialog_->findChild<QTreeWidget*>();
    ASSERT_EQ(list.topLevelItemCount(), 1);
    EXPECT_FALSE(list.isColumnHidden(3));
    EXPECT_EQ(list.topLevelItem(0)->text(3), "fast");
    EXPECT_EQ(list.topLevelItem(0)->text(4), "day1");
    type("S08");
    EXPECT_TRUE(says().contains("not been added")) << says().toStdString();
    EXPECT_FALSE(starts());
    type("S07");
    EXPECT_EQ(dialog_->participant().age, "31");
    EXPECT_TRUE(starts()) << "the first session of somebody who has been added needs no question";
}

TEST_F(ParticipantDialogTest, TakesWhateverIsValidWhereNobodyIsKnown) {
    open();
    EXPECT_FALSE(starts());
    type("K12");
    EXPECT_TRUE(starts());
}

}  // namespace
}  // namespace dihaptic::gui
