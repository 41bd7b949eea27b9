// Tests the states of the session control, the actions that each state allows, and what the control
// reports, without a window.
#include "session_control.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <QCoreApplication>
#include <QFileInfo>
#include <algorithm>
#include <csignal>
#include <map>

#include "answer_until.h"
#include "recording/remarks.h"
#include "recording/seal.h"
#include "rows/event_row.h"
#include "session_sign.h"
#include "testing/files.h"

namespace dihaptic::gui {
namespace {

class SessionControlTest : public ::testing::Test {
  protected:
    using State = SessionControl::State;
    using Act = SessionControl::Act;

    SessionControlTest() {
        QObject::connect(&control_, &SessionControl::logged, &control_,
                         [this](const QString& text) { log_ += text; });
        QObject::connect(&control_, &SessionControl::start_due, &control_, [this] { ++due_; });
        QObject::connect(&control_, &SessionControl::ended, &control_, [this] { ++ended_; });
        QObject::connect(&control_, &SessionControl::finishing_progressed, &control_, [this] {
            if (control_.state() == State::finishing && allows({})) ++finishing_;
        });
        QObject::connect(&control_, &SessionControl::framed, &control_, [this] { ++frames_; });
        QObject::connect(&control_, &SessionControl::file_changed, &control_,
                         [this] { ++file_changes_; });
        QObject::connect(&control_, &SessionControl::judged, &control_,
                         [this](const QStringList& problems) { problems_ = problems; });
    }

    /// Lets the control work until `condition` holds. Returns false if this takes too long.
    template <class Condition>
    bool answer_until(const Condition& condition) {
        return gui::answer_until(condition, [this] { control_.refresh(); });
    }
    bool comes_to(State state) {
        return answer_until([&] { return control_.state() == state; });
    }
    session::Request request() const {
        session::Request out;
        out.file = control_.file().toStdString();
        return out;
    }
    void open(const std::string& file) {
        control_.open(QString::fromStdString(file));
        control_.read(request(), std::nullopt);
    }
    /// Starts a session of the scene, at a tenth of real-time speed unless the mouse moves the
    /// hand.
    void run(bool mouse = false) {
        open("scenes/block-on-table.yaml");
        ASSERT_TRUE(comes_to(State::checked));
        session::Request asked = request();
        asked.mouse = mouse;
        control_.begin(asked, {{"S07", "", "", ""}, false, mouse ? 1 : 0.1}, "");
        ASSERT_TRUE(answer_until([&] { return frames_ > 0; }));
    }
    bool logged(const char* text) const { return log_.join('\n').contains(text); }
    /// Whether the actions in `acts`, and no others, are allowed.
    ::testing::AssertionResult allows(const std::vector<Act>& acts) const {
        const std::map<Act, const char*> names{
            {Act::open, "open"},          {Act::start, "start"}, {Act::prepare, "prepare"},
            {Act::pause, "pause"},        {Act::stop, "stop"},   {Act::calibrate, "calibrate"},
            {Act::skip, "skip"},          {Act::step, "step"},   {Act::move, "move the hand"},
            {Act::force_off, "force off"}};
        for (const auto& [act, name] : names) {
            const bool expected = std::find(acts.begin(), acts.end(), act) != acts.end();
            if (control_.may(act) != expected)
                return ::testing::AssertionFailure() << name << (expected ? " is not" : " is");
        }
        return ::testing::AssertionSuccess();
    }

