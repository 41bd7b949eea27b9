#include "scene/solid.h"

namespace dihaptic::scene {

Solid solid_of(const Shape& shape, double mass) {
    Solid out;
    out.mass = mass;
    const VolumeIntegrals unit = integrate(shape);
    if (mass <= 0 || unit.volume <= 0) return out;
    const double density = mass / unit.volume;
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(density * unit.inertia);
    out.X_BM.p = unit.centre;
    if (unit.inertia.isDiagonal(1e-9)) {
        out.inertia = density * unit.inertia.diagonal();
    } else {
        Mat3 R = axes.eigenvectors();
        if (R.determinant() < 0) R.col(0) *= -1;
        out.X_BM.R = Quat(R);
        out.inertia = axes.eigenvalues();
    }
    return out;
}

}  // namespace dihaptic::scene
