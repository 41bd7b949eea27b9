#include "haptics/god_object.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::haptics {
namespace {

/// A point is on a surface if it is at least this near to it; larger than the errors of solvers
/// [m].
constexpr double kTouching = 1e-6;
/// Maximum distance, relative to the point's depth in surfaces, by which a step may move the point
/// out of them. A point moved farther would slip out between two bodies that pinch it.
constexpr double kMostSlip = 10;
/// Paths shorter than this are ignored [m].
constexpr double kNoWay = 1e-10;
/// Maximum number of moves in a tick. A few moves are usual, and a few dozen if a round body is
/// pressed nearly to its centre; the rest of the path follows in the next tick.
constexpr int kMostMoves = 64;

}  // namespace

GodObject::GodObject(std::span<const scene::Body> bodies, std::vector<double> friction,
                     double sliding, double skin)
    : friction_(std::move(friction)), sliding_ratio_(sliding) {
    for (size_t i = 0; i < bodies.size(); ++i) {
        const std::vector<scene::ConvexPart> convex = scene::convex_parts(bodies[i].shape);
        for (const scene::ConvexPart& part : convex) {
            parts_.push_back({i, part.X_BS, Surface(part.shape, skin, convex.size() > 1)});
        }
    }
    X_WS_.resize(parts_.size());
    inside_.resize(bodies.size(), 0);
    near_.reserve(parts_.size());
    coming_.resize(bodies.size());
}

void GodObject::place(const Vec3& p_W, std::span<const dynamics::BodyState> bodies) noexcept {
    p_ = p_W;
    held_.setZero();
    count_ = 0;
    sliding_ = false;
    std::fill(inside_.begin(), inside_.end(), 0);
    for (size_t i = 0; i < parts_.size(); ++i) {
        X_WS_[i] = pose(i, bodies);
        if (parts_[i].surface.separation(in_surface(i, p_)) < -kOnSurface)
            inside_[parts_[i].body] = 1;
    }
}

void GodObject::follow(const Vec3& p_WH, std::span<const dynamics::BodyState> bodies) noexcept {
    const Vec3 start = p_;
    p_ = carried(bodies);
    push_out(start, bodies);
    count_ = 0;
    pull(p_WH, true);
    leave_insides();
}

/// Notes which bodies the point has left, i.e. is outside all their parts.
void GodObject::leave_insides() noexcept {
    for (size_t i = 0; i < parts_.size();) {
        const size_t body = parts_[i].body;
        bool left = true;
        for (; i < parts_.size() && parts_[i].body == body; ++i) {
            left = left && (!inside_[body] || parts_[i].surface.separation(in_surface(i, p_)) > 0);
        }
        if (left) inside_[body] = 0;
    }
}

std::span<const Obstacle> GodObject::obstacles(const Vec3& p_W,
                                               std::span<const dynamics::BodyState> bodies,
                                               double h) noexcept {
    met_count_ = 0;
    for (size_t i = 0; i < bodies.size() && i < coming_.size(); ++i) {
        coming_[i].X_WB = bodies[i].X_WB;
        if (!bodies[i].awake) continue;
        Pose& X_WB = coming_[i].X_WB;
        X_WB.p += h * bodies[i].v_WB;
        const double angle = h * bodies[i].w_WB.norm();
        if (angle > 0)
            X_WB.R = Quat(Eigen::AngleAxisd(angle, bodies[i].w_WB.normalized())) * X_WB.R;
    }
    for (size_t i = 0; i < parts_.size(); ++i) {
        if (inside_[parts_[i].body]) continue;
        const Surface& surface = parts_[i].surface;
        const Vec3 p_S = in_surface(i, p_);
        if (p_S.norm() - kTouching > surface.reach()) continue;
        if (surface.separation(p_S) <= kTouching) note(i, surface.shallowest(p_S));
    }
    const size_t on = met_count_;
    // find the other obstacles by moving the point to p_W and back
    const Vec3 p = p_;
    push_out(p, coming_);
    count_ = 0;
    pull(p_W, false);
    p_ = p;
    count_ = 0;
    for (size_t i = 0; i < parts_.size(); ++i) X_WS_[i] = pose(i, bodies);
    size_t kept = 0;
    for (size_t i = 0; i < met_count_; ++i) {
        Obstacle out = met_[i];
        const Surface& surface = parts_[out.surface].surface;
        const Vec3 p_S = in_surface(out.surface, p_);
        out.n_W = X_WS_[out.surface].R * surface.normal(out.face, p_S);
        out.gap = surface.distance(out.face, p_S);
        // a point behind a face but not on it meets the face later, on a path around the body
        if (i < on || out.gap >= -kTouching) met_[kept++] = out;
    }
    met_count_ = kept;
    return {met_.data(), met_count_};
}

