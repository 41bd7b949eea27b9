#include "view/scene_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <span>

#include "base/diagnostics.h"
#include "frame/displayed.h"
#include "model/grasp.h"
#include "view/colours.h"
#include "view/gl.h"
#include "view/hand_mesh.h"
#include "view/joint_marks.h"
#include "view/shaders.h"
#include "view/shadow_map.h"
#include "view/solids.h"
#include "view/thing.h"

namespace dihaptic::view {
namespace {

constexpr int kSamples = 4;
constexpr int kShadowMap = 512;            // width in texels, halved for less detailed pictures
constexpr double kArrowPerNewton = 0.025;  // [m/N]
constexpr double kDepthRange = 4;          // largest depth along the light [m]

/// Rotation R_LW into the frame of the light, in which z is the depth, i.e. the direction away from
/// the light.
Mat3 light_rotation() {
    const Vec3 z = -SceneView::light();
    const Vec3 x = Vec3::UnitY().cross(z).normalized();
    Mat3 R_WL;
    R_WL << x, z.cross(x), z;
    return R_WL.transpose();
}

/// The matrix that scales a model and moves it to a pose.
Eigen::Matrix4d placed(const Pose& X, const Vec3& scale = Vec3::Ones()) {
    Eigen::Matrix4d out = gl::matrix(X);
    out.topLeftCorner<3, 3>() *= scale.asDiagonal();
    return out;
}

/// Restores the framebuffer that was bound for drawing when its scope ends.
class KeepTarget {
  public:
    KeepTarget() { glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target_); }
    ~KeepTarget() { glBindFramebuffer(GL_FRAMEBUFFER, name()); }
    KeepTarget(const KeepTarget&) = delete;
    KeepTarget& operator=(const KeepTarget&) = delete;
    GLuint name() const { return static_cast<GLuint>(target_); }

  private:
    GLint target_ = 0;
};

/// The pose with its origin at `a` and its z axis toward `b`.
Pose along(const Vec3& a, const Vec3& b) {
    return {Quat(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), b - a)), a};
}

/// Adds the edges of a box that is centred at the origin of A.
void add_box(Solids& out, const Pose& X_WA, const Vec3& size, double radius, const Vec3& tint) {
    for (int axis = 0; axis < 3; ++axis) {
        for (int corner = 0; corner < 4; ++corner) {
            Vec3 a;
            a[axis] = -0.5;
            a[(axis + 1) % 3] = (corner & 1) - 0.5;
            a[(axis + 2) % 3] = (corner >> 1) - 0.5;
            Vec3 b = a;
            b[axis] = 0.5;
            out.add_line(X_WA * a.cwiseProduct(size), X_WA * b.cwiseProduct(size), radius, tint);
        }
    }
}

void add_grip_axis(Solids& out, const frame::Frame& frame, size_t fingers) {
    const auto place = [&](size_t i) -> Vec3 { return frame::displayed_proxy(frame, i).p; };
    out.add_line(place(0), model::opposing_point(fingers, place), 0.0006, ink("#7b4ea3"));
}

/// A program that draws surfaces with light and shadows. Features are selected with #define instead
/// of uniforms, because a software renderer executes both branches.
gl::Program surface_program(Shadows shadows, const std::string& defined) {
    const std::string defines = defined + (shadows == Shadows::plain ? "#define PLAIN\n" : "");
    return {defines + shaders::kSurfaceVertex,
            defines + shaders::kBackground + shaders::kSurfaceFragment};
}

void check_version() {
    if (epoxy_gl_version() >= 33) return;
    throw Error("OpenGL 3.3 is required, but this context offers an older version",
                "Update the graphics driver, or draw in software: LIBGL_ALWAYS_SOFTWARE=1 "
                "dihaptic ...");
}

}  // namespace

