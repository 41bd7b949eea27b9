#include "session_player.h"

#include <QApplication>
#include <QBuffer>
#include <QComboBox>
#include <QDockWidget>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMenuBar>
#include <QPushButton>
#include <QScreen>
#include <QSlider>
#include <QSplitter>
#include <QStatusBar>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "curve_list.h"
#include "edited_file.h"
#include "event_words.h"
#include "film.h"
#include "help_page.h"
#include "icons.h"
#include "label_fit.h"
#include "layers_menu.h"
#include "moment_list.h"
#include "recording/log_scene.h"
#include "rows/episode_row.h"
#include "rows/event_row.h"
#include "rows/lift_row.h"
#include "rows/trial_row.h"
#include "save_dialog.h"
#include "saved_curves.h"
#include "time_chart.h"

namespace dihaptic::gui {
namespace {

constexpr int kSliderSteps = 100000;

/// The rows of a table of the session; empty if it has no table with that name.
template <class Row>
std::vector<Row> rows_of(const recording::SessionFolder& folder, const char* name) {
    const std::string file = folder.file(name);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return {};
    const rows::RowFile<Row> table(file);
    return {table.begin(), table.end()};
}

QString text(const std::string& of) {
    return QString::fromStdString(of);
}

scene::Scene scene_of(const recording::SessionFolder& folder) {
    Diagnostics diagnostics(UnknownKeys::are_left_out);
    scene::Scene out = scene::read_scene(folder.file("scene.yaml"), diagnostics);
    diagnostics.throw_if_errors();
    return out;
}

}  // namespace

SessionPlayer::SessionPlayer(const std::string& folder, QWidget* parent)
    : QMainWindow(parent),
      folder_(recording::SessionFolder::open(folder)),
      scene_(scene_of(folder_)),
      log_(folder_.raw_log()),
      view_(new SceneWidget),
      chart_(new TimeChart),
      moments_(new MomentList),
      curves_(new CurveList(scene_)) {
    recording::check_fits(log_.head(), scene_, folder_.raw_log());
    setAttribute(Qt::WA_DeleteOnClose);
    setWindowTitle(
        QString::fromStdString(std::filesystem::path(folder_.path()).filename().string()) +
        " - Dihaptic");
    auto* lower = new QWidget;
    auto* layout = new QVBoxLayout(lower);
    layout->setContentsMargins(6, 0, 6, 0);
    layout->addWidget(make_controls());
    layout->addWidget(chart_, 1);
    auto* splitter = new QSplitter(Qt::Vertical);
    splitter->addWidget(view_);
    splitter->addWidget(lower);
    splitter->setStretchFactor(0, 3);
    splitter->setStretchFactor(1, 2);
    setCentralWidget(splitter);
    view_->set_scene(scene_, log_.at(log_.begin()));
    connect(view_, &SceneWidget::failed, this,
            [this](const QString& why) { statusBar()->showMessage(why); });
    chart_->set_session(log_.begin(), log_.end());
    make_moments();
    make_curve_list();
    make_menus();
    connect(chart_, &TimeChart::moment_chosen, this, &SessionPlayer::go_to);
    read_.setSingleShot(true);
    connect(chart_, &TimeChart::stretch_changed, this, [this] { read_.start(120); });
    connect(&read_, &QTimer::timeout, this, &SessionPlayer::read_curves);
    resize(QSize(1200, 860).boundedTo(room_on(*screen())));
    choose_curves({"grip_force", "load_force"});
    go_to(log_.begin());
    view_->setFocus();
}

SessionPlayer::~SessionPlayer() = default;

QWidget* SessionPlayer::make_controls() {
    auto* row = new QWidget;
    auto* layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 4, 0, 0);
    const auto button = [&](std::string_view shape, const QString& what, auto done) {
        auto* out = new QPushButton(icon(shape), "");
        out->setToolTip(what);
        out->setAccessibleName(what);
        out->setFocusPolicy(Qt::NoFocus);
        out->setFixedWidth(40);
        connect(out, &QPushButton::clicked, this, done);
        layout->addWidget(out);
        return out;
    };
    button(shapes::kPrevious, tr("Previous moment (Page Up)"), [this] { next_moment(-1); });
    button(shapes::kBack, tr("Previous tick (Left)"), [this] { step(-1); });
    play_ =
        button(shapes::kPlay, tr("Play, or stop (Space)"), [this] { play(!playback_.plays()); });
    play_->setText(tr("Play"));
    play_->setFixedWidth(90);
    button(shapes::kForward, tr("Next tick (Right)"), [this] { step(1); });
    button(shapes::kNext, tr("Next moment (Page Down)"), [this] { next_moment(1); });
    auto* speed = new QComboBox;
    speed->setAccessibleName(tr("Speed"));
    speed->setFocusPolicy(Qt::NoFocus);
    for (const double times : {0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0})
        speed->addItem(QString("%1 x").arg(times), times);
    speed->setCurrentText("1 x");
    connect(speed, &QComboBox::currentIndexChanged, this,
            [this, speed] { playback_.set_speed(speed->currentData().toDouble()); });
    layout->addWidget(speed);
    slider_ = new QSlider(Qt::Horizontal);
    slider_->setAccessibleName(tr("Time"));
    slider_->setRange(0, kSliderSteps);
    slider_->setMinimumWidth(120);
    slider_->setFocusPolicy(Qt::NoFocus);
    connect(slider_, &QSlider::sliderMoved, this, [this](int at) {
        go_to(log_.begin() + (log_.end() - log_.begin()) * at / kSliderSteps);
    });
    layout->addWidget(slider_, 1);
    where_ = new QLabel;
    statusBar()->addPermanentWidget(where_);
    return row;
}