void GodObject::move(const Vec3& p_W, std::span<const dynamics::BodyState> bodies) noexcept {
    const Vec3 start = p_;
    p_ = p_W;
    count_ = 0;
    const double depth = push_out(start, bodies);
    if ((p_ - p_W).norm() > kMostSlip * depth) p_ = p_W;
    leave_insides();
}

void GodObject::pop_through(size_t body, const Vec3& p_WH) noexcept {
    inside_[body] = 1;
    slide(p_WH);
}

void GodObject::slide(const Vec3& p_WH) noexcept {
    count_ = 0;
    pull(p_WH, false);
    leave_insides();
}

void GodObject::note(size_t surface, int face) noexcept {
    if (met_count_ == met_.size()) return;
    for (size_t i = 0; i < met_count_; ++i) {
        if (met_[i].surface == surface) return;
    }
    met_[met_count_++] = {parts_[surface].body, surface, face, Vec3::UnitZ(), 0};
}

Vec3 GodObject::position_in(size_t body) const noexcept {
    size_t i = 0;
    while (parts_[i].body != body) ++i;
    return parts_[i].X_BS * in_surface(i, p_);
}

Vec3 GodObject::in_surface(size_t surface, const Vec3& p_W) const noexcept {
    return X_WS_[surface].R.conjugate() * (p_W - X_WS_[surface].p);
}

Pose GodObject::pose(size_t surface, std::span<const dynamics::BodyState> bodies) const noexcept {
    return bodies[parts_[surface].body].X_WB * parts_[surface].X_BS;
}

Vec3 GodObject::carried(std::span<const dynamics::BodyState> bodies) const noexcept {
    Vec3 sum = Vec3::Zero();
    double weight = 0;
    for (const PointContact& c : contacts()) {
        // without friction, a body does not carry the point along; it may still push the point,
        // which is done next
        const double w = friction(c.body) * c.depth;
        sum += w * (pose(c.surface, bodies) * in_surface(c.surface, p_) - p_);
        weight += w;
    }
    return weight > 0 ? Vec3(p_ + sum / weight) : p_;
}

