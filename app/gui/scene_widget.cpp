#include "scene_widget.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QScreen>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/diagnostics.h"
#include "frame/displayed.h"

namespace dihaptic::gui {
namespace {

constexpr double kOrbit = 0.006;  // [rad/pixel]
constexpr double kStill = 3;      // a pointer movement up to this length counts as a click [px]
constexpr size_t kPath = 300;     // length of the path: five seconds [pictures]

}  // namespace

SceneWidget::SceneWidget(QWidget* parent) : QOpenGLWidget(parent) {
    setAccessibleName(tr("Scene"));
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setMinimumSize(320, 240);
    connect(this, &QOpenGLWidget::frameSwapped, this, [this] {
        if (display_.take_turns(screen()->refreshRate())) update();
        if (shown_.sequence == presented_) return;
        presented_ = shown_.sequence;
        Q_EMIT presented(presented_);
    });
}

SceneWidget::~SceneWidget() {
    release();
}

void SceneWidget::release() {
    if (!view_) return;
    makeCurrent();
    view_.reset();
    doneCurrent();
}

void SceneWidget::set_scene(const scene::Scene& scene, const frame::Frame& frame,
                            std::vector<view::Workspace> workspaces,
                            const servo::WorkspaceTurn& turn) {
    release();
    workspaces_ = std::move(workspaces);
    turn_ = turn;
    path_.clear();
    // a drag must not end because an earlier change of the text is shown only now
    const auto is_same = [&](size_t body) {
        return body < scene.bodies.size() && scene.bodies[body].name == scene_.bodies[body].name;
    };
    if (picked_ && !is_same(*picked_)) set_picked({});
    scene_ = scene;
    frame_ = frame;
    const std::vector<view::Camera> before = std::exchange(cameras_, view::cameras(scene_));
    const bool same = std::equal(cameras_.begin(), cameras_.end(), before.begin(), before.end(),
                                 [](const view::Camera& a, const view::Camera& b) {
                                     return a.name == b.name && a.position == b.position &&
                                            a.look_at == b.look_at &&
                                            a.field_of_view == b.field_of_view;
                                 });
    set_camera(same ? view::Camera(camera_) : cameras_.front());
}

void SceneWidget::show_frame(const frame::Frame& frame) {
    if (frame.time < frame_.time) path_.clear();
    frame_ = frame;
    detail_.frame_came();
    turn_.set_angle(frame.workspace_turn);
    const int object = scene_.object_index();
    if (object >= 0) {
        path_.push_back(frame::displayed_body(frame, static_cast<size_t>(object)).p);
        while (path_.size() > kPath) path_.pop_front();
    }
    update();
}

void SceneWidget::set_layers(const Layers& layers) {
    layers_ = layers;
    update();
}

void SceneWidget::set_hand(MouseHand* hand, bool squeezes) {
    hand_.set(hand, squeezes);
    set_staying(false);
    if (hand_) setFocus();
}

void SceneWidget::set_picked(std::optional<size_t> body) {
    if (body == picked_) return;
    picked_ = body;
    drag_.reset();
    update();
}

void SceneWidget::move_picked(const BodyWay& way) {
    if (!picked_) return;
    Pose& X_WB = frame_.bodies[*picked_].X_WB;
    X_WB = way.of(X_WB);
    update();
}

void SceneWidget::set_staying(bool stays) {
    hand_.set_staying(stays);
    setCursor(!hand_ ? Qt::OpenHandCursor : stays ? Qt::ArrowCursor : Qt::CrossCursor);
    words_.set_held(stays);
}

void SceneWidget::move_hand(const QPointF& pixels, bool in_depth) {
    // the hand moves in the devices' frame, so the workspaces' turn is undone for the camera
    view::Camera camera = camera_;
    camera.position = turn_.unturned(camera.position);
    camera.look_at = turn_.unturned(camera.look_at);
    hand_->move(pixels, camera, height(), in_depth);
    Q_EMIT hand_moved();
}

void SceneWidget::set_camera(const std::string& name) {
    set_camera(view::find_camera(cameras_, name));
}

void SceneWidget::set_camera(const view::Camera& camera) {
    camera_ = camera;
    update();
    Q_EMIT camera_moved();
}

void SceneWidget::reset_camera() {
    if (!cameras_.empty()) set_camera(camera_.name);
}

void SceneWidget::set_display(const std::optional<display::Display>& display) {
    display_.set(display);
    words_.set_display(display);
    update();
}

void SceneWidget::set_head(const outlets::HeadPose& head) {
    if (display_.set_head(head)) update();
}

void SceneWidget::resizeEvent(QResizeEvent* event) {
    QOpenGLWidget::resizeEvent(event);
    words_.place();
}

void SceneWidget::paintGL() {
    if (cameras_.empty()) return;
    try {
        draw_scene();
    } catch (const Error& e) {
        cameras_.clear();
        Q_EMIT failed(e.what());
        return;
    }
    if (!words_.in_picture()) return;
    QPainter painter(this);
    words_.draw(painter);
}

void SceneWidget::set_patch(const std::optional<view::PatchLook>& patch) {
    patch_ = patch;
    update();
}

void SceneWidget::set_fine(bool fine) {
    detail_.set_fine(fine);
    update();
}

void SceneWidget::make_view() {
    view_ = std::make_unique<view::SceneView>(scene_);
    const std::string renderer = view::renderer();
    if (view::is_software(renderer) && detail_.draws_slowly()) {
        Q_EMIT draws_in_software(
            tr("there is no graphics card (%1): while something moves, the scene is drawn with two "
               "thirds of the window's pixels in each direction. View > Fine pictures draws all "
               "pixels, more slowly.")
                .arg(QString::fromStdString(renderer)));
    }
}

void SceneWidget::draw_scene() {
    if (!view_) make_view();
    view_->set_detail(detail_.next());
    const std::vector<Vec3> path(path_.begin(), path_.end());
    view::Overlays overlays;
    overlays.handles = layers_.handles;
    overlays.forces = layers_.forces;
    overlays.contacts = layers_.contacts;
    overlays.grip_axis = layers_.grip_axis;
    overlays.joints = layers_.joints;
    overlays.hand = layers_.hand;
    overlays.picked = picked_;
    // a screen does not show depth and a mouse renders no force, so the lines are needed
    overlays.drop_lines = layers_.drop_lines || hand_;
    overlays.patch = patch_;
    if (layers_.path) overlays.path = path;
    std::vector<view::Workspace> workspaces;
    for (const view::Workspace& workspace : workspaces_)
        workspaces.push_back({turn_.turned(workspace.X_WD), workspace.size});
    if (layers_.workspaces) overlays.workspaces = workspaces;
    const double scale = devicePixelRatioF();
    const int across = static_cast<int>(width() * scale);
    const int up = static_cast<int>(height() * scale);
    display_.forget_head();
    shown_ = display_ ? view_->draw(frame_, display_.now(), across, up, overlays)
                      : view_->draw(frame_, camera_, across, up, overlays);
}

void SceneWidget::enterEvent(QEnterEvent* event) {
    pointer_ = event->position();
}

view::Ray SceneWidget::ray_to(const QPointF& pointer) const {
    const double half = height() / 2.0;
    return view::ray_through(camera_, (pointer.x() - width() / 2.0) / half, 1 - pointer.y() / half);
}

void SceneWidget::mousePressEvent(QMouseEvent* event) {
    pointer_ = pressed_ = event->position();
    if (event->button() != Qt::LeftButton || !picked_ || hand_ || display_) return;
    const view::Ray ray = ray_to(pointer_);
    const auto seen = view::seen_first(scene_, frame_, ray);
    if (!seen || seen->body != *picked_) return;
    drag_.emplace(*seen, ray, frame_.bodies[*picked_].X_WB);
}

void SceneWidget::drag(const QPointF& way, Qt::KeyboardModifiers keys) {
    if (drag_->way().none() && (pointer_ - pressed_).manhattanLength() <= kStill) return;
    drag_->follow(ray_to(pointer_), way, keys);
    frame_.bodies[*picked_].X_WB = drag_->X_WB();
    Q_EMIT dragging(*picked_, frame_.bodies[*picked_].X_WB);
    update();
}

/// Picks the body under the pointer, if the click moved neither the camera, a body nor the hand.
void SceneWidget::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    const auto drag = std::exchange(drag_, std::nullopt);
    if (drag && !drag->way().none()) return Q_EMIT dragged(*picked_, drag->way());
    const QPointF way = event->position() - pressed_;
    if (hand_ || display_ || cameras_.empty() || way.manhattanLength() > kStill) return;
    if (const auto seen = view::seen_first(scene_, frame_, ray_to(event->position())))
        Q_EMIT picked(seen->body);
}