std::string renderer() {
    return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

bool is_software(const std::string& renderer) {
    const auto has = [&](const char* name) { return renderer.find(name) != std::string::npos; };
    return has("llvmpipe") || has("softpipe") || has("swrast") || has("SWR");
}

Vec3 SceneView::light() {
    return Vec3(-0.45, -0.5, 1).normalized();
}

struct SceneView::Parts {
    std::vector<Thing> bodies;
    std::vector<Thing> fingers;
    Shadows kind;
    std::vector<JointMark> joints;
    gl::Model floor;  // below everything, only in the shadow map: the depth beyond a table's edge
    Pose X_WF;
    double table_top = 0;       // height of the surface that bodies stand on [m]
    Vec3 start = Vec3::Zero();  // initial middle of the bodies that cast shadows
    double start_radius = 0.1;  // radius of a ball about `start` that encloses these bodies [m]
    ShadowMap shadow_map{kShadowMap};
    gl::Program surface;
    std::optional<gl::Program> looks;  // shader program for metals, pictures and own colours
    std::map<const Image*, gl::Texture> pictures;
    gl::Program background;
    gl::VertexArray nothing;
    gl::Model ball;                 // sphere of radius 1
    std::optional<HandMesh> hand;   // made when it is first drawn
    std::optional<gl::Model> skin;  // the hand in the frame that is being drawn
    int thumb = -1;                 // indices of these fingers; -1 if missing
    int index = -1;
    // the multisampled picture
    gl::Framebuffer samples;
    gl::Renderbuffer colour;
    gl::Renderbuffer depth;
    int width = 0;
    int height = 0;
    double detail = 1;
    // the picture before it is enlarged
    gl::Framebuffer resolved;
    gl::Renderbuffer resolved_colour;

    Parts(const scene::Scene& scene, Shadows shadows)
        : kind(shadows),
          surface(surface_program(shadows, "")),
          background(shaders::kBlurVertex,
                     std::string(shaders::kBackground) + shaders::kBackgroundFragment) {
        GLuint name = 0;
        glGenVertexArrays(1, &name);
        nothing = gl::VertexArray(name);
        ball = gl::Model(triangles(scene::Shape::sphere(1)));
        for (size_t i = 0; i < scene.bodies.size(); ++i) {
            const Thing& thing =
                bodies.emplace_back(thing_of(scene, i, texture_of(scene.bodies[i].picture)));
            if (thing.ground) table_top = thing.highest;
            if (thing.has_looks(nullptr) && !looks)
                looks = surface_program(shadows, "#define LOOKS\n");
        }
        for (size_t i = 0; i < scene.fingers.size(); ++i) {
            fingers.emplace_back(triangles(scene.fingers[i].shape), Pose{}, finger_colour(i));
            if (scene.fingers[i].name == "thumb") thumb = static_cast<int>(i);
            if (scene.fingers[i].name == "index") index = static_cast<int>(i);
        }
        joints = joint_marks(scene);
        floor = gl::Model(square(2 * kDepthRange));
        for (const Thing& thing : bodies) X_WF.p.z() = std::min(X_WF.p.z(), thing.lowest);
        find_start(scene);
    }

    /// A picture is loaded into one texture only, however many bodies use it.
    GLuint texture_of(const std::optional<scene::Picture>& picture) {
        if (!picture || !picture->image) return 0;
        gl::Texture& texture = pictures[picture->image.get()];
        if (texture == 0) texture = gl::make_texture(*picture->image);
        return texture;
    }

    void find_start(const scene::Scene& scene) {
        int count = 0;
        for (size_t i = 0; i < bodies.size(); ++i) {
            if (bodies[i].ground) continue;
            start += scene.bodies[i].position;
            ++count;
        }
        if (count > 0) start /= count;
        for (size_t i = 0; i < bodies.size(); ++i) {
            if (bodies[i].ground) continue;
            start_radius = std::max(start_radius,
                                    (scene.bodies[i].position - start).norm() + bodies[i].radius);
        }
        start_radius += 0.05;  // leaves room for the fingers around the bodies
    }

    /// Half of the shadow map's width: the smallest in a series of steps that covers everything
    /// that casts shadows, except for distant things. Steps are used because otherwise shadows
    /// would swim as bodies move.
    double reach(const frame::Frame& frame, const Mat3& R_LW) const {
        double needed = start_radius;
        const double most = 4 * start_radius + 0.5;
        const auto include = [&](const Thing& thing, const Vec3& p) {
            const double r = (R_LW * (p - start)).head<2>().norm() + thing.radius + 0.02;
            if (r < most) needed = std::max(needed, r);
        };
        for (size_t i = 0; i < bodies.size(); ++i) {
            if (!bodies[i].ground) include(bodies[i], frame::displayed_body(frame, i).p);
        }
        for (size_t i = 0; i < fingers.size(); ++i)
            include(fingers[i], frame::displayed_proxy(frame, i).p);
        return start_radius * std::exp2(std::ceil(2 * std::log2(needed / start_radius)) / 2);
    }

    /// Allocates buffers for a picture of this size, reduced according to `detail`.
    void resize(int picture_width, int picture_height) {
        const auto of = [&](int pixels) {
            return std::max(1, static_cast<int>(std::lround(detail * pixels)));
        };
        const int new_width = of(picture_width), new_height = of(picture_height);
        if (width == new_width && height == new_height) return;
        width = new_width;
        height = new_height;
        GLint most = 0;
        glGetIntegerv(GL_MAX_SAMPLES, &most);
        const auto make = [&](GLenum format) {
            gl::Renderbuffer buffer = gl::make_renderbuffer();
            glBindRenderbuffer(GL_RENDERBUFFER, buffer);
            glRenderbufferStorageMultisample(GL_RENDERBUFFER, std::min(kSamples, most), format,
                                             width, height);
            return buffer;
        };
        colour = make(GL_RGBA8);
        depth = make(GL_DEPTH_COMPONENT24);
        samples = gl::make_framebuffer();
        glBindFramebuffer(GL_FRAMEBUFFER, samples);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
        resolved_colour = gl::make_renderbuffer();
        glBindRenderbuffer(GL_RENDERBUFFER, resolved_colour);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
        resolved = gl::make_framebuffer();
        glBindFramebuffer(GL_FRAMEBUFFER, resolved);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                  resolved_colour);
    }

    /// Sets up and returns the program that draws a thing. `tint`: the colour given by an
    /// experiment; null if there is none.
    using Prepare = std::function<const gl::Program&(const Thing&, const Vec3* tint)>;

    /// Poses the hand for this frame, if it is to be drawn and holds something.
    void pose_hand(const frame::Frame& frame, bool drawn) {
        skin.reset();
        const auto is_seen = [&](int finger) {
            return finger >= 0 &&
                   frame::is_displayed(frame, bodies.size() + static_cast<size_t>(finger));
        };
        if (!drawn || !is_seen(thumb) || !is_seen(index)) return;
        const auto at = [&](int finger) {
            return frame::displayed_proxy(frame, static_cast<size_t>(finger)).p;
        };
        const auto pose = hand_pose(at(thumb), at(index));
        if (!pose) return;
        if (!hand) hand.emplace();
        skin.emplace(hand->posed(*pose));
    }

    void draw_models(const frame::Frame& frame, const Prepare& prepare) const {
        const auto draw = [&](const Thing& thing, size_t body, const Pose& X) {
            if (!frame::is_displayed(frame, body)) return;
            const frame::LookFrame* look = frame::item_of(frame.task.looks, body);
            const bool tinted = look != nullptr && look->colour >= 0;
            const Vec3 tint =
                tinted ? linear_colour(static_cast<uint32_t>(look->colour)) : Vec3::Zero();
            const gl::Program& program = prepare(thing, tinted ? &tint : nullptr);
            program.set("world_from_model",
                        placed(X, Vec3::Constant(frame::displayed_size(frame, body))));
            thing.model.draw();
        };
        for (size_t i = 0; i < bodies.size(); ++i)
            draw(bodies[i], i, frame::displayed_body(frame, i));
        for (size_t i = 0; i < fingers.size(); ++i)
            draw(fingers[i], bodies.size() + i, frame::displayed_proxy(frame, i));
    }

    /// The world as the light sees it, for the shadow map.
    struct Lamp {
        Eigen::Matrix4d light_from_world = Eigen::Matrix4d::Identity();
        double texel = 0;  // [m]
    };

    Shown draw(const frame::Frame& frame, std::span<const Pane> all, int new_width, int new_height,
               const Overlays& overlays);
    Lamp render_shadows(const frame::Frame& frame);
    void draw_patch(const PatchLook& look) const;
    // `corner` and `size` are those of a pane [pixels]
    void draw_background(const Eigen::Vector2d& corner, const Eigen::Vector2d& size) const;
    void draw_surfaces(const frame::Frame& frame, const Viewpoint& viewpoint,
                       const Eigen::Vector2d& corner, const Eigen::Vector2d& size,
                       const Lamp& lamp) const;
    void draw_overlays(const frame::Frame& frame, const Overlays& overlays) const;
    void add_drop_lines(Solids& out, const frame::Frame& frame) const;
    void add_picked(Solids& out, const frame::Frame& frame, size_t body) const;
    void add_contacts(Solids& out, const frame::Frame& frame, const Overlays& overlays) const;
    void draw_solids(const Solids& solids) const;
    void draw_targets(const frame::Frame& frame) const;
    void draw_hand() const;
    void draw_ghosts(const frame::Frame& frame) const;
};

