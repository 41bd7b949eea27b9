#include "session_panel.h"

#include <QFileInfo>
#include <QRegularExpressionValidator>
#include <QVBoxLayout>

#include "icons.h"
#include "session_sign.h"

namespace dihaptic::gui {

void set_up_identifier(QLineEdit& field) {
    field.setPlaceholderText(QObject::tr("e.g. S07"));
    field.setValidator(
        new QRegularExpressionValidator(QRegularExpression("[A-Za-z0-9_-]{0,40}"), &field));
}

SessionPanel::SessionPanel(SessionControl& control)
    : control_(control),
      sign_(new SignLabel(this)),
      form_(new QFormLayout),
      file_row_(new QHBoxLayout),
      file_(new QLabel(tr("none"))),
      rig_(new QComboBox),
      participant_(new QLineEdit),
      hand_(new QComboBox),
      pace_(new QComboBox),
      open_(new QPushButton(tr("&Open ..."))),
      start_(new QPushButton(icon(shapes::kPlay), tr("Start"))),
      pause_(new QPushButton),
      skip_(new QPushButton(icon(shapes::kSkip), tr("Skip"))),
      stop_(new QPushButton(icon(shapes::kStop), "")),
      report_(new QPushButton(icon(shapes::kLook), tr("Report"))),
      trial_(new QLabel),
      names_(new QLabel),
      progress_(new QProgressBar),
      strip_(new TrialStrip),
      note_(new QLineEdit) {
    make_form();
    // as wide as possible, so that nothing moves under the pointer
    for (QLabel* label : {trial_, names_})
        label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
    trial_->setFont(sized(font(), type::kLarge, true));
    names_->setFont(sized(font(), type::kHeading));
    names_->setWordWrap(true);
    progress_->setTextVisible(true);

    auto* layout = new QVBoxLayout(this);
    layout->setSpacing(space::kUsual);
    sign_->show();
    layout->addWidget(sign_);
    layout->addWidget(trial_);
    layout->addWidget(names_);
    layout->addWidget(progress_);
    layout->addWidget(strip_);
    layout->addLayout(form_);
    make_buttons();
    layout->addWidget(note_);
    setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Maximum);

    connect_control();
    show_state();
}

void SessionPanel::make_form() {
    file_->setTextInteractionFlags(Qt::TextSelectableByMouse);
    rig_->addItem(tr("as in the file"), QString());
    rig_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    set_up_identifier(*participant_);
    set_up_hand();
    file_row_->addWidget(file_, 1);
    file_row_->addWidget(open_);
    form_->addRow(tr("File"), file_row_);
    form_->addRow(tr("&Rig"), rig_);
    form_->addRow(tr("Partici&pant"), participant_);
    form_->addRow(tr("H&and moved by"), hand_);
    form_->addRow(tr("Pace"), pace_);
    connect(open_, &QPushButton::clicked, this, &SessionPanel::open_requested);
    connect(rig_, &QComboBox::activated, this, &SessionPanel::choice_changed);
    note_->setAccessibleName(tr("Note"));
    note_->setToolTip(
        tr("F3: Enter records this note, with the time and the trial at which you begin to write"));
    connect(note_, &QLineEdit::textEdited, this, [this](const QString& text) {
        text.isEmpty() ? control_.drop_note() : control_.begin_note();
    });
    connect(note_, &QLineEdit::returnPressed, this, [this] {
        store_note();
        Q_EMIT note_written();
    });
}