void SessionPlayer::make_file_menu() {
    QMenu* file = menuBar()->addMenu(tr("&File"));
    file->addAction(tr("Save &picture ..."), QKeySequence::Save, this,
                    &SessionPlayer::save_picture);
    file->addAction(tr("Save &video ..."), QKeySequence("Ctrl+Shift+S"), this,
                    &SessionPlayer::save_video);
    file->addAction(tr("Save c&urves ..."), QKeySequence("Ctrl+Shift+C"), this,
                    &SessionPlayer::save_curves);
    file->addSeparator();
    file->addAction(tr("&Close"), QKeySequence::Close, this, &QWidget::close);
    file->addAction(tr("&Quit"), QKeySequence::Quit, qApp, &QApplication::closeAllWindows);
}

void SessionPlayer::make_menus() {
    make_file_menu();
    QMenu* view = menuBar()->addMenu(tr("&View"));
    for (const view::Camera& camera : view_->cameras())
        view->addAction(QString::fromStdString(camera.name), this,
                        [this, name = camera.name] { view_->set_camera(name); });
    view->addSeparator();
    together_ = view->addAction(tr("&Together with other sessions"));
    together_->setCheckable(true);
    together_->setToolTip(tr("Shows the same time of the same trial"));
    view->addAction(choose_);
    for (QDockWidget* dock : findChildren<QDockWidget*>())
        view->addAction(dock->toggleViewAction());
    view->addSeparator();
    add_layers(*view, *view_);
    add_fine_pictures(*view, *view_);
    QMenu* help = menuBar()->addMenu(tr("&Help"));
    const auto page = [&](const QString& text, const QString& name) {
        help->addAction(text, this,
                        [this, name] { statusBar()->showMessage(show_help_page(name)); });
    };
    page(tr("This &window"), "window");
    page(tr("What is &recorded"), "quantities");
    page(tr("&Tables of a session"), "tables");
}

void SessionPlayer::list_trials() {
    for (const rows::TrialRow& row : rows_of<rows::TrialRow>(folder_, "trials.csv")) {
        if (std::isfinite(row.head.start) && row.asked.trial > 0)
            starts_.push_back({row.head.start, row.asked.trial});
        QStringList words{tr("trial %1 begins").arg(row.asked.trial)};
        if (!row.asked.condition.empty()) words += text(row.asked.condition);
        moments_->add(row.head.start, words.join(", "));
    }
    std::sort(starts_.begin(), starts_.end(),
              [](const Start& a, const Start& b) { return a.time < b.time; });
}

/// Lists the events found in the session's tables.
void SessionPlayer::make_moments() {
    const std::vector<std::string> fingers = scene::finger_names(scene_);
    list_trials();
    for (const rows::EventRow& event : rows_of<rows::EventRow>(folder_, "events.csv")) {
        if (event.name == "trial") continue;  // trials have already been listed
        if (event.name == "limit") {
            moments_->add_counted(event.time, sentence_of(event, fingers));
        } else {
            moments_->add(event.time, sentence_of(event, fingers));
        }
    }
    for (const rows::EpisodeRow& episode : rows_of<rows::EpisodeRow>(folder_, "episodes.csv"))
        moments_->add(episode.start, sentence_of(episode));
    for (const rows::LiftRow& lift : rows_of<rows::LiftRow>(folder_, "lifts.csv")) {
        // the events already include touch, lift-off, replacement and release
        moments_->add(lift.load_onset, tr("the load force begins, trial %1").arg(lift.trial));
        moments_->add(lift.first_slip, tr("a finger slips first, trial %1").arg(lift.trial));
    }
    moments_->finish();
    chart_->set_moments(moments_->times());
    connect(moments_, &MomentList::chosen, this, &SessionPlayer::go_to);
    auto* dock = new QDockWidget(tr("Moments"));
    dock->setWidget(moments_);
    addDockWidget(Qt::RightDockWidgetArea, dock);
    resizeDocks({dock}, {400}, Qt::Horizontal);
}

