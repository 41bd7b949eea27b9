#include "view/thing.h"

#include <algorithm>

#include "view/colours.h"

namespace dihaptic::view {
namespace {

/// Planes, and fixed bodies larger than this, count as ground on which other bodies stand: the grid
/// is drawn on them, and the shadow map is not widened to cover them.
constexpr double kGround = 0.3;  // [m]
bool is_ground(const scene::Body& body) {
    return body.shape.kind == scene::ShapeKind::plane ||
           (body.fixed && scene::extent(body.shape) > kGround);
}

}  // namespace

Thing::Thing(Triangles all, const Pose& X_WB, const Vec3& tone)
    : colour(tone), own_colours(!all.colours.empty()) {
    for (Eigen::Vector3f& own : all.colours) {
        if (!own.allFinite()) own = tone.cast<float>();
    }
    for (const Vertex& v : all.vertices) {
        const Vec3 p_B = v.p.cast<double>();
        radius = std::max(radius, p_B.norm());
        lowest = std::min(lowest, (X_WB * p_B).z());
        low_B = low_B.cwiseMin(p_B);
        high_B = high_B.cwiseMax(p_B);
        highest = std::max(highest, (X_WB * p_B).z());
    }
    model = gl::Model(all);
}

bool Thing::has_looks(const Vec3* tint) const {
    return metal || (tint == nullptr && (own_colours || picture != 0));
}

void Thing::set(const gl::Program& program, const Vec3* tint) const {
    program.set("albedo", tint != nullptr ? *tint : colour);
    program.set("gloss", gloss);
    program.set("grid", grid);
    program.set("fade", fade);
    if (!has_looks(tint)) return;
    program.set("metal", metal ? 1 : 0);
    program.set("coloured", own_colours && tint == nullptr ? 1 : 0);
    program.set("pictured", picture != 0 && tint == nullptr ? 1 : 0);
    program.set("picture_size", picture_size);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, picture);
    glActiveTexture(GL_TEXTURE0);
}

Thing thing_of(const scene::Scene& scene, size_t body, GLuint picture) {
    const scene::Body& of = scene.bodies[body];
    Thing out(triangles(of, kPlaneSize), of.pose(), body_colour(scene, body));
    out.ground = is_ground(of);
    out.gloss = of.finish == scene::Finish::matt ? 0 : out.ground ? 0.25 : 1;
    out.grid = out.ground && picture == 0 ? 0.28 : 0;
    out.fade = of.shape.kind == scene::ShapeKind::plane ? 1.2 : 0;
    out.metal = of.finish == scene::Finish::metal;
    out.picture = picture;
    if (picture != 0)
        out.picture_size =
            of.picture->width * Eigen::Vector2d(1, static_cast<double>(of.picture->image->height) /
                                                       of.picture->image->width);
    return out;
}

}  // namespace dihaptic::view