void SceneWidget::look(const QPointF& way, bool pan) {
    set_camera(pan ? view::panned(camera_, way.x() / height(), -way.y() / height())
                   : view::orbited(camera_, -kOrbit * way.x(), kOrbit * way.y()));
}

void SceneWidget::zoom(double notches) {
    set_camera(view::zoomed(camera_, std::pow(0.9, notches)));
}

void SceneWidget::mouseMoveEvent(QMouseEvent* event) {
    const QPointF way = event->position() - pointer_;
    pointer_ = event->position();
    if (display_) return;  // the mouse must not move the camera, whose place is at the eyes
    if (drag_) return drag(way, event->modifiers());
    const bool shift = event->modifiers().testFlag(Qt::ShiftModifier);
    const bool left = event->buttons().testFlag(Qt::LeftButton);
    const bool orbit = event->buttons().testFlag(Qt::RightButton) || (left && !hand_);
    const bool pan = event->buttons().testFlag(Qt::MiddleButton) || (orbit && shift);
    if (pan || orbit) {
        look(way, pan);
    } else if (hand_) {
        setFocus();  // keys control the hand while the pointer is over the scene
        if (hand_.stays()) return;
        if (!left) return move_hand(way, shift);
        hand_->turn(way);
        Q_EMIT hand_moved();
    }
}

