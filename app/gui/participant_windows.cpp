#include "participant_windows.h"

#include "base/field_writer.h"
#include "rig/libraries.h"

namespace dihaptic::gui {

namespace {

constexpr std::chrono::milliseconds kFollow{4};  // no screen shows pictures faster

/// The number of windows that a rig needs.
size_t windows_of(const rig::Rig& rig) {
    return rig.displays.empty() && !rig.headset ? 1 : rig.displays.size();
}

}  // namespace

ParticipantWindows::ParticipantWindows(QWidget& beside) : beside_(beside) {
    follow_.setInterval(kFollow);
    follow_.setTimerType(Qt::PreciseTimer);
    connect(&follow_, &QTimer::timeout, this, &ParticipantWindows::follow_head);
}

void ParticipantWindows::track(const std::optional<outlets::TrackedHead>& head) {
    if (head && tracker_ && to_yaml(write_fields(*head)) == to_yaml(write_fields(head_))) return;
    tracker_.reset();
    if (head) tracker_ = std::make_unique<outlets::HeadTracker>(head_ = *head);
    head ? follow_.start() : follow_.stop();
}

/// Starts tracking the head. The libraries are checked first, because a tracker's library may do
/// anything once it is loaded.
void ParticipantWindows::track_head_of(const rig::Rig& rig) {
    try {
        if (rig.head) rig::check_libraries(rig);
        track(rig.head);
    } catch (const Error& e) {
        track({});
        Q_EMIT told(e.what(), true);
    }
}

void ParticipantWindows::follow_head() {
    for (const outlets::HeadTracker::Told& told : tracker_->take_told())
        Q_EMIT this->told(QString::fromStdString(told.what), told.problem);
    if (const auto pose = tracker_->newest())
        each([&](SceneWidget& scene) { scene.set_head(*pose); });
}

void ParticipantWindows::show_first(qint64 tick) {
    if (const auto& head = first()->shown_to()) {
        Q_EMIT shown_to_head(
            {tick, std::chrono::steady_clock::now(), {head->R_WT, head->eyes}, head->seen});
    } else {
        Q_EMIT presented(tick);
    }
}

void ParticipantWindows::open(const rig::Rig& rig) {
    close();
    for (const display::Display& display : rig.displays) add(display);
    if (rig.headset) {
        add(*rig.headset);
    } else {
        if (windows_.empty()) add(std::optional<display::Display>());
        connect(first(), &SceneWidget::presented, this, &ParticipantWindows::show_first);
    }
    track_head_of(rig);
    Q_EMIT changed();
}

void ParticipantWindows::close() {
    windows_.clear();
    headset_.reset();
    track({});
    Q_EMIT changed();
}

void ParticipantWindows::add(const display::Headset& headset) {
    headset_ = std::make_unique<HeadsetView>(headset);
    connect(headset_.get(), &HeadsetView::told, this, &ParticipantWindows::told);
    connect(headset_.get(), &HeadsetView::shown, this, &ParticipantWindows::shown_to_head);
    // a queued connection, because the receiver deletes the headset
    connect(headset_.get(), &HeadsetView::ended, this, &ParticipantWindows::headset_ended,
            Qt::QueuedConnection);
}

void ParticipantWindows::add(const std::optional<display::Display>& display) {
    ParticipantWindow& window = *windows_.emplace_back(std::make_unique<ParticipantWindow>());
    window.scene().set_display(display);
    connect(&window, &ParticipantWindow::key_pressed, this, &ParticipantWindows::key_pressed);
    connect(&window.scene().questions(), &QuestionsView::clicked, this,
            &ParticipantWindows::clicked);
    // a queued connection, because the receiver deletes the window
    connect(&window, &ParticipantWindow::closed, this, &ParticipantWindows::closed,
            Qt::QueuedConnection);
    const QString monitor = display ? QString::fromStdString(display->monitor) : "";
    if (const QString wrong = show_on(window, monitor, beside_); !wrong.isEmpty())
        Q_EMIT told(wrong, true);
}

void ParticipantWindows::set_scene(const scene::Scene& scene, const frame::Frame& frame,
                                   const rig::Rig& rig) {
    if (empty()) return;
    const bool same_headset =
        headset_ ? rig.headset && headset_->is_at(*rig.headset) : !rig.headset;
    if (windows_.size() != windows_of(rig) || !same_headset) open(rig);
    track_head_of(rig);
    if (headset_) headset_->set_scene(scene, frame);
    for (size_t i = 0; i < windows_.size(); ++i) {
        SceneWidget& widget = windows_[i]->scene();
        widget.set_display(rig.displays.empty() ? std::nullopt : std::optional(rig.displays[i]));
        widget.set_scene(scene, frame);
    }
}

}  // namespace dihaptic::gui
