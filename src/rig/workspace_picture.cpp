#include <fmt/format.h>

#include <array>

#include "base/svg.h"
#include "rig/workspace.h"

namespace dihaptic::rig {
namespace {

constexpr double kWidth = 760, kTop = 70, kSideMargin = 40, kLegendLine = 26;  // [px]
constexpr const char* kDotted = "stroke-dasharray=\"2 4\"";
constexpr std::array kColours{"#d1495b", "#2e6fbb", "#3a9d5d", "#8e5bb0"};

/// The part of the picture that shows the grid, with x to the right and y upwards.
struct FromAbove {
    Vec3 corner;    // corner of the grid, next to its first point [m]
    double scale;   // [px/m]
    double height;  // [px]

    explicit FromAbove(const Workspace& w) : corner(w.first - Vec3::Constant(w.spacing / 2)) {
        const Vec3 extent = w.spacing * w.size.cast<double>();
        scale = (kWidth - 2 * kSideMargin) / std::max(extent.x(), 1e-6);
        height = extent.y() * scale;
    }
    double x(double p) const { return kSideMargin + (p - corner.x()) * scale; }
    double y(double p) const { return kTop + height - (p - corner.y()) * scale; }
};

/// Returns an SVG path of thin bars, one for each run of points within reach.
std::string bars(const Workspace& w, const Shadow& shadow, double scale) {
    std::string d;
    const double step = w.spacing * scale;
    for (int y = 0; y < w.size.y(); ++y) {
        for (int x = 0; x < w.size.x(); ++x) {
            if (!w.holds(shadow, x, y)) continue;
            const int begin = x;
            while (x < w.size.x() && w.holds(shadow, x, y)) ++x;
            // y points away from the person, which is upwards in the picture
            d += fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.2f}h{:.1f}z", kSideMargin + begin * step,
                             kTop + (w.size.y() - 1 - y) * step, (x - begin) * step, step + 0.3,
                             -(x - begin) * step);
        }
    }
    return d;
}

/// Returns an SVG path of short lines along the edge between points within reach and other points.
std::string edge(const Workspace& w, const Shadow& shadow, double scale) {
    std::string d;
    const double step = w.spacing * scale;
    const auto held = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < w.size.x() && y < w.size.y() && w.holds(shadow, x, y);
    };
    for (int y = 0; y <= w.size.y(); ++y) {
        for (int x = 0; x <= w.size.x(); ++x) {
            const double px = kSideMargin + x * step;
            const double py = kTop + (w.size.y() - y) * step;
            if (held(x, y) != held(x, y - 1))
                d += fmt::format("M{:.1f} {:.1f}h{:.2f}", px, py, step);
            if (held(x, y) != held(x - 1, y))
                d += fmt::format("M{:.1f} {:.1f}v{:.2f}", px, py, -step);
        }
    }
    return d;
}

void draw_shadows(Svg& svg, const Workspace& w, double scale) {
    for (size_t i = 0; i < w.shadows.size(); ++i) {
        const char* colour = kColours[i % kColours.size()];
        svg.path(bars(w, w.shadows[i], scale), "none", 0, colour, "fill-opacity=\"0.3\"");
        svg.path(edge(w, w.shadows[i], scale), colour, 1);
    }
    svg.path(edge(w, w.shared_shadow, scale), "#000000", 4.5);
    svg.path(edge(w, w.shared_shadow, scale), "#ffd400", 3);
}

/// Draws the largest sphere and box within the intersection.
void draw_largest(Svg& svg, const Workspace& w, const FromAbove& view) {
    if (w.sphere_radius > 0) {
        const double r = w.sphere_radius * view.scale;
        svg.path(fmt::format("M{0:.1f} {1:.1f}a{2:.1f} {2:.1f} 0 1 0 {3:.1f} 0a{2:.1f} {2:.1f} 0 1 "
                             "0 {4:.1f} 0",
                             view.x(w.sphere_centre.x()) - r, view.y(w.sphere_centre.y()), r, 2 * r,
                             -2 * r),
                 "#000000", 1.5, "none", kDotted);
    }
    if (!w.box.isEmpty()) {
        svg.rectangle(view.x(w.box.min().x()), view.y(w.box.max().y()),
                      w.box.sizes().x() * view.scale, w.box.sizes().y() * view.scale, "none",
                      "stroke=\"#000000\" stroke-width=\"1.5\"");
    }
}

/// Draws the axes of the world, and a scale bar of one decimetre.
void draw_measures(Svg& svg, const FromAbove& view) {
    svg.path(fmt::format("M{:.1f} {:.1f}h22m-22 0v-22", view.x(0), view.y(0)), "#000000", 2);
    svg.text(view.x(0) + 25, view.y(0) + 4, "x");
    svg.text(view.x(0) - 4, view.y(0) - 26, "y");
    const double bar = 0.1 * view.scale;
    svg.path(fmt::format("M{:.1f} {:.1f}v-5m0 2.5h{:.1f}m0 -2.5v5", kWidth - kSideMargin - bar,
                         kTop + view.height + 18, bar),
             "#000000", 1.5);
    svg.text(kWidth - kSideMargin - bar / 2, kTop + view.height + 12, "100 mm", "middle");
}

/// Draws the legend, from y downwards, which explains each colour and line and gives the sizes.
void draw_legend(Svg& svg, const Workspace& w, const std::vector<Reach>& reaches, double y) {
    const auto line = [&](const std::string& words) {
        svg.text(kSideMargin + 26, y + 12, words);
        y += kLegendLine;
    };
    const auto stroke = [&] { return fmt::format("M{:.1f} {:.1f}h16", kSideMargin, y + 8); };
    for (size_t i = 0; i < reaches.size(); ++i) {
        svg.rectangle(kSideMargin, y, 16, 16, kColours[i % kColours.size()],
                      "fill-opacity=\"0.5\"");
        line(fmt::format("{}: {:.2f} litres", reaches[i].finger(), w.volumes[i] * 1e3));
    }
    svg.path(stroke(), "#000000", 5);
    svg.path(stroke(), "#ffd400", 3);
    line(fmt::format("shared: {:.2f} litres", w.shared * 1e3));
    if (w.shared <= 0) return;
    svg.rectangle(kSideMargin, y + 2, 16, 12, "none", "stroke=\"#000000\"");
    const Vec3 size = w.box.sizes() * 1e3;
    line(
        fmt::format("largest box in it: {:.0f} x {:.0f} x {:.0f} mm (x, y, z), from {:.0f} to "
                    "{:.0f} mm high",
                    size.x(), size.y(), size.z(), w.box.min().z() * 1e3, w.box.max().z() * 1e3));
    svg.path(stroke(), "#000000", 1.5, "none", kDotted);
    line(fmt::format("largest sphere in it: radius {:.0f} mm, its centre {:.0f} mm high",
                     w.sphere_radius * 1e3, w.sphere_centre.z() * 1e3));
}

}  // namespace

std::string workspace_picture(const Workspace& w, const std::vector<Reach>& reaches,
                              const std::string& title) {
    const FromAbove view(w);
    const double below = kTop + view.height + 34;
    Svg svg(kWidth, below + kLegendLine * static_cast<double>(reaches.size() + 3) + 10);
    svg.text(20, 30, "Workspace: " + title, "start", "font-size=\"18\" font-weight=\"bold\"");
    svg.text(20, 52, "from above, the person below; each colour is a device's reach at any height");
    draw_shadows(svg, w, view.scale);
    draw_largest(svg, w, view);
    draw_measures(svg, view);
    draw_legend(svg, w, reaches, below);
    return svg.take();
}

}  // namespace dihaptic::rig
