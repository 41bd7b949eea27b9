// Draws the map of a search: stiffness increases to the right, damping upward, and there is one
// cell per setting. Calm cells are blue, shaking ones orange, and those where the block fell grey.
// Each cell also has a mark, for colour-blind readers and black-and-white printers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/svg.h"
#include "measure/tune.h"

namespace dihaptic::measure {
namespace {

constexpr double kCell = 44, kLeft = 96, kTop = 84;  // [px]

class Picture : public Svg {
  public:
    using Svg::Svg;
    void cell(double x, double y, const char* colour, const std::string& tip = "") {
        rectangle(x - kCell / 2, y - kCell / 2, kCell, kCell, colour, "stroke=\"#ffffff\"", tip);
    }
};

void cross(Picture& picture, double x, double y) {
    picture.path(fmt::format("M{:.1f} {:.1f}l12 12m0 -12l-12 12", x - 6, y - 6), "#7a3300", 2.5);
}

void arrow_down(Picture& picture, double x, double y) {
    picture.path(fmt::format("M{0:.1f} {1:.1f}v16m-6 -6l6 6l6 -6", x, y - 8), "#ffffff", 2.5);
}

void dot(Picture& picture, double x, double y) {
    picture.path(fmt::format("M{:.1f} {:.1f}a5 5 0 1 0 10 0a5 5 0 1 0 -10 0", x - 5, y), "none", 0,
                 "#ffffff");
}

/// Returns one letter for each burden that a point does not withstand.
std::string lacking(const TunePoint& point) {
    std::string out;
    if (!point.calm(Burden::delay)) out += 'D';
    if (!point.calm(Burden::light)) out += 'T';
    if (!point.calm(Burden::loose)) out += 'L';
    if (!point.calm(Burden::firm)) out += 'F';
    return out;
}

void draw_point(Picture& picture, double x, double y, const TunePoint& point) {
    const Verdict verdict = point.verdicts[Burden::none].value_or(Verdict::dropped);
    const std::string where = fmt::format("{:g} N/m, {:g} N*s/m: ", point.k, point.c);
    if (verdict == Verdict::shaking) {
        picture.cell(x, y, "#e69f00", where + "shaking");
        cross(picture, x, y);
    } else if (verdict == Verdict::dropped) {
        picture.cell(x, y, "#777777", where + "dropped");
        arrow_down(picture, x, y);
    } else if (point.calm_with_margin()) {
        picture.cell(x, y, "#0a5ea8", where + "calm with margin");
        dot(picture, x, y);
    } else {
        picture.cell(x, y, "#a9d3f0", where + "calm, but not with " + lacking(point));
        picture.text(x, y + 4, lacking(point), "middle", "font-size=\"11\" fill=\"#10364f\"");
    }
}

/// Returns the fractional index at which a value lies among ascending `values`, interpolated after
/// transformation by `scale`.
double index_of(const std::vector<double>& values, double value, double (*scale)(double)) {
    const auto above = std::upper_bound(values.begin(), values.end(), value);
    if (above == values.begin()) return 0;
    if (above == values.end()) return static_cast<double>(values.size() - 1);
    const double low = scale(*(above - 1));
    return static_cast<double>(above - values.begin() - 1) +
           (scale(value) - low) / (scale(*above) - low);
}

double same(double value) {
    return value;
}
double logarithm(double value) {
    return std::log(value);
}

/// The grid of the map, with a cell for each setting that was judged.
class Grid {
  public:
    explicit Grid(const TuneSetup& setup) : setup_(setup) {}
    double width() const { return static_cast<double>(setup_.stiffness.size()) * kCell; }
    double height() const { return static_cast<double>(setup_.damping.size()) * kCell; }
    double right() const { return kLeft + width(); }
    double bottom() const { return kTop + height(); }
    double x(double k) const {
        return kLeft + kCell * (0.5 + index_of(setup_.stiffness, k, logarithm));
    }
    double y(double c) const {
        return bottom() - kCell * (0.5 + index_of(setup_.damping, c, same));
    }