void SessionPanel::make_buttons() {
    start_->setToolTip("F5");
    pause_->setToolTip(tr("F6: time stands still, and no force acts"));
    skip_->setToolTip(tr("F8: this trial ends and is recorded as skipped; the next one starts"));
    stop_->setToolTip(tr("F7: ends the session properly"));
    auto* buttons = new QHBoxLayout;
    buttons->setSpacing(space::kTight);
    report_->setToolTip(tr("Ctrl+R: the report of the session that has just been recorded"));
    for (QPushButton* button : {start_, pause_, skip_, stop_, report_}) buttons->addWidget(button);
    qobject_cast<QVBoxLayout*>(layout())->addLayout(buttons);
    connect(start_, &QPushButton::clicked, this, &SessionPanel::start_requested);
    connect(pause_, &QPushButton::clicked, &control_,
            [this] { control_.pause(control_.state() != SessionControl::State::paused); });
    connect(skip_, &QPushButton::clicked, &control_, &SessionControl::skip);
    connect(stop_, &QPushButton::clicked, &control_, &SessionControl::stop);
    connect(report_, &QPushButton::clicked, this, &SessionPanel::report_requested);
}

void SessionPanel::connect_control() {
    connect(&control_, &SessionControl::changed, this, &SessionPanel::show_state);
    connect(&control_, &SessionControl::opened, this, [this] {
        file_->setText(QFileInfo(control_.file()).fileName());
        file_->setToolTip(control_.file());
    });
    connect(&control_, &SessionControl::progressed, this, [this](const SessionProgress& now) {
        if (control_.has_trials()) set_trial(now.trial, now.names);
        set_progress(now.share, now.text);
    });
    connect(&control_, &SessionControl::finishing_progressed, this,
            [this](double share) { set_progress(share, tr("writing files: %p %")); });
    connect(&control_, &SessionControl::started, strip_,
            [this](const session::Plan& plan) { strip_->set_plan(plan.task); });
    connect(&control_, &SessionControl::opened, strip_, [this] { strip_->set_plan(nullptr); });
    connect(&control_, &SessionControl::trial_ended, strip_, &TrialStrip::add);
    connect(&control_, &SessionControl::framed, strip_,
            [this](const frame::Frame& frame) { strip_->set_current(frame.trial); });
    connect(&control_, &SessionControl::ending, this, &SessionPanel::store_note);
    connect(&control_, &SessionControl::ended, this, [this] {
        store_note();
        strip_->set_current(0);
    });
}

/// Sets up the choice of what moves the simulated hands, and of the speed of simulated time.
void SessionPanel::set_up_hand() {
    hand_->addItems({tr("the mouse"), tr("the file's script"), tr("a simulated person")});
    hand_->setToolTip(tr(
        "Who holds the simulated devices. A simulated person does the trials of an experiment, and "
        "sees, feels, adapts and answers (dihaptic run --simulate). A person holds real devices."));
    for (const auto& [name, pace] :
         {std::pair(tr("in real time"), 1.0), std::pair(tr("10 times faster"), 10.0),
          std::pair(tr("as fast as possible"), 0.0), std::pair(tr("10 times slower"), 0.1)})
        pace_->addItem(name, pace);
    pace_->setToolTip(
        tr("The speed of a simulated hand's time. No result depends on it. While the session is "
           "paused, Ctrl+. does one tick."));
    connect(hand_, &QComboBox::activated, this, &SessionPanel::choice_changed);
    connect(hand_, &QComboBox::currentIndexChanged, this, &SessionPanel::show_pace);
    connect(pace_, &QComboBox::activated, this, [this] { control_.set_pace(pace()); });
}

void SessionPanel::show_pace() {
    const SessionRunner& runner = control_.runner();
    form_->setRowVisible(pace_,
                         runner.running() ? runner.on_virtual_clock() : hand() != Hand::mouse);
}

void SessionPanel::set_rigs(const QStringList& files) {
    const QString chosen = rig();
    while (rig_->count() > 1) rig_->removeItem(1);
    for (const QString& file : files) rig_->addItem(QFileInfo(file).completeBaseName(), file);
    rig_->setCurrentIndex(std::max(0, rig_->findData(chosen)));
}

double SessionPanel::pace() const {
    return hand() == Hand::mouse ? 1 : pace_->currentData().toDouble();
}

