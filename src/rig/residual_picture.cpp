#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/svg.h"
#include "rig/calibration.h"

namespace dihaptic::rig {
namespace {

constexpr double kPanel = 420, kPanelTop = 78, kGap = 40;  // [px]
/// Colours from zero misfit to the largest misfit on the scale.
constexpr std::array kErrorColours{"#1b4f9c", "#3f8fc4", "#8cc5c9",
                                   "#f2d388", "#ec8f45", "#c0392b"};

struct View {
    Eigen::AlignedBox2d area;
    double scale;  // [px/m]

    explicit View(const std::vector<LinkResidual>& residuals) {
        for (const LinkResidual& r : residuals) area.extend(r.p_W.head<2>());
        if (area.isEmpty()) area.extend(Eigen::Vector2d::Zero());
        area.extend(area.center() + Eigen::Vector2d::Constant(0.01));
        area.extend(area.center() - Eigen::Vector2d::Constant(0.01));
        scale = (kPanel - 30) / area.sizes().maxCoeff();
    }
    double x(double p) const { return kPanel / 2 + (p - area.center().x()) * scale; }
    double y(double p) const { return kPanelTop + kPanel / 2 - (p - area.center().y()) * scale; }
};

/// A round number that is above most misfits [m].
double scale_of(const std::vector<LinkResidual>& residuals) {
    std::vector<double> sizes;
    for (const LinkResidual& r : residuals)
        if (!r.slip) sizes.push_back(std::abs(r.misfit));
    if (sizes.empty()) return 1e-3;
    std::sort(sizes.begin(), sizes.end());
    const double most = std::max(1e-6, sizes[(sizes.size() - 1) * 99 / 100]);
    const double unit = std::pow(10, std::floor(std::log10(most)));
    return std::ceil(most / unit) * unit;
}

void draw(Svg& svg, double left, const std::string& title,
          const std::vector<LinkResidual>& residuals) {
    const View view(residuals);
    const double most = scale_of(residuals);
    svg.text(left + kPanel / 2, kPanelTop - 10, title, "middle", "font-weight=\"bold\"");
    svg.rectangle(left, kPanelTop, kPanel, kPanel, "none", "stroke=\"#999999\"");
    for (const LinkResidual& r : residuals) {
        const double x = left + view.x(r.p_W.x());
        const double y = view.y(r.p_W.y());
        if (r.slip) {
            svg.path(fmt::format("M{:.1f} {:.1f}l5 5m0 -5l-5 5", x - 2.5, y - 2.5), "#999999", 1);
            continue;
        }
        const double share = std::min(1.0, std::abs(r.misfit) / most);
        const auto colour =
            std::min(kErrorColours.size() - 1,
                     static_cast<size_t>(share * static_cast<double>(kErrorColours.size())));
        svg.rectangle(x - 2, y - 2, 4, 4, kErrorColours[colour]);
    }
    const double y = kPanelTop + kPanel + 16;
    for (size_t i = 0; i < kErrorColours.size(); ++i)
        svg.rectangle(left + 26 * static_cast<double>(i), y, 26, 12, kErrorColours[i]);
    svg.text(left, y + 28, "0");
    svg.text(left + 26 * static_cast<double>(kErrorColours.size()), y + 28,
             fmt::format("{:.3g} mm", most * 1e3), "end");
    const double bar = 0.05 * view.scale;
    svg.path(
        fmt::format("M{:.1f} {:.1f}v-5m0 2.5h{:.1f}m0 -2.5v5", left + kPanel - bar, y + 12, bar),
        "#000000", 1.5);
    svg.text(left + kPanel - bar / 2, y + 28, "50 mm", "middle");
}

}  // namespace

std::string residual_picture(const CalibrationResult& result, const std::string& title) {
    Svg svg(2 * kPanel + 3 * kGap, kPanelTop + kPanel + 76);
    svg.text(kGap, 28, "Calibration: " + title, "start", "font-size=\"18\" font-weight=\"bold\"");
    svg.text(kGap, 50,
             "error of the link's apparent length, at the position of its middle, from above; "
             "crosses are slips");
    draw(svg, kGap, "as in the rig file", result.before);
    draw(svg, 2 * kGap + kPanel, "calibrated, held-out samples", result.after);
    return svg.take();
}

}  // namespace dihaptic::rig
