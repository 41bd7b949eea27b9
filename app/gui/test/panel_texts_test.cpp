// Measures whether each text of the window's panels has room in its widget, in a column of the
// smallest window that is supported, also when all texts are 40 % longer, as they are in German.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QApplication>
#include <QComboBox>
#include <QHeaderView>
#include <QLineEdit>
#include <QMenu>
#include <QProgressBar>
#include <QScrollBar>
#include <QTableWidget>
#include <QTemporaryDir>
#include <QTranslator>

#include "answer_until.h"
#include "checklist.h"
#include "device_panel.h"
#include "modes.h"
#include "participant_dialog.h"
#include "session_panel.h"
#include "theme.h"
#include "tuning_panel.h"

namespace dihaptic::gui {
namespace {

constexpr QSize kSmallest(1024, 700);  // a display of 1024 x 768 with a panel of the desktop
constexpr int kColumn = 420;           // width of the column of panels in it

/// Translates each text into itself and as many more letters as `more` says.
class Longer : public QTranslator {
  public:
    explicit Longer(double more) : more_(more) {}
    QString translate(const char* /*context*/, const char* text, const char* /*about*/,
                      int /*number*/) const override {
        const QString source(text);
        // single words are what German lengthens most
        return source + QString(qRound(more_ * static_cast<double>(source.size())), 'n');
    }
    bool isEmpty() const override { return false; }

  private:
    double more_;
};

/// The room that a widget lacks for its text [pixels]; at most 0 if the text fits.
int missing(const QWidget& widget) {
    const auto lacks = [&](const QString& text, int beside) {
        return widget.fontMetrics().horizontalAdvance(QString(text).remove('&')) + beside -
               widget.width();
    };
    if (const auto* label = qobject_cast<const QLabel*>(&widget)) {
        if (label->wordWrap()) return label->heightForWidth(label->width()) - label->height();
        return label->textFormat() == Qt::RichText ? 0 : lacks(label->text(), 0);
    }
    if (const auto* button = qobject_cast<const QAbstractButton*>(&widget))
        return button->text().isEmpty() ? 0 : button->sizeHint().width() - button->width();
    if (const auto* box = qobject_cast<const QComboBox*>(&widget))
        return lacks(box->currentText(), 24);  // the arrow
    if (const auto* bar = qobject_cast<const QProgressBar*>(&widget)) return lacks(bar->text(), 4);
    if (const auto* line = qobject_cast<const QLineEdit*>(&widget))
        return lacks(line->placeholderText(), 8);
    return 0;
}

class PanelTexts : public ::testing::TestWithParam<double> {
  protected:
    PanelTexts() {
        QApplication::installTranslator(&longer_);
        set_dark(false);
    }
    ~PanelTexts() override { QApplication::removeTranslator(&longer_); }
    /// Shows the panel in a column of the window, and measures its texts.
    void check(QWidget& panel, const char* what) {
        panel.show();
        panel.resize(kColumn, std::max(panel.minimumSizeHint().height(), kSmallest.height()));
        QApplication::processEvents();
        EXPECT_LE(panel.width(), kColumn) << what;
        int texts = 0;
        for (const QWidget* widget : panel.findChildren<QWidget*>()) {
            if (!widget->isVisible()) continue;
            ++texts;
            const auto* label = qobject_cast<const QLabel*>(widget);
            const auto* button = qobject_cast<const QAbstractButton*>(widget);
            EXPECT_LE(missing(*widget), 0)
                << what << ": " << widget->metaObject()->className() << " "
                << (label != nullptr    ? label->text()
                    : button != nullptr ? button->text()
                                        : widget->accessibleName())
                       .toStdString();
        }
        EXPECT_GE(texts, 3) << what;
    }

