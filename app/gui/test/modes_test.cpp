// Tests which panels each mode of the window shows.
#include "modes.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QMainWindow>
#include <QMenuBar>
#include <QSettings>
#include <QTemporaryDir>

namespace dihaptic::gui {
namespace {

class ModesTest : public ::testing::Test {
  protected:
    ModesTest() {
        QSettings::setPath(QSettings::NativeFormat, QSettings::UserScope, folder_.path());
        QApplication::setOrganizationName("dihaptic-test");
    }
    /// A window with a panel for Prepare, one for Run, one for both, and a drawer.
    struct Panels {
        QMainWindow window;
        Modes modes{&window};
        QDockWidget checks, plots, session, tuning;
        QMenu menu;

        Panels() {
            const std::pair<QDockWidget*, const char*> docks[] = {
                {&checks, "checks"}, {&plots, "plots"}, {&session, "session"}, {&tuning, "tuning"}};
            for (const auto& [dock, name] : docks) {
                dock->setObjectName(name);
                window.addDockWidget(Qt::RightDockWidgetArea, dock);
            }
            modes.add(&checks, {Mode::prepare});
            modes.add(&plots, {Mode::run});
            modes.add(&session, {Mode::prepare, Mode::run});
            modes.add_drawer(&tuning);
            window.menuBar()->setCornerWidget(modes.make_buttons(menu));
            modes.restore();
            window.show();
        }
        QStringList shown() {
            QStringList out;
            for (const QDockWidget* dock : {&checks, &plots, &session, &tuning}) {
                if (dock->isVisible()) out += dock->objectName();
            }
            return out;
        }
    };

    int count_ = 1;
    char name_[5] = "test";
    char* names_[2] = {name_, nullptr};
    const bool offscreen_ = qputenv("QT_QPA_PLATFORM", "offscreen");
    QApplication application_{count_, names_};
    QTemporaryDir folder_;
};

TEST_F(ModesTest, EachShowsThePanelsOfItsWork) {
    Panels panels;
    EXPECT_EQ(panels.shown(), QStringList()) << "without a file there is nothing to show";
    panels.modes.set_file(true);
    EXPECT_EQ(panels.shown(), QStringList({"checks", "session"}));
    panels.modes.set(Mode::run);
    EXPECT_EQ(panels.shown(), QStringList({"plots", "session"}));
    panels.modes.set(Mode::look);
    EXPECT_EQ(panels.shown(), QStringList());
    panels.modes.set(Mode::prepare);
    EXPECT_EQ(panels.shown(), QStringList({"checks", "session"}));
}

TEST_F(ModesTest, KeepWhatTheUserOpensAndCloses) {
    {
        Panels panels;
        panels.modes.set_file(true);
        panels.modes.set(Mode::run);
        panels.plots.close();
        panels.tuning.toggleViewAction()->trigger();
        EXPECT_EQ(panels.shown(), QStringList({"session", "tuning"}));
        panels.modes.set(Mode::prepare);
        EXPECT_EQ(panels.shown(), QStringList({"checks", "session", "tuning"}));
        panels.modes.set(Mode::look);
        EXPECT_EQ(panels.shown(), QStringList()) << "nothing is tuned here";
        panels.modes.set(Mode::run);
        EXPECT_EQ(panels.shown(), QStringList({"session", "tuning"}));
        panels.modes.store();
    }
    Panels again;
    again.modes.set_file(true);
    EXPECT_EQ(again.shown(), QStringList({"checks", "session", "tuning"}));
    again.modes.set(Mode::run);
    EXPECT_EQ(again.shown(), QStringList({"session", "tuning"}));
}

}  // namespace
}  // namespace dihaptic::gui
