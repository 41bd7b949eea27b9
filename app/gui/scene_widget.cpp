#include "scene_widget.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QScreen>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/diagnostics.h"
#include "frame/displayed.h"
#include "label_fit.h"

namespace dihaptic::gui {
namespace {

constexpr double kOrbit = 0.006;     // [rad/pixel]
constexpr double kStill = 3;         // a pointer movement up to this length counts as a click [px]
constexpr double kCoarse = 2.0 / 3;  // detail of moving pictures when drawing is slow
constexpr int kUntilStill = 200;     // without a new picture for so long, nothing moves [ms]
constexpr int kUntilOver = 2000;     // nor without a new frame: a busy computer delays them [ms]
constexpr size_t kPath = 300;        // length of the path: five seconds [pictures]

}  // namespace

SceneWidget::SceneWidget(QWidget* parent)
    : QOpenGLWidget(parent),
      page_(new PageView(this)),
      questions_(new QuestionsView(this)),
      banner_(new SignLabel(this)),
      held_(new SignLabel(this)),
      help_(new QLabel(this)) {
    setAccessibleName(tr("Scene"));
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setMinimumSize(320, 240);
    connect(this, &QOpenGLWidget::frameSwapped, this, [this] {
        take_turns();
        if (shown_.sequence == presented_) return;
        presented_ = shown_.sequence;
        Q_EMIT presented(presented_);
    });
    still_.setSingleShot(true);
    connect(&still_, &QTimer::timeout, this, [this] {
        is_still_ = true;
        update();
    });
    held_->set(tr("Hand held"), tr("It does not follow the mouse. H moves it again."),
               Sign::paused);
    help_->setAttribute(Qt::WA_TransparentForMouseEvents);
    help_->hide();
    help_->setStyleSheet(
        "background: rgba(255, 255, 255, 190); color: #20242a; padding: 8px 12px; border-radius: "
        "6px;");
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
    since_frame_.start();
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
    hand_ = hand;
    squeezes_ = squeezes;
    keys_ = MouseHand::Squeeze::none;
    set_staying(false);
    if (hand_ != nullptr) setFocus();
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
    stays_ = stays;
    setCursor(hand_ == nullptr ? Qt::OpenHandCursor : stays ? Qt::ArrowCursor : Qt::CrossCursor);
    show_help();
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

void SceneWidget::set_banner(const QString& text) {
    if (!banner_->set("", text)) return;
    show_banner();
    place_labels();
}

void SceneWidget::set_sign(const QString& word, const QString& text, Sign sign) {
    if (!banner_->set(word, text, sign)) return;
    show_banner();
    place_labels();
}

void SceneWidget::ask(const std::optional<Asked>& asked) {
    questions_->ask(asked);
    show_banner();
}

/// Shows the banner, unless a form is shown, which contains all its texts itself.
void SceneWidget::show_banner() {
    banner_->setVisible(!banner_->is_empty() && !questions_->shows_form());
}

void SceneWidget::show_help() {
    held_->setVisible(stays_ && !help_->text().isEmpty());
    help_->setVisible(!stays_ && !help_->text().isEmpty());
}

void SceneWidget::set_help(const QString& text) {
    if (help_->text() == text) return;
    help_->setText(text);
    show_help();
    place_labels();
}

void SceneWidget::set_page(const QString& text, const QString& picture) {
    page_->set_page(text, picture);
}

void SceneWidget::set_display(const std::optional<display::Display>& display) {
    display_ = display;
    const bool turned = display && display->mirrored != display::Mirrored::no;
    const bool split = display && (display->stereo == display::Stereo::side_by_side ||
                                   display->stereo == display::Stereo::top_bottom);
    std::unique_ptr<QWidget> words;
    if (turned || split) {
        words = std::make_unique<QWidget>();
        words->setAttribute(Qt::WA_TranslucentBackground);
    }
    QWidget* const parent = words ? words.get() : this;
    for (QWidget* child : std::array<QWidget*, 5>{page_, questions_, banner_, held_, help_}) {
        const bool hidden = child->isHidden();
        child->setParent(parent);
        child->setVisible(!hidden);
    }
    words_ = std::move(words);
    place_labels();
    update();
}

void SceneWidget::set_head(const outlets::HeadPose& head) {
    const bool moved = !head_ || head_->eyes != head.eyes || head_->along != head.along;
    head_ = head;
    if (moved && display_ && display_->eyes.tracked) update();
}

void SceneWidget::place_labels() {
    QSize room = size();
    if (words_) {
        const view::Pane pane = view::panes(*display_, 1).front();
        room = {static_cast<int>(room.width() * pane.width),
                static_cast<int>(room.height() * pane.height)};
        words_->resize(room);
    }
    const int width = room.width(), height = room.height();
    page_->setGeometry({{0, 0}, room});
    questions_->place(room);
    // legible from a chair on a screen of any size
    const int letter = std::max(20, height / 30);
    for (SignLabel* label : {banner_, held_}) label->fit(letter, width - 40);
    fit_label(*help_, width - 24);
    banner_->move((width - banner_->width()) / 2, 24);
    held_->move((width - held_->width()) / 2, height - held_->height() - 24);
    help_->move(12, height - help_->height() - 12);
}

void SceneWidget::resizeEvent(QResizeEvent* event) {
    QOpenGLWidget::resizeEvent(event);
    place_labels();
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
    if (words_) draw_words();
}

void SceneWidget::set_patch(const std::optional<view::PatchLook>& patch) {
    patch_ = patch;
    update();
}

void SceneWidget::set_fine(bool fine) {
    fine_ = fine;
    update();
}

void SceneWidget::make_view() {
    view_ = std::make_unique<view::SceneView>(scene_);
    const std::string renderer = view::renderer();
    if (!fine_ && view::is_software(renderer)) {
        fine_ = false;
        Q_EMIT draws_in_software(
            tr("there is no graphics card (%1): while something moves, the scene is drawn with two "
               "thirds of the window's pixels in each direction. View > Fine pictures draws all "
               "pixels, more slowly.")
                .arg(QString::fromStdString(renderer)));
    }
}

/// Draws all pixels once nothing moves any more.
void SceneWidget::choose_detail() {
    const bool all = std::exchange(is_still_, false) || fine_ != false;
    view_->set_detail(all ? 1 : kCoarse);
    const bool runs = since_frame_.isValid() && !since_frame_.hasExpired(kUntilOver);
    if (!all) still_.start(runs ? kUntilOver : kUntilStill);
}

void SceneWidget::draw_scene() {
    if (!view_) make_view();
    choose_detail();
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
    overlays.drop_lines = layers_.drop_lines || hand_ != nullptr;
    overlays.patch = patch_;
    if (layers_.path) overlays.path = path;
    std::vector<view::Workspace> workspaces;
    for (const view::Workspace& workspace : workspaces_)
        workspaces.push_back({turn_.turned(workspace.X_WD), workspace.size});
    if (layers_.workspaces) overlays.workspaces = workspaces;
    const double scale = devicePixelRatioF();
    const int across = static_cast<int>(width() * scale);
    const int up = static_cast<int>(height() * scale);
    shown_to_.reset();
    shown_ = display_ ? view_->draw(frame_, seen_display(), across, up, overlays)
                      : view_->draw(frame_, camera_, across, up, overlays);
}

/// The display with the current position of its eyes. A head position behind the screen, or nearly
/// touching it, is ignored, because nothing could be drawn for it.
display::Display SceneWidget::seen_display() {
    display::Display out = *display_;
    if (out.eyes.tracked && head_) {
        out.eyes.position = head_->eyes;
        out.eyes.along = head_->along;
        if (out.faces(out.eyes)) {
            shown_to_ = head_;
        } else {
            out.eyes = display_->eyes;
        }
    }
    if (out.stereo == display::Stereo::in_turn) out.eyes.position = out.eyes.of(right_eye_);
    return out;
}

/// Determines which eye's picture is next. The glasses alternate between the eyes even if a picture
/// is late, so the number of refreshes since the last picture is counted.
void SceneWidget::take_turns() {
    if (!display_ || display_->stereo != display::Stereo::in_turn) return;
    const double periods =
        1e-9 * static_cast<double>(since_swap_.nsecsElapsed()) * screen()->refreshRate();
    const bool timed = since_swap_.isValid() && std::isfinite(periods);
    since_swap_.start();
    if (!timed || std::lround(std::max(1.0, periods)) % 2 == 1) right_eye_ = !right_eye_;
    update();
}

/// Draws the page, the question and the texts into each eye's part of the picture, mirrored if the
/// display is seen in a mirror.
void SceneWidget::draw_words() {
    const QList<QWidget*> children = words_->findChildren<QWidget*>(Qt::FindDirectChildrenOnly);
    if (std::all_of(children.begin(), children.end(), [](QWidget* w) { return w->isHidden(); }))
        return;
    const double scale = devicePixelRatioF();
    QImage picture(words_->size() * scale, QImage::Format_ARGB32_Premultiplied);
    picture.setDevicePixelRatio(scale);
    picture.fill(Qt::transparent);
    words_->render(&picture, {}, {}, QWidget::DrawChildren);
    picture = picture.mirrored(display_->mirrored == display::Mirrored::left_right,
                               display_->mirrored == display::Mirrored::up_down);
    QPainter painter(this);
    for (const view::Pane& pane : view::panes(*display_, 1)) {
        painter.drawImage(QPointF(pane.left * width(), (1 - pane.bottom - pane.height) * height()),
                          picture);
        if (!pane.green_blue) break;  // both eyes see the whole picture
    }
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
    if (event->button() != Qt::LeftButton || !picked_ || hand_ != nullptr || display_) return;
    const view::Ray ray = ray_to(pointer_);
    const auto seen = view::seen_first(scene_, frame_, ray);
    if (!seen || seen->body != *picked_) return;
    drag_.emplace(*seen, ray);
    X_WB_dragged_ = frame_.bodies[*picked_].X_WB;
}

void SceneWidget::drag(const QPointF& way, Qt::KeyboardModifiers keys) {
    if (drag_->way().none() && (pointer_ - pressed_).manhattanLength() <= kStill) return;
    drag_->follow(ray_to(pointer_), way, keys);
    frame_.bodies[*picked_].X_WB = drag_->way().of(X_WB_dragged_);
    Q_EMIT dragging(*picked_, frame_.bodies[*picked_].X_WB);
    update();
}

/// Picks the body under the pointer, if the click moved neither the camera, a body nor the hand.
void SceneWidget::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    const auto drag = std::exchange(drag_, std::nullopt);
    if (drag && !drag->way().none()) return Q_EMIT dragged(*picked_, drag->way());
    const QPointF way = event->position() - pressed_;
    if (hand_ != nullptr || display_ || cameras_.empty() || way.manhattanLength() > kStill) return;
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
    const bool orbit = event->buttons().testFlag(Qt::RightButton) || (left && hand_ == nullptr);
    const bool pan = event->buttons().testFlag(Qt::MiddleButton) || (orbit && shift);
    if (pan || orbit) {
        look(way, pan);
    } else if (hand_ != nullptr) {
        setFocus();  // keys control the hand while the pointer is over the scene
        if (stays_) return;
        if (!left) return move_hand(way, shift);
        hand_->turn(way);
        Q_EMIT hand_moved();
    }
}

void SceneWidget::wheelEvent(QWheelEvent* event) {
    const double notches = event->angleDelta().y() / 120.0;
    if (hand_ != nullptr && !event->modifiers().testFlag(Qt::ControlModifier)) {
        constexpr double kNotch = 20;  // movement of the hand per notch [pixels]
        if (!squeezes_) {
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

void SceneWidget::set_key(const QKeyEvent& event, bool down) {
    if (hand_ == nullptr || event.isAutoRepeat()) return;
    MouseHand::Squeeze key = MouseHand::Squeeze::none;
    if (event.key() == Qt::Key_Space) key = MouseHand::Squeeze::close;
    if (event.key() == Qt::Key_V) key = MouseHand::Squeeze::open;
    if (key == MouseHand::Squeeze::none) return;
    if (down) {
        keys_ = key;
    } else if (keys_ == key) {
        keys_ = MouseHand::Squeeze::none;
    }
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
    set_key(*event, true);
    if (hand_ != nullptr && event->key() == Qt::Key_H && !event->isAutoRepeat())
        set_staying(!stays_);
    QOpenGLWidget::keyPressEvent(event);  // passed on, because a task may wait for the key
}

void SceneWidget::keyReleaseEvent(QKeyEvent* event) {
    set_key(*event, false);
    QOpenGLWidget::keyReleaseEvent(event);
}

void SceneWidget::focusOutEvent(QFocusEvent* event) {
    keys_ = MouseHand::Squeeze::none;
    QOpenGLWidget::focusOutEvent(event);
}

}  // namespace dihaptic::gui