    int words_ = 1;
    char name_[2] = "t";
    char* argument_ = name_;
    QCoreApplication app_{words_, &argument_};
    testing::TemporaryFolder folder_;
    std::atomic<bool> stop_{false};
    SessionControl control_{QString::fromStdString(folder_.path()), 0, stop_};
    QStringList log_;
    QStringList problems_;
    int due_ = 0, ended_ = 0, finishing_ = 0, frames_ = 0, file_changes_ = 0;
};

TEST_F(SessionControlTest, AFileIsReadAndMayThenStart) {
    EXPECT_EQ(control_.state(), State::no_file);
    EXPECT_TRUE(allows({Act::open, Act::calibrate}));
    open("scenes/block-on-table.yaml");
    EXPECT_EQ(control_.state(), State::opening);
    EXPECT_TRUE(allows({Act::open, Act::start, Act::stop}));
    ASSERT_TRUE(comes_to(State::checked));
    EXPECT_TRUE(allows({Act::open, Act::start, Act::prepare, Act::calibrate}));
    EXPECT_EQ(control_.plan()->title, "A 100 g block on a table");
    EXPECT_TRUE(logged("opened scenes/block-on-table.yaml"));
    EXPECT_TRUE(control_.want_start());
    EXPECT_EQ(due_, 0);
}

TEST_F(SessionControlTest, AFileWithErrorsLeavesTheLastGoodOne) {
    open("scenes/block-on-table.yaml");
    ASSERT_TRUE(comes_to(State::checked));
    open(folder_.write("wrong.yaml", "title: [\n"));
    ASSERT_TRUE(comes_to(State::checked));
    EXPECT_FALSE(problems_.isEmpty());
    EXPECT_FALSE(control_.complaint().isEmpty());
    EXPECT_EQ(control_.plan()->title, "A 100 g block on a table");
    EXPECT_TRUE(logged("The open file stays unchanged."));
}

TEST_F(SessionControlTest, NoSessionStartsFromUnsavedTextWithErrors) {
    open("scenes/block-on-table.yaml");
    ASSERT_TRUE(comes_to(State::checked));
    control_.set_edited(true);
    control_.read(request(), "title: [\n");
    ASSERT_TRUE(comes_to(State::checked));
    EXPECT_FALSE(problems_.isEmpty());
    EXPECT_TRUE(control_.complaint().isEmpty());  // errors are marked in the text
    EXPECT_EQ(sign_of(control_).word, "Ready");
    EXPECT_FALSE(control_.want_start());
    EXPECT_TRUE(logged("The text has errors"));
    EXPECT_EQ(sign_of(control_).sign, Sign::fault);
    EXPECT_EQ(sign_of(control_).word, "Did not start");
    EXPECT_TRUE(sign_of(control_).text.contains("The text has errors"));
    control_.set_edited(false);
    EXPECT_TRUE(control_.want_start());
    control_.read(request(), std::nullopt);  // the errors are mended
    ASSERT_TRUE(comes_to(State::checked));
    EXPECT_EQ(sign_of(control_).word, "Ready");
}

TEST_F(SessionControlTest, ASignSaysWhyNoSessionStartsUntilAnotherDoes) {
    open("scenes/block-on-table.yaml");
    ASSERT_TRUE(comes_to(State::checked));
    control_.set_out(QString::fromStdString(folder_.write("no-folder", "")));
    control_.begin(request(), {{"S07", "", "", ""}, false, 0.1}, "");
    ASSERT_TRUE(answer_until([&] { return ended_ == 1; }));
    const SessionSign sign = sign_of(control_);
    EXPECT_EQ(sign.sign, Sign::fault);
    EXPECT_EQ(sign.word, "Did not start");
    EXPECT_TRUE(sign.text.contains("Where sessions go")) << sign.text.toStdString();
    EXPECT_TRUE(control_.recorded().isEmpty());
    control_.read(request(), std::nullopt);
    ASSERT_TRUE(comes_to(State::checked));
    EXPECT_EQ(sign_of(control_).word, "Did not start");
    control_.set_out(QString::fromStdString(folder_.path()));
    control_.begin(request(), {{"S07", "", "", ""}, false, 0.1}, "");
    EXPECT_EQ(sign_of(control_).word, "Starting");
    ASSERT_TRUE(answer_until([&] { return frames_ > 0; }));
    control_.stop();
    ASSERT_TRUE(answer_until([&] { return ended_ == 2; }));
    EXPECT_EQ(sign_of(control_).word, "Recorded");
}

TEST_F(SessionControlTest, NoSessionStartsFromAFileWithErrors) {
    const std::string file = folder_.write("open.yaml", "title: one\n");
    open(file);
    ASSERT_TRUE(answer_until([&] { return !control_.loading(); }));
    open("scenes/block-on-table.yaml");
    ASSERT_TRUE(comes_to(State::checked));
    session::Request wrong = request();
    wrong.file = folder_.write("wrong.yaml", "title: [\n");
    control_.begin(wrong, {{"S07", "", "", ""}, false, 0.1}, "");
    ASSERT_TRUE(comes_to(State::checked));
    EXPECT_EQ(sign_of(control_).word, "Did not start");
    EXPECT_TRUE(sign_of(control_).text.contains("wrong.yaml"));
}

/// The size beyond which this process cannot write a file, as on a full disk; no limit at the end.
class FullDisk {
  public:
    explicit FullDisk(rlim_t bytes) : handled_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FullDisk() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handled_);
    }

  private:
    void (*handled_)(int);
    rlimit before_{};
};

