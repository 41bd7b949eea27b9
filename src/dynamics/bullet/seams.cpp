#include "dynamics/bullet/seams.h"

#include <algorithm>

namespace dihaptic::dynamics {
namespace {

/// A part contains the points within this distance of its surface [m].
constexpr double kOnPart = 1e-6;
/// Margin for rounding: a part is nearer than a point only if it is nearer by more than this [m].
constexpr double kNearer = 1e-8;
/// Normals whose dot product exceeds this are the same; points with the same normal have the same
/// effect and do not conflict.
constexpr double kSameNormal = 1 - 1e-8;

bool has(const CollisionPart& part, const btVector3& p_W) {
    if (!part.polyhedron) return false;
    const Vec3 p_S = from_bullet(part.X_WS().inverse() * p_W);
    return std::all_of(
        part.polyhedron->faces.begin(), part.polyhedron->faces.end(),
        [&](const Polyhedron::Face& face) { return face.normal.dot(p_S) < face.offset + kOnPart; });
}

double nearest(const btPersistentManifold& manifold) {
    double out = manifold.getContactPoint(0).getDistance();
    for (int i = 1; i < manifold.getNumContacts(); ++i)
        out = std::min<double>(out, manifold.getContactPoint(i).getDistance());
    return out;
}

/// Whether the parts of the other manifold, one of which is shared with this one, are nearer and
/// contain the point.
bool is_inner(const btManifoldPoint& point, const OfParts& of, const OfParts& other) {
    const bool same_0 = of.part_0 == other.part_0;
    const bool same_1 = of.part_1 == other.part_1;
    if (same_0 == same_1) return false;
    const btManifoldPoint& first = other.manifold->getContactPoint(0);
    if (point.m_normalWorldOnB.dot(first.m_normalWorldOnB) > kSameNormal) return false;
    if (other.nearest > point.getDistance() - kNearer) return false;
    return same_1 ? has(*other.part_0, point.getPositionWorldOnA())
                  : has(*other.part_1, point.getPositionWorldOnB());
}

}  // namespace

void remove_inner_contacts(std::span<OfParts> of_two_bodies) noexcept {
    // judge all points before removing any, because an inner point may reveal another one
    for (OfParts& of : of_two_bodies) of.nearest = nearest(*of.manifold);
    for (OfParts& of : of_two_bodies) {
        for (int i = 0; i < of.manifold->getNumContacts(); ++i) {
            of.is_inner[static_cast<size_t>(i)] =
                std::any_of(of_two_bodies.begin(), of_two_bodies.end(), [&](const OfParts& other) {
                    return is_inner(of.manifold->getContactPoint(i), of, other);
                });
        }
    }
    for (const OfParts& of : of_two_bodies) {
        for (int i = of.manifold->getNumContacts() - 1; i >= 0; --i) {
            if (of.is_inner[static_cast<size_t>(i)]) of.manifold->removeContactPoint(i);
        }
    }
}

}  // namespace dihaptic::dynamics
