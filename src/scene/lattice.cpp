#include "scene/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/geometry.h"
#include "scene/colour.h"
#include "scene/scene.h"

namespace dihaptic::scene {
namespace {

/// Largest number of blocks; a scene with more blocks could not be simulated in real time.
constexpr int kMostParts = 200;

/// Saint-Venant's torsion constant of a rectangle (Roark and Young 1975, accurate to 0.1 %) [m^4].
double torsion_constant(double side, double other) {
    const auto [shorter, longer] = std::minmax(side, other);
    const double r = shorter / longer;
    return longer * std::pow(shorter, 3) * (1.0 / 3 - 0.21 * r * (1 - std::pow(r, 4) / 12));
}

/// Builds the bodies and joints of a lattice.
class Builder {
  public:
    Builder(const Lattice& lattice, Scene& scene)
        : lattice_(lattice),
          scene_(scene),
          X_WL_{rotation_xyz(lattice.rotation), lattice.position},
          block_(lattice.size.cwiseQuotient(lattice.parts)) {
        for (int a = 0; a < 3; ++a) count_[a] = static_cast<int>(lattice.parts[a]);
        rod_ = (count_[0] > 1) + (count_[1] > 1) + (count_[2] > 1) <= 1;
    }

    void build() {
        const int all = count_.prod();
        for_each([&](const Index& i) { add_block(i, all); });
        for_each([&](const Index& i) {
            for (int a = 0; a < 3; ++a) {
                Index next = i;
                if (++next[a] < count_[a])
                    add_link(i, a, 0.5, block_[a], {name(i), name(next)}, "_to_" + suffix(next));
            }
        });
        for (const Glued& glued : lattice_.glued) glue(glued);
    }

  private:
    using Index = Eigen::Vector3i;

    template <class Act>
    void for_each(const Act& act) const {
        Index i;
        for (i[0] = 0; i[0] < count_[0]; ++i[0])
            for (i[1] = 0; i[1] < count_[1]; ++i[1])
                for (i[2] = 0; i[2] < count_[2]; ++i[2]) act(i);
    }
    std::string suffix(const Index& i) const {
        return rod_ ? fmt::format("{}", i.maxCoeff() + 1)
                    : fmt::format("{}_{}_{}", i[0] + 1, i[1] + 1, i[2] + 1);
    }
    std::string name(const Index& i) const { return lattice_.name + "_" + suffix(i); }
    /// Centre of a block, in the axes of the lattice [m].
    Vec3 centre(const Index& i) const {
        return block_.cwiseProduct(i.cast<double>() + Vec3::Constant(0.5)) - lattice_.size / 2;
    }

    void add_block(const Index& i, int all) {
        Body body;
        body.name = name(i);
        body.shape = Shape::box(block_);
        if (lattice_.mass) body.mass = *lattice_.mass / all;
        body.density = lattice_.density;
        body.weighed = true;
        body.position = X_WL_ * centre(i);
        body.rotation = lattice_.rotation;
        body.friction = lattice_.friction;
        // when something presses on a face from outside, the half block below the face also yields
        double stiffness = 1;
        for (int a = 0; a < 3; ++a)
            stiffness *= 2 * lattice_.young * block_.prod() / (block_[a] * block_[a]);
        body.surface.stiffness = std::clamp(std::cbrt(stiffness), kSoftest, kHardest);
        body.surface.damping = std::min(1000.0, lattice_.retardation * *body.surface.stiffness);
        body.group = lattice_.name;
        body.colour = lattice_.colour;
        body.place = lattice_.place;
        scene_.bodies.push_back(body);
    }

    /// Adds a link across the face of a block along axis a. The link is `at` block lengths beyond
    /// the block's centre, between points that are `length` apart.
    void add_link(const Index& i, int a, double at, double length, std::vector<std::string> between,
                  const std::string& what) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        const double E = lattice_.young;
        const double G = lattice_.shear.value_or(E / 2);
        const double area = block_[b] * block_[c];
        Joint joint;
        joint.name = name(i) + what;
        joint.kind = JointKind::bushing;
        joint.between = std::move(between);
        joint.position = X_WL_ * Vec3(centre(i) + at * block_[a] * Vec3::Unit(a));
        joint.rotation = lattice_.rotation;
        joint.stiffnesses[a] = E * area / length;
        joint.stiffnesses[b] = joint.stiffnesses[c] = G * area / length;
        joint.turn_stiffnesses[a] = G * torsion_constant(block_[b], block_[c]) / length;
        joint.turn_stiffnesses[b] = E * area * block_[c] * block_[c] / 12 / length;
        joint.turn_stiffnesses[c] = E * area * block_[b] * block_[b] / 12 / length;
        joint.dampings = lattice_.retardation * joint.stiffnesses;
        joint.turn_dampings = lattice_.retardation * joint.turn_stiffnesses;
        joint.recorded = false;
        joint.place = lattice_.place;
        scene_.joints.push_back(joint);
    }

    void glue(const Glued& glued) {
        const int a = static_cast<int>(glued.side) / 2;
        const bool high = static_cast<int>(glued.side) % 2 == 1;
        for_each([&](const Index& i) {
            if (i[a] != (high ? count_[a] - 1 : 0)) return;
            std::vector<std::string> between{name(i)};
            if (!glued.to.empty()) between.insert(between.begin(), glued.to);
            add_link(i, a, high ? 0.5 : -0.5, block_[a] / 2, between,
                     fmt::format("_glued_{}", enum_name(glued.side)));
        });
    }

    const Lattice& lattice_;
    Scene& scene_;
    Pose X_WL_;
    Vec3 block_;  // size of one block [m]
    Index count_;
    bool rod_;
};

bool is_sound(const Lattice& lattice, const Scene& scene, Diagnostics& diagnostics) {
    bool sound = true;
    const auto error = [&](const Place& place, const char* key, const std::string& problem,
                           const std::string& remedy) {
        diagnostics.error(place, key, problem, remedy);
        sound = false;
    };
    if (!(lattice.size.minCoeff() > 0))
        error(lattice.place, "size", "has no extent along an axis", "Give three lengths above 0.");
    if ((lattice.parts.array() != lattice.parts.array().round()).any())
        error(lattice.place, "parts", "is not a whole number", "Write e.g. parts: [3, 2, 2].");
    if (lattice.parts.prod() > kMostParts)
        error(lattice.place, "parts",
              fmt::format("makes {:.0f} blocks, more than {}", lattice.parts.prod(), kMostParts),
              "Use fewer: a tick has to solve them all.");
    if (lattice.mass.has_value() == lattice.density.has_value())
        error(lattice.place, "mass",
              lattice.mass ? "is given in addition to a density" : "is missing",
              "Give mass_g or density_kg_m3.");
    if (!lattice.colour.empty() && read_colour(lattice.colour, lattice.place, diagnostics) < 0)
        sound = false;
    for (const Glued& glued : lattice.glued) {
        if (glued.to.empty() || scene.find(glued.to) >= 0) continue;
        report_unknown_body(glued.to, scene, glued.place, "to", diagnostics);
        sound = false;
    }
    return sound;
}

}  // namespace

void expand_lattices(Scene& scene, Diagnostics& diagnostics) {
    for (const Lattice& lattice : std::exchange(scene.lattices, {})) {
        if (is_sound(lattice, scene, diagnostics)) Builder(lattice, scene).build();
    }
}

}  // namespace dihaptic::scene
