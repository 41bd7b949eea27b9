// Menu entries for the layers of a scene widget, used by all windows that show a scene.
#pragma once

#include "scene_widget.h"

class QAction;
class QMenu;

namespace dihaptic::gui {

/// Adds a menu entry; the layer is drawn while the entry is checked.
void add_layer(QMenu& menu, SceneWidget& scene, const QString& name,
               bool SceneWidget::Layers::*which);
/// Adds the entries for the layers that any frame has.
void add_layers(QMenu& menu, SceneWidget& scene);
/// Adds the entry for drawing at full resolution. It is initially unchecked if pictures are drawn
/// in software.
QAction* add_fine_pictures(QMenu& menu, SceneWidget& scene);

}  // namespace dihaptic::gui