/// Moves the surfaces from their poses in the last tick to those in this tick, and moves the point
/// out of them. Returns the depth of the point in the bodies that pushed it [m].
double GodObject::push_out(const Vec3& start,
                           std::span<const dynamics::BodyState> bodies) noexcept {
    const Vec3 carried_to = p_;
    HalfSpaces walls;
    std::array<size_t, kMostHalfSpaces> surface_of{};
    // a surface with an active face cannot be entered again, so each surface adds at most one
    // constraint
    for (bool found = true; found && walls.count < kMostHalfSpaces;) {
        found = false;
        for (size_t i = 0; i < parts_.size() && walls.count < kMostHalfSpaces; ++i) {
            if (inside_[parts_[i].body]) continue;
            const auto end = surface_of.begin() + static_cast<std::ptrdiff_t>(walls.count);
            if (std::find(surface_of.begin(), end, i) != end) continue;
            const Pose X_WS = pose(i, bodies);
            const Vec3 before = in_surface(i, start);
            const Vec3 after = X_WS.R.conjugate() * (p_ - X_WS.p);
            const Vec3 path = after - before;
            const Surface& surface = parts_[i].surface;
            if (after.norm() - path.norm() > surface.reach()) continue;
            int face = -1;
            Vec3 at = after;
            if (const auto entry = surface.enter(before, path)) {
                face = entry->face;
                at = before + entry->share * path;
            } else if (surface.separation(after) < 0) {
                face = surface.shallowest(after);
            }
            if (face < 0) continue;
            const Vec3 n = surface.normal(face, at);
            // signed distance of the point from the tangent plane at the entry
            const double below = surface.distance(face, at) + n.dot(after - at);
            const Vec3 n_W = X_WS.R * n;
            walls.add(n_W, -below + n_W.dot(p_ - carried_to));
            surface_of[walls.count - 1] = i;
            note(i, face);
            found = true;
            p_ = carried_to + walls.nearest(Vec3::Zero());
        }
    }
    for (size_t i = 0; i < parts_.size(); ++i) X_WS_[i] = pose(i, bodies);
    const auto bounds = walls.b.begin();
    return walls.count == 0
               ? 0
               : *std::max_element(bounds, bounds + static_cast<std::ptrdiff_t>(walls.count));
}

/// Collects the surfaces within reach, i.e. no farther from the handle than the point is: no path
/// takes the point farther away.
void GodObject::gather(const Vec3& p_WH) noexcept {
    near_.clear();
    const double radius = (p_WH - p_).norm() + kOnSurface;
    for (size_t i = 0; i < parts_.size(); ++i) {
        if (inside_[parts_[i].body]) continue;
        if ((X_WS_[i].p - p_WH).norm() <= parts_[i].surface.reach() + radius) near_.push_back(i);
    }
}

bool GodObject::touch(const PointContact& contact) noexcept {
    if (count_ == contacts_.size()) return false;
    contacts_[count_++] = contact;
    note(contact.surface, contact.face);
    return true;
}

void GodObject::untouch(size_t i) noexcept {
    contacts_[i] = contacts_[--count_];
}

void GodObject::refresh_normals() noexcept {
    for (size_t i = 0; i < count_; ++i) {
        PointContact& c = contacts_[i];
        c.n_W = X_WS_[c.surface].R *
                parts_[c.surface].surface.normal(c.face, in_surface(c.surface, p_));
    }
}

/// Returns the part of the path towards the handle that the contacts do not block, and sets each
/// contact's depth to the part that it blocks.
Vec3 GodObject::way_to(const Vec3& p_WH) noexcept {
    refresh_normals();
    HalfSpaces walls;
    for (const PointContact& c : contacts()) walls.add(c.n_W);
    Vec3 way = walls.nearest(p_WH - p_);
    for (size_t i = 0; i < count_; ++i) contacts_[i].depth = walls.multiplier[i];
    return way;
}

double GodObject::friction_depth() const noexcept {
    double sum = 0;
    for (const PointContact& c : contacts()) sum += friction(c.body) * c.depth;
    return sum;
}

/// Corrects a path for curvature. Along a round face of radius r, with the handle at depth l, the
/// nearest position is farther away than along the tangent by a factor of 1 / (1 - l / r), as in
/// Newton's step for the distance. The factor is limited to two, beyond which a path could lead
/// away from the handle.
Vec3 GodObject::straightened(const Vec3& way) const noexcept {
    if (count_ != 1) return way;
    const PointContact& c = contacts_[0];
    const Surface& surface = parts_[c.surface].surface;
    const Quat& R_WS = X_WS_[c.surface].R;
    const Vec3 p_S = in_surface(c.surface, p_);
    const Vec3 bent = R_WS * surface.bent_part(c.face, p_S, R_WS.conjugate() * way);
    if (bent.isZero(0)) return way;
    const double rest = std::max(0.5, 1 - c.depth / surface.bend_radius(p_S));
    return way + (1 / rest - 1) * bent;
}

