// Menu entries for the layers of a scene's widget, in every window with a scene.
#pragma once

#include "scene_widget.h"

class QAction;
class QMenu;

namespace dihaptic::gui {

/// An entry that draws a layer while it is checked.
void add_layer(QMenu& menu, SceneWidget& scene, const QString& name,
               bool SceneWidget::Layers::*which);
/// The entries for layers that any frame has.
void add_layers(QMenu& menu, SceneWidget& scene);
/// The entry that draws all pixels while it is checked; it is unchecked if a processor draws.
QAction* add_fine_pictures(QMenu& menu, SceneWidget& scene);

}  // namespace dihaptic::gui