void SessionPlayer::make_curve_list() {
    connect(curves_, &CurveList::chosen, this, &SessionPlayer::choose_curves);
    auto* dock = new QDockWidget(tr("Curves"));
    dock->setWidget(curves_);
    addDockWidget(Qt::RightDockWidgetArea, dock);
    auto* find = new QAction(tr("Choose c&urves"), this);
    find->setShortcut(QKeySequence::Find);
    connect(find, &QAction::triggered, dock, [this, dock] {
        dock->show();
        curves_->find();
    });
    choose_ = find;
}

SessionPlayer::Moment SessionPlayer::moment() const {
    const auto next =
        std::upper_bound(starts_.begin(), starts_.end(), time_,
                         [](double time, const Start& start) { return time < start.time; });
    if (next == starts_.begin()) return {0, time_ - log_.begin()};
    const Start& start = *std::prev(next);
    return {start.trial, time_ - start.time};
}

void SessionPlayer::follow(const Moment& moment) {
    if (!together_->isChecked()) return;
    double begin = log_.begin(), end = log_.end();
    if (moment.trial > 0) {
        const auto start = std::find_if(starts_.rbegin(), starts_.rend(), [&](const Start& one) {
            return one.trial == moment.trial;
        });
        if (start == starts_.rend()) return;
        begin = start->time;
        if (start != starts_.rbegin()) end = std::prev(start)->time - log_.head().tick;
    }
    following_ = true;
    go_to(std::min(begin + moment.since, end));
    following_ = false;
}

void SessionPlayer::set_together(bool together) {
    together_->setChecked(together);
}

void SessionPlayer::choose_curves(const QStringList& expressions) {
    Diagnostics diagnostics;
    std::vector<task::RecordedValue> values;
    for (const QString& text : expressions)
        values.emplace_back(text.toStdString(), scene_, diagnostics);
    if (diagnostics.has_errors())
        return statusBar()->showMessage(
            QString::fromStdString(diagnostics.problems().front().text()));
    statusBar()->clearMessage();
    expressions_ = expressions;
    values_ = std::move(values);
    curves_->set_curves(expressions_);
    read_curves();
    go_to(time_);
}

void SessionPlayer::read_curves() {
    const double begin = chart_->begin(), end = chart_->end();
    disconnect(&reader_, nullptr, this, nullptr);
    connect(&reader_, &CurveReader::progressed, this,
            [this, begin, end](const std::vector<RecordedCurve>& curves, double share) {
                chart_->set_curves(curves, begin, end, share);
            });
    reader_.read({folder_.raw_log(), scene_, expressions_, begin, end});
}

void SessionPlayer::go_to(double time) {
    time_ = std::clamp(time, log_.begin(), log_.end());
    const frame::Frame& frame = log_.at(time_);
    view_->show_frame(frame);
    QStringList words;
    for (task::RecordedValue& value : values_) {
        const double now = value(frame);
        words += std::isnan(now) ? QString() : QString::number(now, 'g', 4);
    }
    chart_->set_values(words);
    chart_->set_cursor(time_);
    moments_->show_time(time_);
    slider_->setValue(static_cast<int>(kSliderSteps * (time_ - log_.begin()) /
                                       std::max(1e-9, log_.end() - log_.begin())));
    QString where = tr("%1 s of %2 s, tick %3")
                        .arg(seconds(frame.time), 0, 'f', 3)
                        .arg(log_.end(), 0, 'f', 3)
                        .arg(frame.sequence);
    if (frame.trial > 0) where += tr(", trial %1").arg(frame.trial);
    where_->setText(where);
    if (following_ || !together_->isChecked()) return;
    for (QWidget* window : QApplication::topLevelWidgets()) {
        auto* other = qobject_cast<SessionPlayer*>(window);
        if (other != nullptr && other != this) other->follow(moment());
    }
}

void SessionPlayer::play(bool on) {
    play_->setText(on ? tr("Stop") : tr("Play"));
    play_->setIcon(icon(on ? shapes::kPause : shapes::kPlay));
    if (!on) return playback_.stop();
    if (time_ >= log_.end()) go_to(log_.begin());
    playback_.start();
}

void SessionPlayer::go_on(double passed) {
    go_to(time_ + passed);
    if (time_ >= log_.end()) play(false);
}

