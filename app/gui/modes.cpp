#include "modes.h"

#include <QHBoxLayout>
#include <QSettings>
#include <QToolButton>
#include <algorithm>
#include <utility>

#include "icons.h"
#include "theme.h"

namespace dihaptic::gui {
namespace {

const std::set<Mode> kAllModes{Mode::prepare, Mode::run, Mode::look};

/// Name of a mode in the settings.
const char* name_of(Mode mode) {
    return mode == Mode::prepare ? "prepare" : mode == Mode::run ? "run" : "look";
}

}  // namespace

Modes::Modes(QWidget* window) : QObject(window) {}

void Modes::add(QDockWidget* dock, std::set<Mode> in) {
    add_panel(dock, std::move(in), false);
}

void Modes::add_drawer(QDockWidget* dock) {
    add_panel(dock, {}, true);
}

void Modes::add_panel(QDockWidget* dock, std::set<Mode> in, bool drawer) {
    panels_.push_back({dock, std::move(in), drawer});
    connect(dock->toggleViewAction(), &QAction::toggled, this,
            [this, dock](bool shown) { note(dock, shown); });
}

/// Notes that the user has opened or closed a panel.
void Modes::note(QDockWidget* dock, bool shown) {
    // a window that is closed hides its panels, too
    if (arranging_ || !qobject_cast<QWidget*>(parent())->isVisible()) return;
    Panel& panel = *std::ranges::find(panels_, dock, &Panel::dock);
    const std::set<Mode> changed = panel.drawer ? kAllModes : std::set<Mode>{mode_};
    for (const Mode mode : changed) {
        if (shown) {
            panel.in.insert(mode);
        } else {
            panel.in.erase(mode);
        }
    }
}

QWidget* Modes::make_buttons(QMenu& menu) {
    auto* group = new QActionGroup(this);
    auto* bar = new QWidget;
    auto* row = new QHBoxLayout(bar);
    row->setContentsMargins(0, 0, space::kTight, 0);
    row->setSpacing(space::kTight);
    const auto add = [&](Mode mode, const QString& name, std::string_view shape, const char* key,
                         const QString& what) {
        QAction* action = menu.addAction(icon(shape), name);
        action->setShortcut(QKeySequence(key));
        action->setToolTip(QString("%1 (%2)").arg(what, key));
        action->setCheckable(true);
        action->setChecked(mode == mode_);
        group->addAction(action);
        actions_[mode] = action;
        connect(action, &QAction::triggered, this, [this, mode] { set(mode); });
        auto* button = new QToolButton;
        button->setDefaultAction(action);
        button->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
        button->setFocusPolicy(Qt::TabFocus);
        row->addWidget(button);
    };
    add(Mode::prepare, tr("Prepare"), shapes::kPrepare, "Ctrl+1",
        tr("The file, the choices for a session, and what to check before it"));
    add(Mode::run, tr("Run"), shapes::kPlay, "Ctrl+2",
        tr("The trials of a person, with plots of what they measure"));
    add(Mode::look, tr("Look"), shapes::kLook, "Ctrl+3", tr("What has been recorded"));
    return bar;
}

void Modes::set(Mode mode) {
    mode_ = mode;
    actions_.at(mode)->setChecked(true);
    arrange();
    Q_EMIT changed(mode);
}

void Modes::set_file(bool there) {
    file_ = there;
    actions_.at(Mode::run)->setEnabled(there);
    arrange();
}

void Modes::arrange() {
    arranging_ = true;
    for (const Panel& panel : panels_)
        panel.dock->setVisible(file_ && panel.in.contains(mode_) &&
                               (mode_ != Mode::look || !panel.drawer));
    // a drawer that the user has opened does not vanish behind the panels that share its place
    for (const Panel& panel : panels_) {
        if (panel.drawer && panel.dock->isVisible()) panel.dock->raise();
    }
    arranging_ = false;
}

void Modes::restore() {
    const QSettings settings;
    for (Panel& panel : panels_) {
        for (const Mode mode : kAllModes) {
            const QString key =
                QString("panels/%1/%2").arg(name_of(mode), panel.dock->objectName());
            if (!settings.contains(key)) continue;
            if (settings.value(key).toBool()) {
                panel.in.insert(mode);
            } else {
                panel.in.erase(mode);
            }
        }
    }
    arrange();
}

void Modes::store() const {
    QSettings settings;
    for (const Panel& panel : panels_) {
        for (const Mode mode : kAllModes)
            settings.setValue(QString("panels/%1/%2").arg(name_of(mode), panel.dock->objectName()),
                              panel.in.contains(mode));
    }
}

}  // namespace dihaptic::gui