SceneView::SceneView(const scene::Scene& scene, Shadows shadows) {
    check_version();
    const KeepTarget target;
    parts_ = std::make_unique<Parts>(scene, shadows);
}

SceneView::~SceneView() = default;

Shown SceneView::draw(const frame::Frame& frame, const Camera& camera, int width, int height,
                      const Overlays& overlays) {
    const double distance = (camera.position - camera.look_at).norm();
    const double aspect = static_cast<double>(width) / height;
    const Viewpoint viewpoint{camera.position,
                              projection(camera, aspect, 0.05 * distance, distance + kPlaneSize)};
    return parts_->draw(frame, std::array{Pane{viewpoint}}, width, height, overlays);
}

Shown SceneView::draw(const frame::Frame& frame, const display::Display& display, int width,
                      int height, const Overlays& overlays) {
    return parts_->draw(frame, panes(display, kPlaneSize), width, height, overlays);
}

Shown SceneView::draw(const frame::Frame& frame, std::span<const Pane> panes, int width, int height,
                      const Overlays& overlays) {
    return parts_->draw(frame, panes, width, height, overlays);
}

Shown SceneView::Parts::draw(const frame::Frame& frame, std::span<const Pane> all, int new_width,
                             int new_height, const Overlays& overlays) {
    const KeepTarget target;
    resize(new_width, new_height);
    pose_hand(frame, overlays.hand);
    const Lamp lamp = render_shadows(frame);
    glBindFramebuffer(GL_FRAMEBUFFER, samples);
    glEnable(GL_SCISSOR_TEST);
    for (const Pane& pane : all) {
        const auto pixels = [](double share, int of) {
            return static_cast<int>(std::lround(share * of));
        };
        const int left = pixels(pane.left, width), bottom = pixels(pane.bottom, height);
        const int across = pixels(pane.width, width), up = pixels(pane.height, height);
        glViewport(left, bottom, across, up);
        glScissor(left, bottom, across, up);
        glColorMask(pane.red, pane.green_blue, pane.green_blue, GL_TRUE);
        glFrontFace(pane.viewpoint.flipped ? GL_CW : GL_CCW);
        const Eigen::Vector2d corner(left, bottom), size(across, up);
        draw_background(corner, size);
        draw_surfaces(frame, pane.viewpoint, corner, size, lamp);
        draw_overlays(frame, overlays);
    }
    glFrontFace(GL_CCW);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    if (overlays.patch) draw_patch(*overlays.patch);
    glDisable(GL_SCISSOR_TEST);

    const auto copy = [&](GLuint from, GLuint to, int to_width, int to_height, GLenum filter) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
        glBlitFramebuffer(0, 0, width, height, 0, 0, to_width, to_height, GL_COLOR_BUFFER_BIT,
                          filter);
    };
    if (detail == 1) {
        copy(samples, target.name(), width, height, GL_NEAREST);
    } else {
        // a multisampled picture cannot be scaled while it is copied
        copy(samples, resolved, width, height, GL_NEAREST);
        copy(resolved, target.name(), new_width, new_height, GL_LINEAR);
    }
    return {frame.sequence, frame.time};
}

