#include "guide_dialog.h"

#include <QDialogButtonBox>
#include <QVBoxLayout>

#include "base/diagnostics.h"

namespace dihaptic::gui {

GuideDialog::GuideDialog(const QString& title, const QString& leave,
                         std::function<void(const rig::Guide&)> work, QWidget* parent)
    : GuideDialog(title, leave, parent) {
    work_ = std::move(work);
    thread_ = std::thread([this] { this->work(); });
}

GuideDialog::GuideDialog(const QString& title, const QString& leave, QWidget* parent)
    : QDialog(parent),
      step_(new QLabel),
      text_(new QLabel("...")),
      measured_(new QLabel),
      progress_(new QProgressBar) {
    setWindowTitle(title);
    setAttribute(Qt::WA_DeleteOnClose);
    setMinimumWidth(560);
    QFont large = text_->font();
    large.setPointSizeF(large.pointSizeF() *
                        1.5);  // the text must be legible while both hands are busy
    text_->setFont(large);
    text_->setWordWrap(true);
    text_->setMinimumHeight(120);
    text_->setAlignment(Qt::AlignTop);
    measured_->setWordWrap(true);
    progress_->setRange(0, 1000);
    auto* buttons = new QDialogButtonBox;
    done_ = buttons->addButton(tr("&Done"), QDialogButtonBox::ActionRole);
    done_->setDefault(true);
    done_->setToolTip(tr("Enter"));
    leave_ = buttons->addButton(leave, QDialogButtonBox::RejectRole);
    leave_->setAutoDefault(false);
    auto* layout = new QVBoxLayout(this);
    for (QWidget* widget : std::initializer_list<QWidget*>{step_, text_, measured_, progress_})
        layout->addWidget(widget);
    layout->addWidget(buttons);
    connect(done_, &QPushButton::clicked, this, [this] { said_ = true; });
    connect(leave_, &QPushButton::clicked, this, &GuideDialog::reject);
    done_->setEnabled(false);
}

GuideDialog::~GuideDialog() {
    given_up_ = true;
    if (thread_.joinable()) thread_.join();
}

rig::Guide GuideDialog::guide() {
    rig::Guide guide;
    guide.show = [this](const rig::Guidance& now) {
        QMetaObject::invokeMethod(
            this, [this, now] { show_guidance(now); }, Qt::QueuedConnection);
    };
    guide.done = [this] {
        if (given_up_) throw rig::GivenUp{};
        return said_.exchange(false);
    };
    return guide;
}

void GuideDialog::finish(Outcome outcome, const QString& why) {
    QMetaObject::invokeMethod(
        this, [this, outcome, why] { end(outcome, why); }, Qt::QueuedConnection);
}

void GuideDialog::work() {
    try {
        work_(guide());
        finish(Outcome::done);
    } catch (const rig::GivenUp&) {
        finish(Outcome::given_up);
    } catch (const std::exception& e) {
        finish(Outcome::failed, QString::fromStdString(e.what()));
    }
}

void GuideDialog::show_guidance(const rig::Guidance& now) {
    if (ended_) return;
    step_->setText(now.step > 0 ? tr("Step %1 of %2").arg(now.step).arg(now.steps) : "");
    text_->setText(QString::fromStdString(now.text));
    measured_->setText(QString::fromStdString(now.measured));
    progress_->setVisible(now.step == 0 || !now.measured.empty());
    progress_->setValue(static_cast<int>(1000 * now.share));
    done_->setEnabled(now.step > 0);
}

/// Cancels the work, whose end then closes the dialog. If the work has already ended, closes the
/// dialog at once.
void GuideDialog::reject() {
    given_up_ = true;
    if (ended_) QDialog::reject();
}

void GuideDialog::end(Outcome outcome, const QString& why) {
    if (ended_) return;
    ended_ = true;
    if (outcome == Outcome::done) return accept();
    if (outcome == Outcome::given_up) return QDialog::reject();
    Q_EMIT failed(why);
    step_->setText(tr("It has ended:"));
    text_->setText(why);
    measured_->clear();
    done_->hide();
    leave_->setText(tr("Close"));
}

}  // namespace dihaptic::gui
