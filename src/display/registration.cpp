#include "display/registration.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/unit.h"
#include "display/display.h"

namespace dihaptic::display {
namespace {

constexpr int kColumns = 5, kRows = 4;
constexpr double kCrossMargin =
    0.08;  // distance of the crosses from the screen's edges, as a fraction of the edge lengths
constexpr double kMostRms = 3e-3;      // largest rms residual of the touches on one screen [m]
constexpr double kMostStretch = 0.03;  // largest relative error of a size measured with a ruler

}  // namespace

std::vector<Cross> crosses() {
    std::vector<Cross> out;
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column)
            out.push_back({kCrossMargin + (1 - 2 * kCrossMargin) * column / (kColumns - 1),
                           1 - kCrossMargin - (1 - 2 * kCrossMargin) * row / (kRows - 1)});
    }
    return out;
}

RegistrationResult register_screen(const Display& display, std::span<const Vec3> touches) {
    const std::vector<Cross> all = crosses();
    Eigen::Matrix3Xd told(3, static_cast<Eigen::Index>(all.size()));
    Eigen::Matrix3Xd touched(3, static_cast<Eigen::Index>(all.size()));
    for (size_t i = 0; i < all.size(); ++i) {
        told.col(static_cast<Eigen::Index>(i)) = display.at(all[i]);
        touched.col(static_cast<Eigen::Index>(i)) = touches[i];
    }
    // Umeyama 1991: least-squares fit of a rigid transformation
    const Eigen::Matrix4d X = Eigen::umeyama(told, touched, false);
    const Eigen::Matrix4d scaled = Eigen::umeyama(told, touched, true);
    const Mat3 R = X.topLeftCorner<3, 3>();
    const Vec3 p = X.topRightCorner<3, 1>();
    RegistrationResult out;
    Eigen::Index worst = 0;
    const Eigen::VectorXd off = ((R * told).colwise() + p - touched).colwise().norm();
    out.registration.worst = off.maxCoeff(&worst);
    out.registration.rms = std::sqrt(off.squaredNorm() / static_cast<double>(off.size()));
    out.stretch = std::cbrt(scaled.topLeftCorner<3, 3>().determinant()) - 1;
    if (std::abs(out.stretch) > kMostStretch)
        throw Error(
            display.place, "lower_right",
            fmt::format("gives a screen of {:.0f} x {:.0f} mm, but the touched area is "
                        "{:.3g} times as large",
                        1e3 * display.right().norm(), 1e3 * display.up().norm(), 1 + out.stretch),
            "Measure the picture's edges, and give the corners these distances.");
    if (out.registration.rms > kMostRms)
        throw Error(display.place, "name",
                    fmt::format("the touches deviate from a screen by {:.1f} mm, most at cross {}, "
                                "by {:.1f} mm",
                                1e3 * out.registration.rms, worst + 1, 1e3 * off[worst]),
                    "Touch the crosses again, in the order of their numbers.");
    const auto moved = [&](const Vec3& q) { return Vec3(R * q + p); };
    out.registration.lower_left = moved(display.lower_left);
    out.registration.lower_right = moved(display.lower_right);
    out.registration.upper_left = moved(display.upper_left);
    const Vec3 middle = display.at({0.5, 0.5});
    out.moved = (moved(middle) - middle).norm();
    out.turned = Eigen::AngleAxisd(R).angle();
    return out;
}

std::string describe(const RegistrationResult& result) {
    return fmt::format(
        "the screen is {:.2f} mm from its position in the rig file and turned by {:.2f} degrees\n"
        "its size agrees with the file's to {:.1f} %\n"
        "touches deviate from their crosses by {:.2f} mm rms, and by {:.2f} mm at most\n",
        1e3 * result.moved, result.turned / kDegree, 100 * std::abs(result.stretch),
        1e3 * result.registration.rms, 1e3 * result.registration.worst);
}

std::string cross_picture(const Display& display) {
    const double width = 1600, height = width * display.up().norm() / display.right().norm();
    const double arm = 0.02 * width;
    std::string marks;
    int number = 0;
    for (const Cross& cross : crosses()) {
        const double x = cross.right * width, y = (1 - cross.up) * height;
        marks += fmt::format(
            "<path d='M{:.1f} {:.1f}h{:.1f}M{:.1f} {:.1f}v{:.1f}'/>"
            "<text x='{:.1f}' y='{:.1f}' stroke='none' fill='#fff'>{}</text>\n",
            x - arm, y, 2 * arm, x, y - arm, 2 * arm, x + 0.4 * arm, y - 0.4 * arm, ++number);
    }
    const char* turned =
        display.mirrored == Mirrored::left_right ? "translate({0:.1f} 0) scale(-1 1)"
        : display.mirrored == Mirrored::up_down  ? "translate(0 {1:.1f}) scale(1 -1)"
                                                 : "";
    return fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.1f} {1:.1f}' "
        "preserveAspectRatio='none'>\n<rect width='100%' height='100%' fill='#000'/>\n"
        "<g transform='{2}' stroke='#fff' stroke-width='2' font-family='sans-serif' "
        "font-size='{3:.1f}'>\n{4}</g>\n</svg>\n",
        width, height, fmt::format(fmt::runtime(turned), width, height), arm, marks);
}

}  // namespace dihaptic::display