void SceneView::set_detail(double share) {
    const KeepTarget target;
    const int size = share < 1 ? kShadowMap / 2 : kShadowMap;
    if (size != parts_->shadow_map.size()) parts_->shadow_map = ShadowMap(size);
    parts_->detail = share;
}

/// The scissor test must be enabled.
void SceneView::Parts::draw_patch(const PatchLook& look) const {
    using display::Corner;
    const int edge = static_cast<int>(std::lround(look.patch.size * height));
    const Corner corner = look.patch.corner;
    const bool right = corner == Corner::lower_right || corner == Corner::upper_right;
    const bool upper = corner == Corner::upper_left || corner == Corner::upper_right;
    const float light = look.white ? 1 : 0;
    glScissor(right ? width - edge : 0, upper ? height - edge : 0, edge, edge);
    glClearBufferfv(GL_COLOR, 0, std::array{light, light, light, 1.f}.data());
}

SceneView::Parts::Lamp SceneView::Parts::render_shadows(const frame::Frame& frame) {
    const Mat3 R_LW = light_rotation();
    const double half = reach(frame, R_LW);
    Lamp out;
    out.light_from_world.topLeftCorner<3, 3>() = Vec3(1 / half, 1 / half, 1).asDiagonal() * R_LW;
    out.light_from_world.topRightCorner<3, 1>() =
        -out.light_from_world.topLeftCorner<3, 3>() * start;
    out.texel = 2 * half / shadow_map.size();
    shadow_map.render(out.light_from_world, kDepthRange, out.texel, kind == Shadows::variance,
                      [&](const gl::Program& program) {
                          program.set("world_from_model", gl::matrix(X_WF));
                          floor.draw();
                          draw_models(frame, [&](const Thing&, const Vec3*) -> const gl::Program& {
                              return program;
                          });
                          if (!skin) return;
                          program.set("world_from_model", gl::matrix(Pose{}));
                          skin->draw();
                      });
    return out;
}