void GodObject::pull(const Vec3& p_WH, bool rubs) noexcept {
    gather(p_WH);
    bool slides = false;
    for (int move = 0;; ++move) {
        const Vec3 left = way_to(p_WH);
        held_ = left;
        const double size = left.norm();
        const double grip = rubs ? friction_depth() : 0;
        // sliding starts beyond static friction, and ends where dynamic friction holds the point
        const double rest = (sliding_ ? sliding_ratio_ : 1.0) * grip;
        // after the last move, the point still has to return to the surface below
        const bool tired = move >= kMostMoves && (count_ > 0 || move >= kMostMoves + 8);
        if (size <= rest + kNoWay || tired) break;
        Vec3 way = left;
        if (grip > 0) {
            slides = sliding_ = true;
            way *= 1 - sliding_ratio_ * grip / size;
        }
        way = straightened(way);
        const Event event = first_event(way);
        p_ += event.share * way;
        if (event.share > 0) leave_behind(event);
        if (event.crosses) go_past_edge(*event.crosses, p_WH);
        if (event.meets && !touch(*event.meets)) break;
    }
    if (!slides) sliding_ = false;
    leave_unpressed();
}

void GodObject::leave_unpressed() noexcept {
    for (size_t i = count_; i-- > 0;) {
        if (contacts_[i].depth <= 0) untouch(i);
    }
}

/// Finds the first body in the path, or the first edge of the face along which the path leads.
GodObject::Event GodObject::first_event(const Vec3& way) const noexcept {
    Event out;
    for (const size_t i : near_) {
        const auto rests = contacts();
        if (std::any_of(rests.begin(), rests.end(),
                        [&](const PointContact& c) { return c.surface == i; }))
            continue;
        const auto entry = parts_[i].surface.enter(in_surface(i, p_), X_WS_[i].R.conjugate() * way);
        if (!entry || (out.meets && entry->share >= out.share)) continue;
        out.share = entry->share;
        out.meets = PointContact{parts_[i].body, i, entry->face, Vec3::UnitZ(), 0};
    }
    for (size_t i = 0; i < count_; ++i) {
        const PointContact& c = contacts_[i];
        if (c.depth <= 0) continue;  // a contact without depth does not guide the path
        const auto crossing = parts_[c.surface].surface.cross(c.face, in_surface(c.surface, p_),
                                                              X_WS_[c.surface].R.conjugate() * way);
        if (crossing.face < 0 || crossing.share > out.share) continue;
        out.share = crossing.share;
        out.crosses = PointContact{c.body, c.surface, crossing.face, Vec3::UnitZ(), 0};
        out.meets.reset();
    }
    return out;
}

/// Drops contacts that do not hold the point, or that the point has left with this move.
void GodObject::leave_behind(const Event& event) noexcept {
    for (size_t i = count_; i-- > 0;) {
        const PointContact& c = contacts_[i];
        const bool crossed = event.crosses && event.crosses->surface == c.surface;
        const double apart = parts_[c.surface].surface.separation(in_surface(c.surface, p_));
        if (!crossed && (c.depth <= 0 || apart > kOnSurface)) untouch(i);
    }
}

/// Continues a contact on the next face, unless the handle is outside that face.
void GodObject::go_past_edge(const PointContact& next, const Vec3& p_WH) noexcept {
    const auto c =
        std::find_if(contacts_.begin(), contacts_.begin() + static_cast<std::ptrdiff_t>(count_),
                     [&](const PointContact& x) { return x.surface == next.surface; });
    c->face = next.face;
    const Vec3 n_W = X_WS_[c->surface].R *
                     parts_[c->surface].surface.normal(c->face, in_surface(c->surface, p_));
    if (n_W.dot(p_WH - p_) >= 0) untouch(static_cast<size_t>(c - contacts_.begin()));
}

}  // namespace dihaptic::haptics