void SessionPlayer::step(int frames) {
    play(false);
    const double tick = log_.head().tick;
    // relative to the displayed tick, not to a time within the tick
    const double shown = seconds(log_.at(time_).time);
    go_to(shown + (frames + 0.01) * tick);
}

void SessionPlayer::next_moment(int way) {
    if (const auto time = moments_->next_from(time_, way)) go_to(*time);
}

/// The name of a file that is made from this session: outside the session's folder, it tells whose
/// it is.
QString SessionPlayer::own_name(const QString& what) const {
    return text(std::filesystem::path(folder_.path()).filename().string()) + "-" + what;
}

void SessionPlayer::save_picture() {
    const QString file = ask_where_to_save({tr("Save the picture"),
                                            own_name(QString("at-%1-s.png").arg(time_, 0, 'f', 3)),
                                            tr("Pictures (*.png)"),
                                            {".png"}},
                                           this);
    if (file.isEmpty()) return;
    QByteArray picture;
    QBuffer to(&picture);
    try {
        if (!view_->grabFramebuffer().save(&to, "PNG")) throw Error("there is no picture", "");
        replace_file(file, picture);
        remember_folder_of(file);
        statusBar()->showMessage(tr("picture: %1").arg(file));
    } catch (const Error& e) {
        statusBar()->showMessage(QString::fromStdString(e.problems().front().text()));
    }
}

void SessionPlayer::save_curves() {
    const QString file =
        ask_where_to_save({tr("Save the stretch that the curves show, as a figure or as numbers"),
                           own_name("curves.svg"),
                           tr("Figures and tables (*.svg *.pdf *.png *.csv)"),
                           {".svg", ".pdf", ".png", ".csv"}},
                          this);
    if (file.isEmpty()) return;
    try {
        if (file.endsWith(".csv")) {
            const Table table =
                table_of_curves(log_, values_, expressions_, chart_->begin(), chart_->end());
            replace_file(file, QByteArray::fromStdString(to_csv(table)));
        } else {
            save_figure(*chart_, file);
        }
        remember_folder_of(file);
        statusBar()->showMessage(tr("curves: %1").arg(file));
    } catch (const Error& e) {
        statusBar()->showMessage(QString::fromStdString(e.problems().front().text()));
    }
    go_to(time_);
}

void SessionPlayer::save_video() {
    play(false);
    const Film film{ask_where_to_save({tr("Save a video of the stretch that the curves show"),
                                       own_name("video.mp4"),
                                       tr("Videos (*.mp4)"),
                                       {".mp4"}},
                                      this),
                    chart_->begin(), chart_->end(), playback_.speed(),
                    [this](double time) { go_to(time); }};
    if (film.file.isEmpty()) return;
    const double before = time_;
    try {
        const bool made = make_film(film, *view_, this);
        if (made) remember_folder_of(film.file);
        statusBar()->showMessage(made ? tr("video: %1").arg(film.file) : tr("there is no video"));
    } catch (const Error& e) {
        statusBar()->showMessage(QString::fromStdString(e.problems().front().text()));
    }
    go_to(before);
}

void SessionPlayer::keyPressEvent(QKeyEvent* event) {
    const bool far = event->modifiers().testFlag(Qt::ShiftModifier);
    switch (event->key()) {
        case Qt::Key_Space:
            play(!playback_.plays());
            break;
        case Qt::Key_Left:
            step(far ? -100 : -1);
            break;
        case Qt::Key_Right:
            step(far ? 100 : 1);
            break;
        case Qt::Key_PageUp:
            next_moment(-1);
            break;
        case Qt::Key_PageDown:
            next_moment(1);
            break;
        case Qt::Key_Home:
            go_to(log_.begin());
            break;
        case Qt::Key_End:
            go_to(log_.end());
            break;
        default:
            QMainWindow::keyPressEvent(event);
    }
}

void open_sessions(const QStringList& folders) {
    std::vector<std::unique_ptr<SessionPlayer>> players;
    for (const QString& folder : folders)
        players.push_back(std::make_unique<SessionPlayer>(folder.toStdString()));
    const QRect room = QGuiApplication::primaryScreen()->availableGeometry();
    for (size_t i = 0; i < players.size(); ++i) {
        SessionPlayer* const player = players[i].release();  // deletes itself when closed
        if (folders.size() == 2) {
            player->set_together(true);
            // half a screen has no room for the list of moments; the View menu can show it again
            for (QDockWidget* dock : player->findChildren<QDockWidget*>()) dock->hide();
            player->resize(room_on(*player->screen(), 2));
            // a position is that of the frame
            player->move(room.left() + (i == 0 ? 0 : room.width() / 2), room.top());
        }
        player->show();
    }
}

}  // namespace dihaptic::gui