void SceneView::Parts::draw_background(const Eigen::Vector2d& corner,
                                       const Eigen::Vector2d& size) const {
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    background.use();
    background.set("corner", corner);
    background.set("size", size);
    glBindVertexArray(nothing);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void SceneView::Parts::draw_surfaces(const frame::Frame& frame, const Viewpoint& viewpoint,
                                     const Eigen::Vector2d& corner, const Eigen::Vector2d& size,
                                     const Lamp& lamp) const {
    const float furthest = 1;
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glClearBufferfv(GL_DEPTH, 0, &furthest);
    const auto begin = [&](const gl::Program& program) {
        program.use();
        program.set("corner", corner);
        program.set("size", size);
        program.set("clip_from_world", viewpoint.clip_from_world);
        program.set("eye", viewpoint.eye_W);
        program.set("middle", start);
        program.set("light", light());
        program.set("light_from_world", lamp.light_from_world);
        program.set("texel", lamp.texel);
        program.set("shadowed", 1);
        program.set("moments", 0);
        program.set("picture", 1);
        program.set("alpha", 1.0);
        program.set("rim", 0.0);
    };
    if (looks) begin(*looks);
    begin(surface);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, shadow_map.texture());
    draw_models(frame, [&](const Thing& thing, const Vec3* tint) -> const gl::Program& {
        const gl::Program& program = thing.has_looks(tint) ? *looks : surface;
        program.use();
        thing.set(program, tint);
        return program;
    });
    surface.use();
}

/// Draws the targets as transparent, so that things inside them remain visible. A large one,
/// which surrounds hand and object, is a bubble of which little more than the rim is seen.
void SceneView::Parts::draw_targets(const frame::Frame& frame) const {
    constexpr double kAlpha = 0.45, kLargestFull = 0.02;  // radius [m]
    surface.set("gloss", 0.4);
    glDepthMask(GL_FALSE);
    glEnable(GL_CULL_FACE);
    for (size_t i = 0; i < frame.task.targets.size(); ++i) {
        const int32_t rgb = frame.task.targets[i].colour;
        const double radius = frame.task.targets[i].radius;
        const double alpha = kAlpha * std::min(1.0, kLargestFull / radius);
        surface.set("alpha", alpha);
        surface.set("rim", kAlpha - alpha);
        surface.set("albedo", rgb < 0 ? ink("#d55e00") : linear_colour(static_cast<uint32_t>(rgb)));
        surface.set(
            "world_from_model",
            placed({Quat::Identity(), frame::displayed_target(frame, i)}, Vec3::Constant(radius)));
        ball.draw();
    }
    surface.set("rim", 0.0);
    glDisable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
}

/// Draws the hand as transparent, so that fingers and objects that it covers remain visible. Only
/// the skin that is nearest to the eye is drawn: its depth is found first.
void SceneView::Parts::draw_hand() const {
    if (!skin) return;
    surface.set("gloss", 0.4);
    surface.set("albedo", ink("#c9a58f"));
    surface.set("world_from_model", gl::matrix(Pose{}));
    surface.set("alpha", 0.0);
    skin->draw();
    glDepthFunc(GL_EQUAL);
    surface.set("alpha", 0.6);
    surface.set("rim", 0.35);
    skin->draw();
    surface.set("rim", 0.0);
    glDepthFunc(GL_LESS);
}

/// Draws ghosts on top of everything, because the handle of a finger that presses a body is inside
/// the body.
void SceneView::Parts::draw_ghosts(const frame::Frame& frame) const {
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_FALSE);
    glEnable(GL_CULL_FACE);
    surface.set("gloss", 1.0);
    surface.set("alpha", 0.35);
    for (size_t i = 0; i < fingers.size(); ++i) {
        surface.set("albedo", fingers[i].colour);
        surface.set("world_from_model", gl::matrix(frame::displayed_handle(frame, i)));
        fingers[i].model.draw();
    }
    glDisable(GL_CULL_FACE);
    glDepthMask(GL_TRUE);
}