void SessionPanel::show_state() {
    using Act = SessionControl::Act;
    const bool idle = control_.may(Act::open);
    const bool opening = idle && control_.loading();
    const bool trials = control_.has_trials();
    show_sign();
    const bool runs = control_.runner().running();
    trial_->setVisible(trials && runs);
    if (!runs) show_title();
    names_->setVisible((trials && runs) || !names_->text().isEmpty());
    progress_->setVisible(runs || control_.loading());
    strip_->setVisible(strip_->has_trials());
    note_->setVisible(runs);
    note_->setPlaceholderText(trials ? tr("Note on this trial (F3)") : tr("Note (F3)"));
    // what cannot be chosen now is not there, except for the pace of simulated time
    form_->setRowVisible(file_row_, !runs);
    form_->setRowVisible(rig_, !runs);
    form_->setRowVisible(hand_, !runs);
    show_pace();
    // for trials by anyone else, the window asks who does them
    form_->setRowVisible(participant_, !runs && (!trials || hand() == Hand::person));
    for (QWidget* choice : std::initializer_list<QWidget*>{open_, rig_, participant_, hand_})
        choice->setEnabled(idle);
    if (idle) {
        // Qt's busy indicator is not used: its Fusion style keeps animating, 60 times a second,
        // even after the bar has an end again
        progress_->setRange(0, 1);
        progress_->setValue(0);
        progress_->setFormat(opening ? tr("opening") : "");
    }
}

/// Shows the sign of the session, and the buttons that do something now.
void SessionPanel::show_sign() {
    using State = SessionControl::State;
    using Act = SessionControl::Act;
    const State state = control_.state();
    const SessionSign sign = sign_of(control_);
    if (sign_->set("", sign.word, sign.sign))
        sign_->set_letter(qRound(type::kLarge * fontMetrics().ascent()));
    start_->setEnabled(control_.may(Act::prepare));
    pause_->setText(word_for_pause(state));
    pause_->setIcon(icon(state == State::paused ? shapes::kPlay : shapes::kPause));
    pause_->setEnabled(control_.may(Act::pause));
    stop_->setText(word_for_stop(state));
    stop_->setEnabled(control_.may(Act::stop));
    skip_->setEnabled(control_.may(Act::skip));
    const bool runs = control_.runner().running();
    start_->setVisible(!runs);
    pause_->setVisible(runs);
    skip_->setVisible(runs && control_.has_trials());
    stop_->setVisible(runs || control_.may(Act::stop));
    report_->setVisible(!runs && !control_.recorded().isEmpty());
}

void SessionPanel::store_note() {
    control_.note(note_->text());
    note_->clear();
}

void SessionPanel::write_note() {
    note_->setFocus();
}

void SessionPanel::set_progress(double share, const QString& text) {
    progress_->setRange(0, 1000);
    progress_->setValue(static_cast<int>(1000 * share));
    progress_->setFormat(text);
}

void SessionPanel::show_title() {
    if (!control_.plan()) return set_trial("", "");
    QString title = QString::fromStdString(control_.plan()->title);
    if (const auto& task = control_.plan()->task) {
        const size_t trials = task->trials.size();
        title += trials == 1 ? tr(" (1 trial)") : tr(" (%1 trials)").arg(trials);
    }
    set_trial("", title);
}

void SessionPanel::set_trial(const QString& number, const QString& names) {
    trial_->setText(number);
    if (names_->text() == names) return;
    names_->setText(names);
    fit_names();
}

void SessionPanel::fit_names() {
    // the label's own width says nothing while it is hidden
    const QMargins margins = layout()->contentsMargins();
    const int width = std::max(1, this->width() - margins.left() - margins.right());
    names_->setMinimumHeight(0);  // else the label would ask for no less than it has
    names_->setFixedHeight(std::max(0, names_->heightForWidth(width)));
}

void SessionPanel::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    fit_names();
}

}  // namespace dihaptic::gui
