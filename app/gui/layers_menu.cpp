#include "layers_menu.h"

#include <QAction>
#include <QMenu>

namespace dihaptic::gui {

void add_layer(QMenu& menu, SceneWidget& scene, const QString& name,
               bool SceneWidget::Layers::*which) {
    QAction* const action = menu.addAction(name);
    action->setCheckable(true);
    QObject::connect(action, &QAction::toggled, &scene, [&scene, which](bool on) {
        SceneWidget::Layers layers = scene.layers();
        layers.*which = on;
        scene.set_layers(layers);
    });
}

void add_layers(QMenu& menu, SceneWidget& scene) {
    add_layer(menu, scene, QObject::tr("&Handles"), &SceneWidget::Layers::handles);
    add_layer(menu, scene, QObject::tr("&Forces"), &SceneWidget::Layers::forces);
    add_layer(menu, scene, QObject::tr("C&ontacts"), &SceneWidget::Layers::contacts);
    add_layer(menu, scene, QObject::tr("&Grip axis"), &SceneWidget::Layers::grip_axis);
    add_layer(menu, scene, QObject::tr("P&ath of the object"), &SceneWidget::Layers::path);
    add_layer(menu, scene, QObject::tr("&Joints"), &SceneWidget::Layers::joints);
    add_layer(menu, scene, QObject::tr("Th&e hand"), &SceneWidget::Layers::hand);
}

QAction* add_fine_pictures(QMenu& menu, SceneWidget& scene) {
    QAction* const action = menu.addAction(QObject::tr("F&ine pictures"));
    action->setCheckable(true);
    action->setChecked(true);
    QObject::connect(action, &QAction::triggered, &scene, &SceneWidget::set_fine);
    QObject::connect(&scene, &SceneWidget::draws_in_software, action,
                     [action] { action->setChecked(false); });
    return action;
}

}  // namespace dihaptic::gui
