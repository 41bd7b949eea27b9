#include "session_control.h"

#include <algorithm>
#include <utility>

#include "headset_view.h"
#include "plain_text.h"

namespace dihaptic::gui {
namespace {

/// The clock of a session. A hand moved by a person, or by a script in the person's place, requires
/// real time.
session::Clock clock_of(const session::Plan& plan, double pace) {
    const bool at_own_pace = plan.moved_by.mover == recording::Mover::simulated_person || pace != 1;
    return at_own_pace && !plan.moved_by.person() && !rig::is_real(plan.rig)
               ? session::Clock::virtual_clock
               : session::Clock::real;
}

}  // namespace

SessionControl::SessionControl(QString out, double sync, std::atomic<bool>& stop)
    : out_(std::move(out)), sync_(sync), runner_(stop) {
    connect(&loader_, &Loader::opened, this, &SessionControl::take);
    connect(&loader_, &Loader::refused, this, &SessionControl::refuse);
    // the signal comes from the loader's thread, so it may arrive after loading has ended
    connect(&loader_, &Loader::waits, this, [this](const QString& what, int seconds, int most) {
        if (loader_.loading())
            Q_EMIT progressed({"", "", most > 0 ? static_cast<double>(seconds) / most : 0,
                               tr("%1: %2 s of %3 s at most").arg(what).arg(seconds).arg(most)});
    });
    connect(&file_, &WatchedFile::changed, this, &SessionControl::file_changed);
    connect(&runner_, &SessionRunner::ended, this, &SessionControl::end);
    connect(&runner_, &SessionRunner::paused_at_once, this, &SessionControl::pause_for_escape);
    connect(&runner_, &SessionRunner::warned, this,
            [this](const QString& message) { log(message, true); });
    connect(&runner_, &SessionRunner::finishing_progressed, this,
            &SessionControl::finishing_progressed);
    connect(&figures_, &TrialFigures::found, this, &SessionControl::measured);
}

SessionControl::State SessionControl::state() const {
    if (runner_.finishing()) return State::finishing;
    if (runner_.running()) return runner_.paused() ? State::paused : State::running;
    if (loader_.loading()) return starts_ ? State::starting : State::opening;
    return plan_ ? State::checked : State::no_file;
}

bool SessionControl::may(Act act) const {
    const auto in = [now = state()](std::initializer_list<State> states) {
        return std::find(states.begin(), states.end(), now) != states.end();
    };
    switch (act) {
        case Act::open:
            return in({State::no_file, State::opening, State::checked, State::starting});
        case Act::start:
            return in({State::opening, State::checked, State::starting});
        case Act::prepare:
            return in({State::checked});
        case Act::calibrate:
            return in({State::no_file, State::checked});
        case Act::pause:
            return in({State::running, State::paused});
        case Act::stop:
            return in({State::opening, State::starting, State::running, State::paused});
        case Act::skip:
            return in({State::running}) && has_trials();
        case Act::step:
            return in({State::paused}) && runner_.on_virtual_clock();
        case Act::move:
            return in({State::running}) && runner_.plan().mouse;
        case Act::force_off:
            return in({State::running});
    }
    return false;
}

void SessionControl::set_out(const QString& folder) {
    out_ = folder;
    log(tr("sessions are stored in %1").arg(folder));
}

bool SessionControl::has_trials() const {
    return runner_.running() ? runner_.plan().task != nullptr : plan_ && plan_->task;
}

TaskTexts::Words SessionControl::words() const {
    return runner_.running() ? texts_.words(runner_.plan()) : TaskTexts::Words{};
}

std::optional<Asked> SessionControl::asked() const {
    if (!may(Act::skip)) return {};
    return asked_in(runner_.frame(), *runner_.plan().task);
}

void SessionControl::open(const QString& file) {
    file_.open(file);
    starts_.reset();
    last_end_.reset();
    recorded_.clear();
}

void SessionControl::read(const session::Request& request, const std::optional<std::string>& text) {
    changed_ = runner_.running() || starts_;
    if (changed_) return;
    loader_.load({request, false, false, "", text});
    Q_EMIT changed();
}

void SessionControl::take(const Opened& opened) {
    auto devices = loader_.take_devices();  // closed on return, unless a session starts now
    if (runner_.running()) return;
    plan_ = opened.plan;
    frame_ = opened.frame;
    complaint_.clear();
    if (text_ == Text::wrong) text_ = Text::edited;
    if (last_end_ && last_end_->by_text) last_end_.reset();  // the errors are mended
    // opening the devices may have added warnings
    QStringList warnings;
    for (const Problem& warning : plan_->warnings)
        warnings += QString::fromStdString(warning.text());
    Q_EMIT judged(warnings);
    if ((!starts_ || rig::is_real(plan_->rig)) && !edited()) {
        for (const QString& warning : warnings) log(warning, true);
    }
    Q_EMIT this->opened(opened);
    for (const QString& line : opened.told) log(line);
    if (starts_) {
        Start start = *std::exchange(starts_, std::nullopt);
        start.participant = opened.participant.value_or(start.participant);
        if (opened.in_study) start.in_study = opened.in_study;  // of a resumed session
        return run(start, std::move(devices));
    }
    if (!edited()) log(tr("opened %1: %2").arg(file(), QString::fromStdString(plan_->title)));
    Q_EMIT changed();
    if (start_when_opened_) Q_EMIT start_due();
}

void SessionControl::refuse(const QStringList& problems, bool of_file) {
    const bool starting = starts_.has_value();
    starts_.reset();
    if (of_file && !starting && edited()) text_ = Text::wrong;
    const bool wanted = std::exchange(start_when_opened_, false);
    if (starting) {
        refuse_to_start(problems.front(), of_file);
        for (const QString& problem : problems.mid(1)) log(problem, true);
    } else if (wanted && edited()) {
        refuse_text_to_start();
    }
    Q_EMIT judged(problems);
    if (!edited() && !starting) {  // while typing, the user sees errors marked in the text
        complaint_ = problems.front();
        for (const QString& problem : problems) log(problem, true);
        if (plan_) log(tr("The open file stays unchanged."));
    }
    Q_EMIT changed();
    if (changed_) Q_EMIT file_changed();
}

bool SessionControl::want_start() {
    start_when_opened_ = loader_.loading() && !starts_;
    if (!may(Act::prepare)) return false;
    if (text_ != Text::wrong) return true;
    refuse_text_to_start();
    return false;
}

void SessionControl::refuse_text_to_start() {
    refuse_to_start(tr("The text has errors: it was not saved, and no session starts. They are "
                       "underlined in the text (Ctrl+E)."),
                    true);
}

void SessionControl::refuse_to_start(const QString& why, bool by_text) {
    log(why, true);
    SessionEnd& end = last_end_.emplace();
    end.why = why;
    end.by_text = by_text;
    Q_EMIT changed();
}

void SessionControl::forget_start() {
    start_when_opened_ = false;
    starts_.reset();
}

void SessionControl::begin(session::Request request, const Start& start,
                           const std::string& resumes) {
    request.participant = start.participant.id;
    starts_ = start;
    last_end_.reset();
    complaint_.clear();
    loader_.load({request, true, start.by_person, resumes});
    Q_EMIT changed();
}

void SessionControl::run(const Start& start, std::unique_ptr<devices::DeviceGroup> devices) {
    session::RunOptions options;
    options.out = start.out.empty() ? out_.toStdString() : start.out;
    options.sync = sync_;
    options.command = "dihaptic gui " + file().toStdString();
    options.participant = start.participant;
    options.in_study = start.in_study;
    options.clock = clock_of(*plan_, start.pace);
    // the scene shown is the resumed session's, not the file's
    changed_ = changed_ || !plan_->resumes.empty();
    escaped_ = false;
    meter_.begin(start.pace);
    Q_EMIT prepared(*plan_, options);
    runner_.start(*plan_, options, start.pace, std::move(devices),
                  plan_->rig.headset ? HeadsetView::frames_from(frame_) : nullptr);
    const session::Plan& plan = runner_.plan();
    Q_EMIT started(plan);
    log(tr("started: %1").arg(QString::fromStdString(plan.title)));
    if (start.by_person && !plan.task)
        log(tr("Simulated people do trials, but this file has none: its script moves the hand."));
    Q_EMIT changed();
}

void SessionControl::stop() {
    forget_start();
    if (runner_.running()) {
        Q_EMIT ending();
        runner_.end();
    }
    if (loader_.loading()) loader_.cancel();
}

void SessionControl::skip() {
    if (!may(Act::skip)) return;
    runner_.skip();
    log(tr("trial skipped"));
}

void SessionControl::pause(bool paused) {
    if (!may(Act::pause)) return;
    runner_.set_paused(paused);
    complaint_.clear();
    escaped_ = false;
    log(!paused ? tr("resumed")
        : runner_.on_virtual_clock()
            ? tr("paused. F6 resumes, Ctrl+. does one tick, F7 ends the session.")
            : tr("paused: force is off. F6 resumes, F7 ends the session."));
    if (paused) Q_EMIT rested(tr("force off"));
    Q_EMIT changed();
}

void SessionControl::pause_for_escape() {
    if (!may(Act::pause)) return;
    runner_.set_paused(true);
    if (!std::exchange(escaped_, true))
        log(tr("stopped by Escape: force is off. F6 resumes, F7 ends the session."), true);
    Q_EMIT rested(tr("force off"));
    Q_EMIT changed();
}

void SessionControl::take_force_away(const QString& why) {
    if (!runner_.running() || runner_.paused()) return;
    if (why.isEmpty()) return pause_for_escape();
    pause(true);
    complaint_ = why;
    Q_EMIT changed();
}

void SessionControl::set_pace(double pace) {
    if (starts_) starts_->pace = pace;
    if (runner_.running() && runner_.on_virtual_clock()) runner_.set_pace(pace);
}

void SessionControl::begin_note() {
    if (begun_ || !runner_.running()) return;
    const frame::Frame& frame = runner_.frame();
    begun_ = recording::Remark{std::max<int64_t>(frame.sequence, 0), seconds(frame.time),
                               has_trials() ? frame.trial : 0, recording::iso_now(), ""};
}

void SessionControl::note(const QString& text) {
    begin_note();
    std::optional<recording::Remark> remark = std::exchange(begun_, std::nullopt);
    const QString said = clean_text(text).simplified();
    if (!remark || said.isEmpty()) return;
    remark->text = said.toStdString();
    const QString line = QString::fromStdString(recording::describe(*remark));
    if (runner_.running() && runner_.add_remark(*remark)) {
        log(tr("note: %1").arg(line));
    } else {
        log(tr("The session ended before this note was stored: %1. File > Recorded sessions > Note "
               "adds it to the session.")
                .arg(line),
            true);
    }
}

void SessionControl::turn_knobs(const frame::Knobs& knobs, const QString& what) {
    if (!runner_.running()) return;
    runner_.turn_knobs(knobs);
    log(what);
}

void SessionControl::press(char key) {
    if (key != 0 && runner_.running() && runner_.plan().task) runner_.press(key);
}

void SessionControl::click(const task::Click& click) {
    if (runner_.running() && runner_.plan().task) runner_.click(click);
}

void SessionControl::refresh() {
    if (!runner_.running()) return;
    if (const QString told = runner_.take_told(); !told.isEmpty()) {
        complaint_ = told;
        log(told, true);
        Q_EMIT rested(tr("force off: fault"));
        Q_EMIT changed();
    }
    while (const auto sample = runner_.take_sample()) Q_EMIT sampled(*sample);
    while (const auto end = runner_.take_trial_end()) Q_EMIT trial_ended(*end);
    if (const QString folder = runner_.take_folder(); !folder.isEmpty()) {
        if (runner_.plan().task) figures_.follow(folder);
    }
    if (const frame::Frame& frame = runner_.read_frame(); frame.sequence >= 0) show(frame);
    if (runner_.finishing()) Q_EMIT changed();
}

void SessionControl::show(const frame::Frame& frame) {
    Q_EMIT framed(frame);
    if (runner_.finishing()) return;
    if (texts_.follow(runner_.plan(), frame)) Q_EMIT changed();
    Q_EMIT progressed(meter_.of(runner_.plan(), frame, runner_.done(), runner_.paused()));
}

void SessionControl::end(const SessionEnd& end) {
    cut_ = runner_.stopped();
    texts_.clear();
    complaint_.clear();
    for (const QString& message : end.messages) log(message, !end.good);
    for (const QString& aside : end.asides) log(aside);
    figures_.finish();
    last_end_ = end;
    recorded_ = end.folder;
    if (!end.folder.isEmpty()) log(tr("recorded in %1").arg(end.folder));
    Q_EMIT rested(tr("idle"));
    Q_EMIT changed();
    Q_EMIT ended();
}

}  // namespace dihaptic::gui
