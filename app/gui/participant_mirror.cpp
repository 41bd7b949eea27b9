#include "participant_mirror.h"

#include <QPainter>

namespace dihaptic::gui {
namespace {

/// Time between two pictures of the mirror [ms]. Each requires drawing the scene once more, which
/// takes long without a graphics card.
constexpr int kBetween = 250;

}  // namespace

ParticipantMirror::ParticipantMirror() {
    setAccessibleName(tr("What the participant sees"));
    setMinimumSize(160, 100);
    wait_.setSingleShot(true);
    wait_.setInterval(kBetween);
    connect(&wait_, &QTimer::timeout, this, &ParticipantMirror::look);
}

void ParticipantMirror::follow(SceneWidget* scene, const QString& why) {
    why_ = why;
    if (scene != scene_) {
        if (scene_) scene_->disconnect(this);
        scene_ = scene;
        picture_ = {};
        // a new picture is needed only when the view has changed
        if (scene != nullptr)
            connect(scene, &QOpenGLWidget::frameSwapped, this, [this] {
                if (isVisible() && !wait_.isActive()) wait_.start();
            });
    }
    look();
    update();
}

void ParticipantMirror::look() {
    if (!scene_ || !scene_->isVisible() || !isVisible()) return;
    picture_ = scene_->grab();
    update();
}

void ParticipantMirror::showEvent(QShowEvent*) {
    wait_.start();
}

void ParticipantMirror::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    if (picture_.isNull()) {
        painter.drawText(rect().adjusted(8, 8, -8, -8), Qt::AlignCenter | Qt::TextWordWrap, why_);
        return;
    }
    QRect target({}, picture_.size().scaled(size(), Qt::KeepAspectRatio));
    target.moveCenter(rect().center());
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    painter.drawPixmap(target, picture_);
}

}  // namespace dihaptic::gui