    int count_ = 1;
    char name_[5] = "test";
    char* names_[2] = {name_, nullptr};
    const bool offscreen_ = qputenv("QT_QPA_PLATFORM", "offscreen");
    QApplication application_{count_, names_};
    QTemporaryDir folder_;
    Longer longer_{GetParam()};
};

TEST_P(PanelTexts, OfASessionHaveRoomInEachState) {
    std::atomic<bool> stop{false};
    SessionControl control(folder_.filePath("sessions"), 0, stop);
    SessionPanel panel(control);
    bool ended = false;
    QObject::connect(&control, &SessionControl::ended, &control, [&] { ended = true; });
    const auto comes = [&](const auto& condition) {
        return answer_until(condition, [&] { control.refresh(); });
    };
    check(panel, "no file");
    control.open("experiments/visuomotor-rotation.yaml");
    session::Request request;
    request.file = "experiments/visuomotor-rotation.yaml";
    request.participant = "S07";
    request.mouse = true;
    control.read(request, std::nullopt);
    ASSERT_TRUE(comes([&] { return control.state() == SessionControl::State::checked; }));
    check(panel, "ready");
    control.begin(request, {{"S07", "", "", ""}, false, 1}, "");
    check(panel, "starting");
    ASSERT_TRUE(comes([&] { return control.state() == SessionControl::State::running; }));
    ASSERT_TRUE(comes([&] { return control.runner().frame().trial > 0; }));
    check(panel, "running");
    control.pause(true);
    check(panel, "paused");
    control.pause(false);
    control.take_force_away();
    check(panel, "stopped");
    control.stop();
    ASSERT_TRUE(comes([&] { return ended; }));
    check(panel, "recorded");
}

TEST_P(PanelTexts, OfOtherPanelsHaveRoom) {
    ChecksView checks;
    checks.set({{"calibration", "the rig has none: positions are as reported by the devices", true,
                 session::Remedy::calibrate, "Calibrate the rig."},
                {"real time", "the system does not grant the servo's requests", false,
                 session::Remedy::allow_real_time, "Until then keep hands out of real devices."},
                {"disk", "57.6 GB free in the folder for sessions", false,
                 session::Remedy::choose_folder, "Free some space."}});
    check(checks, "checks");
    TuningPanel tuning;
    tuning.set_knobs(frame::Knobs{});
    check(tuning, "tuning");
    Modes modes(&checks);
    QMenu menu;
    const std::unique_ptr<QWidget> buttons(modes.make_buttons(menu));
    check(*buttons, "modes");
}

TEST_P(PanelTexts, OfTheDevicesHaveRoom) {
    DevicePanel panel;
    panel.set_devices({{"thumb", "simulated device", 60}, {"index", "Premium 1.5", 8.5}});
    check(panel, "devices");
    panel.rest("force off");
    const auto& table = *panel.findChild<QTableWidget*>();
    for (int column = 0; column < table.columnCount(); ++column) {
        EXPECT_LE(table.horizontalHeader()->sectionSizeHint(column), table.columnWidth(column))
            << column;
        for (int row = 0; row < table.rowCount(); ++row) {
            const QModelIndex cell = table.model()->index(row, column);
            EXPECT_LE(table.sizeHintForIndex(cell).width(), table.columnWidth(column))
                << cell.data().toString().toStdString();
        }
    }
    if (GetParam() > 0) return;  // in German, one may have to scroll to the device's name
    EXPECT_FALSE(table.horizontalScrollBar()->isVisible());
}

TEST_P(PanelTexts, OfTheParticipantsDialogHaveRoom) {
    const std::string folder = folder_.path().toStdString();
    ParticipantDialog dialog(KnownPeople(folder, "Reaches", folder + "/experiment.yaml"), true,
                             nullptr);
    dialog.show();
    EXPECT_LE(dialog.minimumSizeHint().width(), kSmallest.width());
    EXPECT_LE(dialog.minimumSizeHint().height(), kSmallest.height());
    for (const char* id : {"", "S07", "anna", "S 07"}) {
        dialog.findChild<QLineEdit*>()->setText(id);
        QApplication::processEvents();
        for (const QWidget* widget : dialog.findChildren<QWidget*>()) {
            if (!widget->isVisible()) continue;
            EXPECT_LE(missing(*widget), 0) << id << ": " << widget->metaObject()->className();
        }
    }
}

INSTANTIATE_TEST_SUITE_P(InLengths, PanelTexts, ::testing::Values(0.0, 0.4));

}  // namespace
}  // namespace dihaptic::gui
