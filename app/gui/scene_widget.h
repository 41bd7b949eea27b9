// The widget that shows the current state of the scene. The mouse moves the camera or the simulated
// hand.
#pragma once

#include <QOpenGLWidget>
#include <deque>
#include <memory>
#include <optional>

#include "body_drag.h"
#include "drawn_detail.h"
#include "hand_input.h"
#include "scene_words.h"
#include "seen_display.h"
#include "servo/workspace_turn.h"
#include "view/scene_view.h"

namespace dihaptic::gui {

class SceneWidget : public QOpenGLWidget {
    Q_OBJECT

  public:
    explicit SceneWidget(QWidget* parent = nullptr);
    ~SceneWidget() override;

    /// Sets the scene to which all later frames belong, its first frame, the devices' workspaces,
    /// and the turn of the workspaces. The camera keeps its pose if the new scene has the same
    /// cameras as the previous one.
    void set_scene(const scene::Scene& scene, const frame::Frame& frame,
                   std::vector<view::Workspace> workspaces = {},
                   const servo::WorkspaceTurn& turn = {});
    /// Sets the newest frame, which will be drawn in the screen's next picture.
    void show_frame(const frame::Frame& frame);
    /// Sets the hand that the mouse moves; if null, the mouse moves the camera. `squeezes`: whether
    /// the wheel squeezes the hand.
    void set_hand(MouseHand* hand, bool squeezes);
    /// Sets the body that is marked by a box and can be moved by mouse and keys; nullopt if there
    /// is none.
    void set_picked(std::optional<size_t> body);
    /// Shows the picked body displaced by `way`, until the next frame or scene.
    void move_picked(const BodyWay& way);
    /// The squeeze that the keys currently held down command.
    MouseHand::Squeeze keys() const { return hand_.keys(); }

    const std::vector<view::Camera>& cameras() const { return cameras_; }
    void set_camera(const std::string& name);
    void set_camera(const view::Camera& camera);
    const view::Camera& camera() const { return camera_; }
    void reset_camera();
    /// Draws the scene as the person sees it on a display, instead of from the camera; nullopt for
    /// the camera's view.
    void set_display(const std::optional<display::Display>& display);
    /// Sets the pose of the head from whose eyes the scene is drawn, if the display's eyes are
    /// tracked.
    void set_head(const outlets::HeadPose& head);
    /// The pose of the head for which the last picture was drawn; nullopt if the eyes were at rest.
    const std::optional<outlets::HeadPose>& shown_to() const { return display_.shown_to(); }
    /// Selects what is drawn in addition to the scene. `path`: the object's path during the last
    /// seconds.
    struct Layers {
        bool handles = false;
        bool forces = false;
        bool contacts = false;
        bool grip_axis = false;
        bool path = false;
        bool joints = false;
        bool workspaces = false;
        bool drop_lines = false;
        bool hand = false;
    };
    void set_layers(const Layers& layers);
    void set_patch(const std::optional<view::PatchLook>& patch);
    /// Sets whether pictures are drawn at full resolution, or at two thirds of it in each direction
    /// while something moves. The default is full resolution if there is a graphics card.
    void set_fine(bool fine);
    const Layers& layers() const { return layers_; }
    /// The frame that the last picture showed.
    const view::Shown& shown() const { return shown_; }
    /// Sets the large text over the picture; an empty text removes it.
    void set_banner(const QString& text) { words_.set_banner("", text); }
    /// Shows the sign of a session in place of that text.
    void set_sign(const QString& word, const QString& text, Sign sign) {
        words_.set_banner(word, text, sign);
    }
    /// Sets the hint how the mouse moves the hand; an empty text removes it. While the hand is held
    /// in place (H), that is shown instead.
    void set_help(const QString& text) { words_.set_help(text); }
    /// Sets the page shown instead of the scene (page_view.h); if both arguments are empty, the
    /// scene is shown.
    void set_page(const QString& text, const QString& picture) { words_.set_page(text, picture); }
    /// Shows the questions that a task currently asks; nullopt if there are none.
    void ask(const std::optional<Asked>& asked) { words_.ask(asked); }
    const QuestionsView& questions() const { return words_.questions(); }

    QSize sizeHint() const override { return {900, 640}; }

  Q_SIGNALS:
    /// The picture of a tick was passed to the screen. Emitted once for each tick.
    void presented(qint64 tick);
    /// The hand has a new target position.
    void hand_moved();
    void camera_moved();
    /// A body of the scene was clicked.
    void picked(size_t body);
    /// The picked body is being dragged, and is shown in this pose at the moment.
    void dragging(size_t body, const dihaptic::Pose& X_WB);
    /// The picked body was dragged and is shown at its new position.
    void dragged(size_t body, const dihaptic::gui::BodyWay& way);
    /// A key that moves the picked body by a step was pressed [m].
    void stepped(const dihaptic::Vec3& step);
    /// OpenGL draws in software, and therefore in less detail. `what`: a message for the user.
    /// Emitted once.
    void draws_in_software(const QString& what);
    /// OpenGL cannot draw. `why`: the reason and the remedy.
    void failed(const QString& why);

  protected:
    void paintGL() override;
    void resizeEvent(QResizeEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void keyReleaseEvent(QKeyEvent* event) override;
    void enterEvent(QEnterEvent* event) override;
    void focusOutEvent(QFocusEvent* event) override;

  private:
    void release();
    /// Moves the camera by a key, as the mouse would. Returns false if the key does not move the
    /// camera.
    bool look_by_key(const QKeyEvent& event);
    void set_staying(bool stays);
    void move_hand(const QPointF& pixels, bool in_depth);
    view::Ray ray_to(const QPointF& pointer) const;
    void drag(const QPointF& way, Qt::KeyboardModifiers keys);
    /// Moves the camera by a mouse movement of `way` pixels.
    void look(const QPointF& way, bool pan);
    void zoom(double notches);
    void make_view();
    void draw_scene();

    scene::Scene scene_;
    frame::Frame frame_;
    std::unique_ptr<view::SceneView> view_;
    std::vector<view::Camera> cameras_;
    view::Camera camera_;
    SeenDisplay display_;
    SceneWords words_{*this};
    std::optional<size_t> picked_;
    std::optional<BodyDrag> drag_;  // drag of the picked body while the mouse button is down
    Layers layers_;
    std::optional<view::PatchLook> patch_;
    DrawnDetail detail_{[this] { update(); }};
    std::vector<view::Workspace> workspaces_;
    servo::WorkspaceTurn turn_;
    std::deque<Vec3> path_;
    view::Shown shown_;
    int64_t presented_ = -1;  // last tick for which presented() was emitted
    HandInput hand_;
    QPointF pointer_;
    QPointF pressed_;  // position where a mouse button was pressed
};

}  // namespace dihaptic::gui
