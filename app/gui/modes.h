// The window's three modes, each with the panels that its work needs: Prepare (files, choices,
// checks), Run (the trials of a person), Look (what has been recorded). A panel belongs to some of
// the modes, or is a drawer, which stays open or closed in all of them until the user changes that.
// Without a file, panels have nothing to show, and are not there.
#pragma once

#include <QActionGroup>
#include <QDockWidget>
#include <QMenu>
#include <map>
#include <set>
#include <vector>

namespace dihaptic::gui {

enum class Mode { prepare, run, look };

class Modes : public QObject {
    Q_OBJECT

  public:
    explicit Modes(QWidget* window);

    /// Adds a panel that is shown in these modes, until the user opens or closes it there.
    void add(QDockWidget* dock, std::set<Mode> in);
    /// Adds a panel that is closed until the user opens it.
    void add_drawer(QDockWidget* dock);
    /// Adds the modes to a menu, with their keys, and returns the buttons by which one switches.
    QWidget* make_buttons(QMenu& menu);
    Mode mode() const { return mode_; }
    void set(Mode mode);
    /// Sets whether there is a file, and therefore something to show and to run.
    void set_file(bool there);
    /// Reads and stores which panels the user has opened and closed.
    void restore();
    void store() const;

  Q_SIGNALS:
    /// The mode was chosen, possibly again.
    void changed(Mode mode);

  private:
    struct Panel {
        QDockWidget* dock;
        std::set<Mode> in;  ///< modes in which it is shown; for a drawer, all or none
        bool drawer;
    };
    void add_panel(QDockWidget* dock, std::set<Mode> in, bool drawer);
    void note(QDockWidget* dock, bool shown);
    void arrange();

    Mode mode_ = Mode::prepare;
    bool file_ = false;
    bool arranging_ = false;  ///< whether panels are shown and hidden by the program
    std::vector<Panel> panels_;
    std::map<Mode, QAction*> actions_;
};

}  // namespace dihaptic::gui