void SceneWidget::wheelEvent(QWheelEvent* event) {
    const double notches = event->angleDelta().y() / 120.0;
    if (hand_ && !event->modifiers().testFlag(Qt::ControlModifier)) {
        constexpr double kNotch = 20;  // movement of the hand per notch [pixels]
        if (!hand_.squeezes()) {
            move_hand(QPointF(0, -kNotch * notches), true);
        } else {
            hand_->wheel(-notches);
            Q_EMIT hand_moved();
        }
    } else {
        zoom(notches);
    }
    event->accept();
}

bool SceneWidget::look_by_key(const QKeyEvent& event) {
    if (!event.modifiers().testFlag(Qt::ControlModifier) || display_) return false;
    constexpr double kWay = 30;  // mouse movement that a key press replaces [px]
    QPointF way;
    if (event.key() == Qt::Key_Left) way.rx() = -kWay;
    if (event.key() == Qt::Key_Right) way.rx() = kWay;
    if (event.key() == Qt::Key_Up) way.ry() = -kWay;
    if (event.key() == Qt::Key_Down) way.ry() = kWay;
    const bool nearer = event.key() == Qt::Key_Plus || event.key() == Qt::Key_Equal;
    if (nearer || event.key() == Qt::Key_Minus) {
        zoom(nearer ? 1 : -1);
    } else if (!way.isNull()) {
        look(way, event.modifiers().testFlag(Qt::ShiftModifier));
    } else {
        return false;
    }
    return true;
}

void SceneWidget::keyPressEvent(QKeyEvent* event) {
    if (look_by_key(*event)) return;
    if (const auto step = step_of(*event, camera_); step && picked_) return Q_EMIT stepped(*step);
    hand_.set_key(*event, true);
    if (hand_ && event->key() == Qt::Key_H && !event->isAutoRepeat()) set_staying(!hand_.stays());
    QOpenGLWidget::keyPressEvent(event);  // passed on, because a task may wait for the key
}

void SceneWidget::keyReleaseEvent(QKeyEvent* event) {
    hand_.set_key(*event, false);
    QOpenGLWidget::keyReleaseEvent(event);
}

void SceneWidget::focusOutEvent(QFocusEvent* event) {
    hand_.release_keys();
    QOpenGLWidget::focusOutEvent(event);
}

}  // namespace dihaptic::gui