/// Adds contact points and the forces on fingers.
void SceneView::Parts::add_contacts(Solids& out, const frame::Frame& frame,
                                    const Overlays& overlays) const {
    const auto first_finger = static_cast<int>(bodies.size());
    for (const frame::ContactFrame& contact : frame.contacts) {
        const bool a_finger = contact.a >= first_finger;
        const bool b_finger = contact.b >= first_finger;
        if (overlays.contacts) out.add_ball(ball, contact.p_WC, 0.0018, ink("#ffffff"));
        const double newton = contact.f_B_W.norm();
        if (!overlays.forces || a_finger == b_finger || newton < 0.02) continue;
        const Vec3 f_W = b_finger ? contact.f_B_W : Vec3(-contact.f_B_W);
        out.add(arrow(kArrowPerNewton * newton, 0.0011), along(contact.p_WC, contact.p_WC + f_W),
                ink("#22262e"));
    }
}

/// Draws each solid twice: faintly where bodies hide it, and fully where it is in front of them.
void SceneView::Parts::draw_solids(const Solids& solids) const {
    if (solids.all().empty()) return;
    surface.set("gloss", 0.4);
    const auto draw_all = [&] {
        for (const Solids::Solid& solid : solids.all()) {
            surface.set("albedo", solid.colour);
            surface.set("world_from_model", solid.world_from_model);
            solid.model->draw();
        }
    };
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_GREATER);
    surface.set("alpha", 0.3);
    draw_all();
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    surface.set("alpha", 1.0);
    draw_all();
}

/// Adds a vertical line from each finger to the table, which shows the finger's height and the
/// point below it.
void SceneView::Parts::add_drop_lines(Solids& out, const frame::Frame& frame) const {
    constexpr double kRadius = 4e-4, kFoot = 3e-3;  // [m]
    for (size_t i = 0; i < fingers.size(); ++i) {
        const Vec3 p = frame::displayed_proxy(frame, i).p;
        const Vec3 foot(p.x(), p.y(), table_top);
        if (!p.allFinite() || p.z() - table_top < kFoot) continue;
        const std::array line{p, foot};
        out.add(tube(line, kRadius), {}, fingers[i].colour);
        out.add_ball(ball, foot, kFoot / 2, fingers[i].colour);
    }
}

/// Adds a box that is slightly larger than the body, so that its edges are visible.
void SceneView::Parts::add_picked(Solids& out, const frame::Frame& frame, size_t body) const {
    constexpr double kFree = 0.002, kRadius = 0.0005;  // [m]
    const Thing& thing = bodies[body];
    const double scale = frame::displayed_size(frame, body);
    Pose X_WA = frame::displayed_body(frame, body);
    X_WA.p = X_WA * (scale * (thing.low_B + thing.high_B) / 2);
    const Vec3 size = scale * (thing.high_B - thing.low_B) + Vec3::Constant(2 * kFree);
    add_box(out, X_WA, size, kRadius, ink("#e69f00"));
}

void SceneView::Parts::draw_overlays(const frame::Frame& frame, const Overlays& overlays) const {
    Solids solids;
    if (!overlays.path.empty()) solids.add(tube(overlays.path, 0.0009), {}, ink("#cc3d7a"));
    add_contacts(solids, frame, overlays);
    if (overlays.grip_axis && fingers.size() > 1) add_grip_axis(solids, frame, fingers.size());
    for (const Workspace& workspace : overlays.workspaces)
        add_box(solids, workspace.X_WD, workspace.size, 0.0005, ink("#5b6675"));
    if (overlays.picked) add_picked(solids, frame, *overlays.picked);
    if (overlays.drop_lines) add_drop_lines(solids, frame);
    if (overlays.joints) {
        for (const JointMark& joint : joints) joint.add_to(solids, frame, ball);
    }
    surface.set("shadowed", 0);
    surface.set("grid", 0.0);
    surface.set("fade", 0.0);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    draw_targets(frame);
    draw_solids(solids);
    draw_hand();
    if (overlays.handles) draw_ghosts(frame);
    glDisable(GL_BLEND);
}

}  // namespace dihaptic::view
