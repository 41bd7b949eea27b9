// The scene as it is now, seen through a camera that the mouse moves; or the mouse moves the hand.
#pragma once

#include <QLabel>
#include <QOpenGLWidget>
#include <deque>
#include <memory>

#include "mouse_hand.h"
#include "servo/workspace_turn.h"
#include "view/scene_view.h"

namespace dihaptic::gui {

class SceneWidget : public QOpenGLWidget {
    Q_OBJECT

  public:
    explicit SceneWidget(QWidget* parent = nullptr);
    ~SceneWidget() override;

    /// What frames are of from now on, the first of them, where the devices can go, and how all of
    /// it turns. The camera stays where it is when the scene has the same ones as that before.
    void set_scene(const scene::Scene& scene, const servo::Frame& frame,
                   std::vector<view::Workspace> workspaces = {},
                   const servo::WorkspaceTurn& turn = {});
    /// The newest frame; drawn with the screen's next picture.
    void show_frame(const servo::Frame& frame);
    /// While it is set, the mouse moves this hand; null: the camera.
    void set_hand(MouseHand* hand, bool squeezes);
    /// Keys that squeeze, as they are held now.
    MouseHand::Squeeze keys() const { return keys_; }

    const std::vector<view::Camera>& cameras() const { return cameras_; }
    void set_camera(const std::string& name);
    void set_camera(const view::Camera& camera);
    const view::Camera& camera() const { return camera_; }
    void reset_camera();
    /// What is drawn besides the scene; `paths`: of the object, in the last seconds.
    struct Layers {
        bool handles = false;
        bool forces = false;
        bool contacts = false;
        bool grip_axis = false;
        bool path = false;
        bool workspaces = false;
    };
    void set_layers(const Layers& layers);
    const Layers& layers() const { return layers_; }
    /// Of the last picture.
    const view::Shown& shown() const { return shown_; }
    /// Large, over the picture; empty: nothing.
    void set_banner(const QString& text);
    void set_help(const QString& text);

    QSize sizeHint() const override { return {900, 640}; }

  Q_SIGNALS:
    /// The picture of a tick that was not shown before was handed to the screen.
    void presented(qint64 tick);
    /// The hand has a new goal.
    void hand_moved();
    void camera_moved();
    /// OpenGL cannot draw: why, and what to do.
    void failed(const QString& why);

  protected:
    void paintGL() override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void keyReleaseEvent(QKeyEvent* event) override;
    void enterEvent(QEnterEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

  private:
    void release();
    void set_key(const QKeyEvent& event, bool down);
    void set_staying(bool stays);
    void move_hand(const QPointF& pixels, bool in_depth);
    void place_labels();

    scene::Scene scene_;
    servo::Frame frame_;
    std::unique_ptr<view::SceneView> view_;
    std::vector<view::Camera> cameras_;
    view::Camera camera_;
    Layers layers_;
    std::vector<view::Workspace> workspaces_;
    servo::WorkspaceTurn turn_;
    std::deque<Vec3> path_;
    view::Shown shown_;
    int64_t presented_ = -1;  // tick
    MouseHand* hand_ = nullptr;
    bool squeezes_ = false;  // otherwise the wheel moves it in depth
    bool stays_ = false;     // while the pointer goes elsewhere
    MouseHand::Squeeze keys_ = MouseHand::Squeeze::none;
    QPointF pointer_;
    QLabel* banner_;
    QLabel* help_;
};

}  // namespace dihaptic::gui