  private:
    const TuneSetup& setup_;
};

void draw_title(Picture& picture, const TuneSetup& setup, const std::string& title,
                double smoothing) {
    picture.text(20, 30, "Calm and shaking settings: " + title, "start",
                 "font-size=\"18\" font-weight=\"bold\"");
    std::string how = fmt::format(
        "coupling {}, solver {}, {:g} Hz; a hand of {:g} N/m and {:g} N·s/m grips 100 g with {:g} "
        "N",
        enum_name(setup.settings.coupling.kind), enum_name(setup.settings.dynamics.solver),
        setup.settings.rate, setup.hand.stiffness, setup.hand.damping, setup.grip);
    if (setup.smoothing.size() > 1) how += fmt::format("; smoothing {:g}", smoothing);
    picture.text(20, 54, how);
}

void draw_axes(Picture& picture, const Grid& grid, const TuneSetup& setup) {
    for (const double k : setup.stiffness)
        picture.text(grid.x(k), grid.bottom() + 18, fmt::format("{:g}", k), "middle",
                     "font-size=\"11\"");
    for (const double c : setup.damping)
        picture.text(kLeft - 10, grid.y(c) + 4, fmt::format("{:g}", c), "end");
    picture.text(kLeft + grid.width() / 2, grid.bottom() + 42, "stiffness of the coupling, N/m",
                 "middle");
    const double middle = kTop + grid.height() / 2;
    picture.text(36, middle, "damping of the coupling, N·s/m", "middle",
                 fmt::format("transform=\"rotate(-90 36 {:g})\"", middle));
}

/// Draws a line for the program's default damping.
void draw_default_damping(Picture& picture, const Grid& grid, const TuneSetup& setup) {
    std::string line;
    const double per_k = setup.settings.step() / 2;
    for (const double k : setup.stiffness) {
        if (k * per_k > setup.damping.back()) break;
        line +=
            fmt::format("{}{:.1f} {:.1f}", line.empty() ? "M" : "L", grid.x(k), grid.y(k * per_k));
    }
    if (line.empty()) return;
    picture.path(line, "#ffffff", 4);
    picture.path(line, "#000000", 1.5);
}

void draw_proposal(Picture& picture, const Grid& grid, const TunePoint& proposal) {
    const double x = grid.x(proposal.k);
    const double y = grid.y(proposal.c);
    std::string star;
    for (int i = 0; i < 10; ++i) {
        const double angle = std::acos(-1.0) * i / 5;
        const double radius = i % 2 == 0 ? 17 : 7;
        star += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", x + radius * std::sin(angle),
                            y - radius * std::cos(angle));
    }
    picture.path(star + "Z", "#000000", 2, "#ffe14d");
    picture.text(grid.right(), 76,
                 fmt::format("★ proposal: {:.6g} N/m, {:.6g} N·s/m", proposal.k, proposal.c), "end",
                 "font-weight=\"bold\"");
}

/// Draws the key to the marks, starting at `y` and going down.
void draw_key(Picture& picture, double y) {
    const double key = kLeft;
    picture.cell(key, y, "#0a5ea8");
    dot(picture, key, y);
    picture.text(
        key + 30, y + 5,
        "calm with margin: also with another tick of delay, 10 g, a loose and a firm hand");
    picture.cell(key + 590, y, "#e69f00");
    cross(picture, key + 590, y);
    picture.text(key + 620, y + 5, "shaking");
    y += 50;
    picture.cell(key, y, "#a9d3f0");
    picture.text(key, y + 4, "DT", "middle", "font-size=\"11\" fill=\"#10364f\"");
    picture.text(
        key + 30, y + 5,
        "calm unchanged, but not with D: delay, T: ten grams, L: loose hand, F: firm hand");
    picture.cell(key + 590, y, "#777777");
    arrow_down(picture, key + 590, y);
    picture.text(key + 620, y + 5, "dropped");
    picture.text(key - 22, y + 52, "black line: default damping, k h / 2");
}

}  // namespace

std::string tune_map(const TuneResult& result, const TuneSetup& setup, const std::string& title) {
    const Grid grid(setup);
    Picture picture(std::max(grid.right() + 30, 830.0), grid.bottom() + 216);
    const double smoothing = result.proposal ? result.proposal->smoothing : setup.smoothing.back();
    draw_title(picture, setup, title, smoothing);
    for (const TunePoint& point : result.map) {
        if (point.smoothing == smoothing)
            draw_point(picture, grid.x(point.k), grid.y(point.c), point);
    }
    draw_axes(picture, grid, setup);
    draw_default_damping(picture, grid, setup);
    if (result.proposal) draw_proposal(picture, grid, *result.proposal);
    draw_key(picture, grid.bottom() + 80);
    return picture.take();
}

}  // namespace dihaptic::measure
