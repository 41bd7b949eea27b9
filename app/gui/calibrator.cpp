#include "calibrator.h"

#include <QDialogButtonBox>
#include <QFontDatabase>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QSvgWidget>
#include <QVBoxLayout>

#include "participant_window.h"
#include "recording/session.h"
#include "rig/registration_run.h"

namespace dihaptic::gui {

void Calibrator::calibrate(const QString& rig_file, rig::NamedBy named_by) {
    Diagnostics diagnostics;
    const rig::Rig rig = rig::read_rig_to_calibrate(rig_file.toStdString(), diagnostics, named_by);
    for (const Problem& problem : diagnostics.problems())
        Q_EMIT logged(QString::fromStdString(problem.text()), true);
    if (diagnostics.has_errors()) return;
    const std::string file = rig::calibration_file(rig, rig_file.toStdString());
    try {
        rig::check_calibration_file(rig_file.toStdString(), file);
    } catch (const Error& e) {
        Q_EMIT logged(e.what(), true);
        return;
    }
    auto found = std::make_shared<rig::CalibrationResult>();
    auto* guide = new GuideDialog(
        tr("Calibration: %1").arg(QString::fromStdString(rig.title)), tr("&Give up"),
        [rig, found](const rig::Guide& person) {
            *found = rig::calibrate(rig::lead_calibration(rig, person));
            found->calibration.date = recording::iso_now().substr(0, 10);
        },
        window_);
    connect(guide, &GuideDialog::failed, this,
            [this](const QString& why) { Q_EMIT logged(why, true); });
    connect(guide, &QDialog::accepted, this,
            [this, rig, found, name = rig_file.toStdString(), file] {
                ask_to_store(rig, *found, name, file);
            });
    guide->open();
}

void Calibrator::ask_to_store(const rig::Rig& rig, const rig::CalibrationResult& result,
                              const std::string& rig_file, const std::string& file) {
    auto* dialog = new QDialog(window_);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setWindowTitle(tr("Result of the calibration"));
    auto* words = new QLabel(QString::fromStdString(rig::describe(result)));
    words->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
    words->setTextInteractionFlags(Qt::TextSelectableByMouse);
    auto* picture = new QSvgWidget;
    picture->load(QByteArray::fromStdString(rig::residual_picture(result, rig.title)));
    picture->setMinimumSize(picture->sizeHint());
    auto* buttons = new QDialogButtonBox;
    const bool named = !rig.calibration.empty();
    buttons->addButton(named ? tr("&Store") : tr("&Store and use"), QDialogButtonBox::AcceptRole)
        ->setDefault(true);
    buttons->addButton(tr("&Discard"), QDialogButtonBox::RejectRole)->setAutoDefault(false);
    auto* layout = new QVBoxLayout(dialog);
    layout->addWidget(words);
    layout->addWidget(picture, 1);
    const QString where =
        named ? tr("It is stored in %1.")
              : tr("It is stored in %1, and the rig file gets a line that refers to it.");
    layout->addWidget(new QLabel(where.arg(QString::fromStdString(file))));
    layout->addWidget(buttons);
    connect(buttons, &QDialogButtonBox::accepted, dialog, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::reject);
    connect(dialog, &QDialog::accepted, this, [this, rig, result, rig_file, file] {
        try {
            rig::store_calibration(rig, result, file);
            if (rig.calibration.empty()) rig::name_calibration(rig_file, file);
        } catch (const Error& e) {
            Q_EMIT logged(e.what(), true);
            return;
        }
        Q_EMIT logged(tr("calibration stored: %1").arg(QString::fromStdString(file)), false);
        Q_EMIT stored();
    });
    dialog->open();
}

void Calibrator::register_display(const QString& rig_file, rig::NamedBy named_by) {
    Diagnostics diagnostics;
    const rig::Rig rig = rig::read_rig_to_register(rig_file.toStdString(), diagnostics, named_by);
    for (const Problem& problem : diagnostics.problems())
        Q_EMIT logged(QString::fromStdString(problem.text()), true);
    if (diagnostics.has_errors() || rig.displays.empty()) return;
    const display::Display& display = rig.displays.front();
    auto* crosses = new QSvgWidget;
    crosses->setAttribute(Qt::WA_DeleteOnClose);
    crosses->setWindowTitle(tr("Dihaptic: crosses"));
    crosses->load(QByteArray::fromStdString(display::cross_picture(display)));
    const QString wrong = show_on(*crosses, QString::fromStdString(display.monitor), *window_);
    if (!wrong.isEmpty()) Q_EMIT logged(wrong, true);
    auto found = std::make_shared<display::RegistrationResult>();
    auto* guide = new GuideDialog(
        tr("Registration: %1").arg(QString::fromStdString(display.name)), tr("&Give up"),
        [rig, display, found](const rig::Guide& person) {
            const std::string finger = rig::held_fingers(rig).front();
            *found = display::register_screen(display,
                                              rig::lead_registration(rig, finger, display, person));
            found->registration.date = recording::iso_now().substr(0, 10);
        },
        window_);
    connect(guide, &QDialog::finished, crosses, &QWidget::close);
    connect(guide, &GuideDialog::failed, this,
            [this](const QString& why) { Q_EMIT logged(why, true); });
    connect(guide, &QDialog::accepted, this,
            [this, rig, display, found, name = rig_file.toStdString()] {
                store(rig, display, *found, name);
            });
    guide->open();
}

void Calibrator::store(const rig::Rig& rig, const display::Display& display,
                       const display::RegistrationResult& result, const std::string& rig_file) {
    auto* question = new QMessageBox(QMessageBox::Question, tr("Result of the registration"),
                                     QString::fromStdString(display::describe(result)),
                                     QMessageBox::Save | QMessageBox::Discard, window_);
    question->setAttribute(Qt::WA_DeleteOnClose);
    question->setDefaultButton(QMessageBox::Save);
    question->setEscapeButton(QMessageBox::Discard);
    connect(question, &QDialog::finished, this, [this, rig, display, result, rig_file](int button) {
        if (button != QMessageBox::Save) return;
        const std::string file = rig::registration_file(display, rig_file);
        try {
            rig::store_registration(rig, result.registration, file);
        } catch (const Error& e) {
            Q_EMIT logged(e.what(), true);
            return;
        }
        QString told = tr("registration stored: %1").arg(QString::fromStdString(file));
        if (display.registration.empty())
            told += tr(". In the rig file, under %1, write: %2")
                        .arg(QString::fromStdString(display.name),
                             QString::fromStdString(rig::registration_line(rig_file, file)));
        Q_EMIT logged(told, false);
        Q_EMIT stored();
    });
    question->open();
}

std::function<std::vector<Problem>(devices::DeviceGroup&)> Calibrator::together_check(
    const rig::Rig& rig, const std::vector<std::string>& fingers,
    const std::function<bool()>& ends) {
    auto* dialog = new GuideDialog(tr("Is the calibration still valid?"), tr("&Skip"), window_);
    dialog->open();
    check_ = dialog;
    return [this, dialog, rig, fingers, ends](devices::DeviceGroup& devices) {
        const auto tell = [this](const QString& text, bool problem) {
            QMetaObject::invokeMethod(
                this, [this, text, problem] { Q_EMIT logged(text, problem); },
                Qt::QueuedConnection);
        };
        struct Ended {};
        rig::Guide guide = dialog->guide();
        guide.done = [ends, done = guide.done] {
            if (ends()) throw Ended{};
            return done();
        };
        std::vector<Problem> warnings;
        try {
            for (const rig::Together& pair : rig::check_together(rig, fingers, devices, guide)) {
                tell(QString::fromStdString(pair.describe()), !pair.agrees);
                if (!pair.agrees) warnings.push_back(pair.warning(rig));
            }
            dialog->finish(GuideDialog::Outcome::done);
        } catch (const rig::GivenUp&) {
            tell(tr("the calibration was not checked"), false);
            dialog->finish(GuideDialog::Outcome::given_up);
        } catch (const Ended&) {
            dialog->finish(GuideDialog::Outcome::given_up);
            throw Error(
                tr("The session was ended before it started: nothing was recorded").toStdString(),
                "");
        } catch (const std::exception& e) {
            dialog->finish(GuideDialog::Outcome::failed, QString::fromStdString(e.what()));
            throw;
        }
        return warnings;
    };
}

void Calibrator::end_check() {
    if (check_ != nullptr) check_->finish(GuideDialog::Outcome::given_up);
}

}  // namespace dihaptic::gui