TEST_F(SessionControlTest, ASessionThatIsBrokenOffSaysWhyAndWhereItIs) {
    run(true);
    const FullDisk full(10'000);
    ASSERT_TRUE(answer_until([&] { return ended_ == 1; }));
    const SessionSign sign = sign_of(control_);
    EXPECT_EQ(sign.sign, Sign::fault);
    EXPECT_EQ(sign.word, "Broken off");
    ASSERT_TRUE(control_.last_end());
    EXPECT_TRUE(sign.text.contains("cannot be written")) << sign.text.toStdString();
    EXPECT_TRUE(sign.text.contains(QFileInfo(control_.recorded()).fileName()));
    EXPECT_TRUE(QFileInfo::exists(control_.recorded() + "/raw.log"));
}

TEST_F(SessionControlTest, ASessionWithTrialsLeftIsUnfinished) {
    control_.open("experiments/visuomotor-rotation.yaml");
    session::Request asked = request();
    asked.participant = "S07";
    asked.mouse = true;
    control_.read(asked, std::nullopt);
    ASSERT_TRUE(comes_to(State::checked));
    control_.begin(asked, {{"S07", "", "", ""}, false, 1}, "");
    ASSERT_TRUE(answer_until([&] { return control_.may(Act::skip); }));
    ASSERT_TRUE(answer_until([&] {
        control_.skip();
        return control_.runner().done() > 0;
    }));
    control_.stop();
    ASSERT_TRUE(answer_until([&] { return ended_ == 1; }));
    EXPECT_EQ(sign_of(control_).sign, Sign::warning);
    EXPECT_EQ(sign_of(control_).word, "Unfinished");
    const SessionEnd& end = *control_.last_end();
    EXPECT_GE(end.done, 1);
    EXPECT_EQ(end.trials, 504);
    const QString text = sign_of(control_).text;
    EXPECT_TRUE(
        text.startsWith(QString("%1 of 504 trials are done. F5 offers to continue.").arg(end.done)))
        << text.toStdString();
}

TEST_F(SessionControlTest, AWantedStartWaitsForTheFile) {
    open("scenes/block-on-table.yaml");
    EXPECT_FALSE(control_.want_start());
    ASSERT_TRUE(comes_to(State::checked));
    EXPECT_EQ(due_, 1);
    control_.read(request(), std::nullopt);
    EXPECT_FALSE(control_.want_start());
    control_.forget_start();
    ASSERT_TRUE(comes_to(State::checked));
    EXPECT_EQ(due_, 1);
}

TEST_F(SessionControlTest, ASessionStartsPausesAndEnds) {
    run();
    EXPECT_EQ(control_.state(), State::running);
    EXPECT_TRUE(allows({Act::pause, Act::stop, Act::force_off}));  // without trials
    control_.take_force_away("a reason");
    EXPECT_EQ(control_.state(), State::paused);
    EXPECT_TRUE(allows({Act::pause, Act::stop, Act::step}));
    EXPECT_EQ(control_.complaint(), "a reason");
    EXPECT_EQ(sign_of(control_).sign, Sign::fault);
    EXPECT_TRUE(sign_of(control_).text.contains("a reason"));
    control_.pause(false);
    EXPECT_EQ(control_.state(), State::running);
    EXPECT_TRUE(control_.complaint().isEmpty());
    control_.stop();
    ASSERT_TRUE(answer_until([&] { return ended_ == 1; }));
    EXPECT_GT(finishing_, 0);
    EXPECT_EQ(control_.state(), State::checked);
    EXPECT_FALSE(control_.recorded().isEmpty());
    EXPECT_FALSE(control_.cut());
    EXPECT_FALSE(control_.stale());
    control_.take_force_away("too late");
    EXPECT_TRUE(control_.complaint().isEmpty());
}

TEST_F(SessionControlTest, NotesAreEventsAtTheTimeAtWhichTheyWereBegun) {
    control_.note("nothing runs");
    run();
    ASSERT_TRUE(answer_until([&] { return frames_ > 0; }));
    control_.begin_note();
    const frame::Frame begun = control_.runner().frame();
    ASSERT_TRUE(answer_until([&] { return control_.runner().frame().sequence > begun.sequence; }));
    control_.note("  the participant\n said \"oh, no\" ");
    control_.note(" ");
    control_.note("and again");
    control_.stop();
    ASSERT_TRUE(answer_until([&] { return ended_ == 1; }));
    control_.note("too late");
    const auto folder = recording::SessionFolder::open(control_.recorded().toStdString());
    std::vector<rows::EventRow> notes;
    for (const rows::EventRow& event : rows::EventFile(folder.file("events.csv"))) {
        if (event.name == rows::kNote) notes.push_back(event);
    }
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_EQ(notes[0].detail, "the participant said \"oh, no\"");
    EXPECT_NEAR(notes[0].time, seconds(begun.time), 1e-6);
    EXPECT_EQ(notes[1].detail, "and again");
    EXPECT_GT(notes[1].time, notes[0].time);
    EXPECT_EQ(recording::read_remarks(folder)[0].tick, begun.sequence);
    EXPECT_TRUE(recording::broken_seals(folder, folder.read_info(), Severity::error).empty());
}

TEST_F(SessionControlTest, ANoteThatComesTooLateIsTold) {
    run();
    ASSERT_TRUE(answer_until([&] { return frames_ > 0; }));
    control_.begin_note();
    control_.stop();
    ASSERT_TRUE(answer_until([&] { return ended_ == 1; }));
    control_.note("coughed");
    EXPECT_TRUE(log_.join('\n').contains("coughed. File > Recorded sessions > Note"))
        << log_.join('\n').toStdString();
}

TEST_F(SessionControlTest, AMouseMovesTheHandInRealTime) {
    run(true);
    EXPECT_TRUE(allows({Act::pause, Act::stop, Act::move, Act::force_off}));
    control_.pause(true);
    EXPECT_TRUE(allows({Act::pause, Act::stop}));  // single ticks are not possible in real time
}

TEST_F(SessionControlTest, EachStateHasASignOfItsOwn) {
    std::map<QString, Sign> seen;  // by word
    const auto see = [&](Sign expected) {
        const SessionSign now = sign_of(control_);
        EXPECT_EQ(now.sign, expected) << now.word.toStdString();
        EXPECT_FALSE(now.word.isEmpty());
        EXPECT_FALSE(now.text.isEmpty()) << now.word.toStdString();
        EXPECT_TRUE(seen.emplace(now.word, now.sign).second) << now.word.toStdString();
    };
    see(Sign::idle);
    open("scenes/block-on-table.yaml");
    see(Sign::busy);
    ASSERT_TRUE(comes_to(State::checked));
    see(Sign::idle);
    run(true);
    see(Sign::running);
    EXPECT_EQ(word_for_pause(control_.state()), "Pause");
    EXPECT_EQ(word_for_stop(control_.state()), "End");
    control_.pause(true);
    see(Sign::paused);
    EXPECT_EQ(word_for_pause(control_.state()), "Resume");
    control_.pause(false);
    control_.take_force_away();
    see(Sign::stopped);
    EXPECT_TRUE(logged("stopped by Escape"));
    control_.pause(false);
    control_.take_force_away("The headset has stopped showing.");
    see(Sign::fault);
    control_.stop();
    ASSERT_TRUE(answer_until([&] { return ended_ == 1; }));
    see(Sign::idle);
    open("scenes/nowhere.yaml");
    ASSERT_TRUE(answer_until([&] { return !control_.loading(); }));
    see(Sign::fault);
}

TEST_F(SessionControlTest, ASessionThatIsAboutToStartCanBeDropped) {
    open("scenes/block-on-table.yaml");
    ASSERT_TRUE(comes_to(State::checked));
    control_.begin(request(), {{"S07", "", "", ""}, false, 0.1}, "");
    EXPECT_EQ(control_.state(), State::starting);
    EXPECT_TRUE(allows({Act::open, Act::start, Act::stop}));
    control_.drop_start();
    EXPECT_EQ(control_.state(), State::opening);
    ASSERT_TRUE(comes_to(State::checked));
    EXPECT_FALSE(logged("started"));
}

TEST_F(SessionControlTest, AFileThatChangesIsReadOnceTheSessionIsOver) {
    run();
    control_.read(request(), std::nullopt);
    EXPECT_TRUE(control_.stale());
    EXPECT_EQ(control_.state(), State::running);
    stop_ = true;
    ASSERT_TRUE(answer_until([&] { return ended_ == 1; }));
    EXPECT_TRUE(control_.stale());
    EXPECT_TRUE(control_.cut());
    control_.read(request(), std::nullopt);
    EXPECT_FALSE(control_.stale());
    EXPECT_EQ(control_.state(), State::opening);
}

TEST_F(SessionControlTest, AChangeOfTheFileIsReported) {
    const std::string file = folder_.write("open.yaml", "title: one\n");
    open(file);
    ASSERT_TRUE(answer_until([&] { return !control_.loading(); }));
    EXPECT_EQ(file_changes_, 0);
    folder_.write("open.yaml", "title: two\n");
    EXPECT_TRUE(answer_until([&] { return file_changes_ == 1; }));
}

}  // namespace
}  // namespace dihaptic::gui
