#include "subject_windows.h"

namespace dihaptic::gui {

void SubjectWindows::open(const std::vector<rig::Display>& displays) {
    windows_.clear();
    for (const rig::Display& display : displays) add(display);
    if (displays.empty()) add({});
    connect(&first(), &SceneWidget::presented, this, &SubjectWindows::presented);
}

void SubjectWindows::add(const std::optional<rig::Display>& display) {
    SubjectWindow& window = *windows_.emplace_back(std::make_unique<SubjectWindow>());
    window.scene().set_display(display);
    connect(&window, &SubjectWindow::key_pressed, this, &SubjectWindows::key_pressed);
    connect(&window.scene().rating(), &RatingView::clicked, this, &SubjectWindows::clicked);
    // queued: who hears it deletes the window
    connect(&window, &SubjectWindow::closed, this, &SubjectWindows::closed, Qt::QueuedConnection);
    const QString monitor = display ? QString::fromStdString(display->monitor) : "";
    if (const QString wrong = show_on(window, monitor, beside_); !wrong.isEmpty())
        Q_EMIT complained(wrong);
}

void SubjectWindows::set_scene(const scene::Scene& scene, const servo::Frame& frame,
                               const std::vector<rig::Display>& displays) {
    if (windows_.empty()) return;
    if (windows_.size() != std::max<size_t>(1, displays.size())) open(displays);
    for (size_t i = 0; i < windows_.size(); ++i) {
        SceneWidget& widget = windows_[i]->scene();
        widget.set_display(displays.empty() ? std::nullopt : std::optional(displays[i]));
        widget.set_scene(scene, frame);
    }
}

}  // namespace dihaptic::gui
