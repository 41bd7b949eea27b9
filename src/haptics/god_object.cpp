#include "haptics/god_object.h"

#include <algorithm>
#include <cmath>

namespace dihaptic::haptics {
namespace {

/// A point this near to a surface is on it, after solvers as well [m].
constexpr double kTouching = 1e-6;
/// A way that need not be gone [m].
constexpr double kNoWay = 1e-10;
/// Moves in a tick. A few are usual, some dozens where a round body is pressed nearly to its
/// middle; what is left of the way is gone in the next tick.
constexpr int kMostMoves = 64;

}  // namespace

GodObject::GodObject(std::span<const scene::Body> bodies, std::vector<double> friction,
                     double sliding, double skin)
    : friction_(std::move(friction)), sliding_ratio_(sliding) {
    for (const scene::Body& body : bodies) surfaces_.emplace_back(body.shape, skin);
    X_WB_.resize(bodies.size());
    inside_.resize(bodies.size(), 0);
    near_.reserve(bodies.size());
    coming_.resize(bodies.size());
}

void GodObject::place(const Vec3& p_W, std::span<const dynamics::BodyState> bodies) noexcept {
    p_ = p_W;
    held_.setZero();
    count_ = 0;
    sliding_ = false;
    for (size_t i = 0; i < surfaces_.size(); ++i) {
        X_WB_[i] = bodies[i].X_WB;
        inside_[i] = surfaces_[i].separation(in_body(i, p_)) < -kOnSurface;
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

void GodObject::leave_insides() noexcept {
    for (size_t i = 0; i < surfaces_.size(); ++i) {
        if (inside_[i] && surfaces_[i].separation(in_body(i, p_)) > 0) inside_[i] = 0;
    }
}

std::span<const Obstacle> GodObject::obstacles(const Vec3& p_W,
                                               std::span<const dynamics::BodyState> bodies,
                                               double h) noexcept {
    met_count_ = 0;
    for (size_t i = 0; i < surfaces_.size(); ++i) {
        coming_[i].X_WB = bodies[i].X_WB;
        if (bodies[i].awake) {
            Pose& X_WB = coming_[i].X_WB;
            X_WB.p += h * bodies[i].v_WB;
            const double angle = h * bodies[i].w_WB.norm();
            if (angle > 0) {
                X_WB.R = Quat(Eigen::AngleAxisd(angle, bodies[i].w_WB.normalized())) * X_WB.R;
            }
        }
        if (inside_[i]) continue;
        const Vec3 p_B = in_body(i, p_);
        if (p_B.norm() - kTouching > surfaces_[i].reach()) continue;
        if (surfaces_[i].separation(p_B) <= kTouching) note(i, surfaces_[i].shallowest(p_B));
    }
    // the rest is found by going there, and coming back
    const Vec3 p = p_;
    push_out(p, coming_);
    count_ = 0;
    pull(p_W, false);
    p_ = p;
    count_ = 0;
    for (size_t i = 0; i < surfaces_.size(); ++i) X_WB_[i] = bodies[i].X_WB;
    size_t kept = 0;
    for (size_t i = 0; i < met_count_; ++i) {
        Obstacle out = met_[i];
        const Vec3 p_B = in_body(out.body, p_);
        out.n_W = X_WB_[out.body].R * surfaces_[out.body].normal(out.face, p_B);
        out.gap = surfaces_[out.body].distance(out.face, p_B);
        // behind it, the face is met on a way around: later
        if (out.gap >= -kTouching) met_[kept++] = out;
    }
    met_count_ = kept;
    return {met_.data(), met_count_};
}

void GodObject::move(const Vec3& p_W, std::span<const dynamics::BodyState> bodies) noexcept {
    const Vec3 start = p_;
    p_ = p_W;
    count_ = 0;
    push_out(start, bodies);
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

void GodObject::note(size_t body, int face) noexcept {
    if (met_count_ == met_.size()) return;
    for (size_t i = 0; i < met_count_; ++i) {
        if (met_[i].body == body) return;
    }
    met_[met_count_++] = {body, face, Vec3::UnitZ(), 0};
}

Vec3 GodObject::in_body(size_t body, const Vec3& p_W) const noexcept {
    return X_WB_[body].R.conjugate() * (p_W - X_WB_[body].p);
}

Vec3 GodObject::carried(std::span<const dynamics::BodyState> bodies) const noexcept {
    Vec3 sum = Vec3::Zero();
    double weight = 0;
    for (const PointContact& c : contacts()) {
        // without friction a body takes nothing along; what it pushes away comes next
        const double w = friction_[c.body] * c.depth;
        sum += w * (bodies[c.body].X_WB * in_body(c.body, p_) - p_);
        weight += w;
    }
    return weight > 0 ? Vec3(p_ + sum / weight) : p_;
}

/// X_WB_ goes from the last tick's poses to this one's.
void GodObject::push_out(const Vec3& start, std::span<const dynamics::BodyState> bodies) noexcept {
    const Vec3 carried_to = p_;
    HalfSpaces walls;
    std::array<size_t, kMostHalfSpaces> body_of{};
    // a body whose face the point already obeys cannot be entered again: each adds one at most
    for (bool found = true; found && walls.count < kMostHalfSpaces;) {
        found = false;
        for (size_t i = 0; i < surfaces_.size() && walls.count < kMostHalfSpaces; ++i) {
            if (inside_[i]) continue;
            const auto end = body_of.begin() + static_cast<std::ptrdiff_t>(walls.count);
            if (std::find(body_of.begin(), end, i) != end) continue;
            const Pose& X_WB = bodies[i].X_WB;
            const Vec3 before = in_body(i, start);
            const Vec3 after = X_WB.R.conjugate() * (p_ - X_WB.p);
            const Vec3 path = after - before;
            const Surface& surface = surfaces_[i];
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
            // the tangent plane at the entry, seen from where the point was carried
            const double below = surface.distance(face, at) + n.dot(after - at);
            const Vec3 n_W = X_WB.R * n;
            walls.add(n_W, -below + n_W.dot(p_ - carried_to));
            body_of[walls.count - 1] = i;
            note(i, face);
            found = true;
            p_ = carried_to + walls.nearest(Vec3::Zero());
        }
    }
    for (size_t i = 0; i < surfaces_.size(); ++i) X_WB_[i] = bodies[i].X_WB;
}

/// No path goes further from the handle than it starts: bodies beyond play no part.
void GodObject::gather(const Vec3& p_WH) noexcept {
    near_.clear();
    const double radius = (p_WH - p_).norm() + kOnSurface;
    for (size_t i = 0; i < surfaces_.size(); ++i) {
        if (inside_[i]) continue;
        if ((X_WB_[i].p - p_WH).norm() <= surfaces_[i].reach() + radius) near_.push_back(i);
    }
}

bool GodObject::touch(size_t body, int face) noexcept {
    if (count_ == contacts_.size()) return false;
    contacts_[count_++] = {body, face, Vec3::UnitZ(), 0};
    note(body, face);
    return true;
}

void GodObject::untouch(size_t i) noexcept {
    contacts_[i] = contacts_[--count_];
}

void GodObject::refresh_normals() noexcept {
    for (size_t i = 0; i < count_; ++i) {
        PointContact& c = contacts_[i];
        c.n_W = X_WB_[c.body].R * surfaces_[c.body].normal(c.face, in_body(c.body, p_));
    }
}

/// The way toward the handle that no contact forbids; what each of them forbids is its depth.
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
    for (const PointContact& c : contacts()) sum += friction_[c.body] * c.depth;
    return sum;
}

/// Along a round face of radius r, with the handle at depth l, the nearest place is further by
/// 1 / (1 - l / r) than the tangent says: Newton's step for the distance. At most twice as far,
/// since beyond a path could lead away from the handle.
Vec3 GodObject::straightened(const Vec3& way) const noexcept {
    if (count_ != 1) return way;
    const PointContact& c = contacts_[0];
    const Surface& surface = surfaces_[c.body];
    const Quat& R_WB = X_WB_[c.body].R;
    const Vec3 bent = R_WB * surface.bent_part(c.face, in_body(c.body, p_), R_WB.conjugate() * way);
    if (bent.isZero(0)) return way;
    const double rest = std::max(0.5, 1 - c.depth / surface.bend_radius());
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
        // it starts to slide beyond static friction, and goes on as far as dynamic friction lets it
        const double rest = (sliding_ ? sliding_ratio_ : 1.0) * grip;
        // out of moves, it still has to come down on what it was lifted off
        const bool tired = move >= kMostMoves && (count_ > 0 || move >= kMostMoves + 8);
        if (size <= rest + kNoWay || tired) break;
        Vec3 way = left;
        if (grip > 0) {
            slides = sliding_ = true;
            way *= 1 - sliding_ratio_ * grip / size;
        }
        way = straightened(way);

        // to the first body in the way, or to the first edge of a face that the way lies in
        double share = 1;
        std::optional<PointContact> meets;
        std::optional<PointContact> crosses;
        for (const size_t i : near_) {
            const auto rests = contacts();
            if (std::any_of(rests.begin(), rests.end(),
                            [&](const PointContact& c) { return c.body == i; }))
                continue;
            const auto entry = surfaces_[i].enter(in_body(i, p_), X_WB_[i].R.conjugate() * way);
            if (!entry || (meets && entry->share >= share)) continue;
            share = entry->share;
            meets = PointContact{i, entry->face, Vec3::UnitZ(), 0};
        }
        for (size_t i = 0; i < count_; ++i) {
            const PointContact& c = contacts_[i];
            if (c.depth <= 0) continue;  // it does not guide the way
            const auto crossing = surfaces_[c.body].cross(c.face, in_body(c.body, p_),
                                                          X_WB_[c.body].R.conjugate() * way);
            if (crossing.face < 0 || crossing.share > share) continue;
            share = crossing.share;
            crosses = PointContact{c.body, crossing.face, Vec3::UnitZ(), 0};
            meets.reset();
        }
        p_ += share * way;
        if (share > 0) {
            for (size_t i = count_; i-- > 0;) {
                const PointContact& c = contacts_[i];
                const bool crossed = crosses && crosses->body == c.body;
                const double apart = surfaces_[c.body].separation(in_body(c.body, p_));
                if (!crossed && (c.depth <= 0 || apart > kOnSurface)) untouch(i);
            }
        }
        if (crosses) {
            // past the edge: over the next face, unless the handle is outside of it
            const auto c = std::find_if(
                contacts_.begin(), contacts_.begin() + static_cast<std::ptrdiff_t>(count_),
                [&](const PointContact& x) { return x.body == crosses->body; });
            c->face = crosses->face;
            const Vec3 n_W =
                X_WB_[c->body].R * surfaces_[c->body].normal(c->face, in_body(c->body, p_));
            if (n_W.dot(p_WH - p_) >= 0) untouch(static_cast<size_t>(c - contacts_.begin()));
        }
        if (meets && !touch(meets->body, meets->face)) break;
    }
    if (!slides) sliding_ = false;
    for (size_t i = count_; i-- > 0;) {
        if (contacts_[i].depth <= 0) untouch(i);
    }
}

}  // namespace dihaptic::haptics
