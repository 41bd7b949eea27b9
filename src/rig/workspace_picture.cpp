#include <fmt/format.h>

#include <array>

#include "base/svg.h"
#include "rig/workspace.h"

namespace dihaptic::rig {
namespace {

constexpr double kWidth = 760, kTop = 70, kMargin = 40;  // [px]
constexpr std::array kColours{"#d1495b", "#2e6fbb", "#3a9d5d", "#8e5bb0"};

/// Runs of held points, a path of thin bars.
std::string bars(const Workspace& w, const Shadow& shadow, double scale, double left, double top) {
    std::string d;
    const double step = w.spacing * scale;
    for (int y = 0; y < w.size.y(); ++y) {
        for (int x = 0; x < w.size.x(); ++x) {
            if (!w.holds(shadow, x, y)) continue;
            const int begin = x;
            while (x < w.size.x() && w.holds(shadow, x, y)) ++x;
            // y goes away from the person, and up in the picture
            d += fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.2f}h{:.1f}z", left + begin * step,
                             top + (w.size.y() - 1 - y) * step, (x - begin) * step, step + 0.3,
                             -(x - begin) * step);
        }
    }
    return d;
}

/// The edge between held points and others, as short lines.
std::string edge(const Workspace& w, const Shadow& shadow, double scale, double left, double top) {
    std::string d;
    const double step = w.spacing * scale;
    const auto held = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < w.size.x() && y < w.size.y() && w.holds(shadow, x, y);
    };
    for (int y = 0; y <= w.size.y(); ++y) {
        for (int x = 0; x <= w.size.x(); ++x) {
            const double px = left + x * step;
            const double py = top + (w.size.y() - y) * step;
            if (held(x, y) != held(x, y - 1))
                d += fmt::format("M{:.1f} {:.1f}h{:.2f}", px, py, step);
            if (held(x, y) != held(x - 1, y))
                d += fmt::format("M{:.1f} {:.1f}v{:.2f}", px, py, -step);
        }
    }
    return d;
}

}  // namespace

std::string workspace_picture(const Workspace& w, const std::vector<Reach>& reaches,
                              const std::string& title) {
    const Vec3 extent = w.spacing * w.size.cast<double>();
    const double scale = (kWidth - 2 * kMargin) / std::max(extent.x(), 1e-6);  // [px/m]
    const double height = extent.y() * scale;
    const double below = kTop + height + 34;
    Svg svg(kWidth, below + 26 * static_cast<double>(reaches.size() + 3) + 10);
    const Vec3 corner = w.first - Vec3::Constant(w.spacing / 2);
    const auto x_of = [&](double x) { return kMargin + (x - corner.x()) * scale; };
    const auto y_of = [&](double y) { return kTop + height - (y - corner.y()) * scale; };

    svg.text(20, 30, "Workspace: " + title, "start", "font-size=\"18\" font-weight=\"bold\"");
    svg.text(20, 52, "from above, the person below; each colour is a device's reach at any height");
    for (size_t i = 0; i < reaches.size(); ++i) {
        const char* colour = kColours[i % kColours.size()];
        svg.path(bars(w, w.shadows[i], scale, kMargin, kTop), "none", 0, colour,
                 "fill-opacity=\"0.3\"");
        svg.path(edge(w, w.shadows[i], scale, kMargin, kTop), colour, 1);
    }
    svg.path(edge(w, w.shared_shadow, scale, kMargin, kTop), "#000000", 4.5);
    svg.path(edge(w, w.shared_shadow, scale, kMargin, kTop), "#ffd400", 3);
    if (w.sphere_radius > 0) {
        const double r = w.sphere_radius * scale;
        svg.path(
            fmt::format("M{0:.1f} {1:.1f}a{2:.1f} {2:.1f} 0 1 0 {3:.1f} 0a{2:.1f} {2:.1f} 0 1 "
                        "0 {4:.1f} 0",
                        x_of(w.sphere_centre.x()) - r, y_of(w.sphere_centre.y()), r, 2 * r, -2 * r),
            "#000000", 1.5, "none", "stroke-dasharray=\"2 4\"");
    }
    if (!w.box.isEmpty()) {
        svg.rectangle(x_of(w.box.min().x()), y_of(w.box.max().y()), w.box.sizes().x() * scale,
                      w.box.sizes().y() * scale, "none", "stroke=\"#000000\" stroke-width=\"1.5\"");
    }
    // the world's axes, and a decimetre
    svg.path(fmt::format("M{:.1f} {:.1f}h22m-22 0v-22", x_of(0), y_of(0)), "#000000", 2);
    svg.text(x_of(0) + 25, y_of(0) + 4, "x");
    svg.text(x_of(0) - 4, y_of(0) - 26, "y");
    const double bar = 0.1 * scale;
    svg.path(fmt::format("M{:.1f} {:.1f}v-5m0 2.5h{:.1f}m0 -2.5v5", kWidth - kMargin - bar,
                         kTop + height + 18, bar),
             "#000000", 1.5);
    svg.text(kWidth - kMargin - bar / 2, kTop + height + 12, "100 mm", "middle");

    double y = below;
    const auto line = [&](const std::string& words) {
        svg.text(kMargin + 26, y + 12, words);
        y += 26;
    };
    for (size_t i = 0; i < reaches.size(); ++i) {
        svg.rectangle(kMargin, y, 16, 16, kColours[i % kColours.size()], "fill-opacity=\"0.5\"");
        line(fmt::format("{}: {:.2f} litres", reaches[i].finger(), w.volumes[i] * 1e3));
    }
    svg.path(fmt::format("M{:.1f} {:.1f}h16", kMargin, y + 8), "#000000", 5);
    svg.path(fmt::format("M{:.1f} {:.1f}h16", kMargin, y + 8), "#ffd400", 3);
    line(fmt::format("shared: {:.2f} litres", w.shared * 1e3));
    if (w.shared > 0) {
        svg.rectangle(kMargin, y + 2, 16, 12, "none", "stroke=\"#000000\"");
        const Vec3 size = w.box.sizes() * 1e3;
        line(fmt::format(
            "largest box in it: {:.0f} x {:.0f} x {:.0f} mm (x, y, z), from {:.0f} to "
            "{:.0f} mm high",
            size.x(), size.y(), size.z(), w.box.min().z() * 1e3, w.box.max().z() * 1e3));
        svg.path(fmt::format("M{:.1f} {:.1f}h16", kMargin, y + 8), "#000000", 1.5, "none",
                 "stroke-dasharray=\"2 4\"");
        line(fmt::format("largest sphere in it: radius {:.0f} mm, its centre {:.0f} mm high",
                         w.sphere_radius * 1e3, w.sphere_centre.z() * 1e3));
    }
    return svg.take();
}

}  // namespace dihaptic::rig
