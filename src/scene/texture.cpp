#include "scene/texture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/relief_picture.h"

namespace dihaptic::scene {
namespace {

/// The state of a relief at a point: its height r from 0 to 1, and the slope of r per metre.
struct Ridge {
    double r = 0;
    Vec3 rise = Vec3::Zero();
};

Ridge grating_at(double k, const Vec3& across, const Vec3& p_B) {
    const double phase = k * across.dot(p_B);
    return {(1 + std::cos(phase)) / 2, -k / 2 * std::sin(phase) * across};
}

Ridge grid_at(double k, const Vec3& n_B, const Vec3& p_B) {
    int out = 0;
    n_B.cwiseAbs().maxCoeff(&out);
    const int i = (out + 1) % 3, j = (out + 2) % 3;
    const double x = 1 + std::cos(k * p_B[i]), y = 1 + std::cos(k * p_B[j]);
    Ridge ridge{x * y / 4};
    ridge.rise[i] = -k / 4 * std::sin(k * p_B[i]) * y;
    ridge.rise[j] = -k / 4 * std::sin(k * p_B[j]) * x;
    return ridge;
}

Ridge picture_at(const ReliefPicture& picture, double pixel, const Vec3& along, const Vec3& n_B,
                 const Vec3& p_B) {
    Vec3 right = along - n_B.dot(along) * n_B;
    // on a face whose normal points to the right of the picture, the direction is arbitrary
    right = right.norm() > 0.1 ? right.normalized() : n_B.unitOrthogonal();
    const Vec3 up = n_B.cross(right);
    const ReliefPicture::Value value = picture.at(right.dot(p_B) / pixel, up.dot(p_B) / pixel);
    return {value.height, (value.rise_x * right + value.rise_y * up) / pixel};
}

}  // namespace

double Texture::pixel() const noexcept {
    return wavelength / picture->width();
}

double Texture::steepest() const noexcept {
    if (kind == TextureKind::picture) return picture ? picture->steepest() * height / pixel() : 0;
    return std::numbers::pi * height / wavelength;
}

void Texture::scale(const Texture& given, double wavelength_scale, double height_scale,
                    double friction_scale) noexcept {
    wavelength = wavelength_scale * given.wavelength;
    height = std::min(kHighest, height_scale * given.height);
    friction = std::min(1.0, friction_scale * given.friction);
    const double slope = steepest();
    if (slope > kSteepest) height *= kSteepest / slope;
}

Relief Texture::at(const Vec3& p_B, const Vec3& n_B) const noexcept {
    const double k = 2 * std::numbers::pi / wavelength;
    Ridge ridge;
    switch (kind) {
        case TextureKind::grating:
            ridge = grating_at(k, along.normalized(), p_B);
            break;
        case TextureKind::grid:
            ridge = grid_at(k, n_B, p_B);
            break;
        case TextureKind::picture:
            if (!picture) return {};
            ridge = picture_at(*picture, pixel(), along.normalized(), n_B, p_B);
            break;
    }
    const Vec3 slope = height * (ridge.rise - n_B.dot(ridge.rise) * n_B);
    return {1 + friction * (2 * ridge.r - 1), height * ridge.r, slope};
}

}  // namespace dihaptic::scene
