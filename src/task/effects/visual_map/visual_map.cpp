#include "task/effects/visual_map/visual_map.h"

#include <fmt/format.h>

#include "base/unit.h"
#include "task/plan/names.h"

namespace dihaptic::task {
namespace {

/// Returns the bit mask for the names "proxies", "object" and "target". An unknown name is an error
/// and sets no bit.
uint32_t moves_of(const VisualSpec& visual, Diagnostics& diagnostics) {
    const std::vector<std::string> names{"proxies", "object", "target"};
    uint32_t moves = 0;
    for (const std::string& name : visual.moves) {
        const int i = look_up(names, name, visual.place, "moves", "not an object that can be moved",
                              diagnostics);
        if (i >= 0) moves |= 1u << i;
    }
    return moves;
}

bool displaces(const VisualSpec& visual) {
    return visual.delay != 0 || visual.noise != FormulaVec3{};
}

bool shifts(const VisualSpec& visual) {
    return visual.shift != FormulaVec3{};
}

/// Whether the map needs a centre; a map that only adds a shift, a delay or noise does not.
bool has_centre(const VisualSpec& visual) {
    return (!displaces(visual) && !shifts(visual)) || !visual.about.empty() ||
           !visual.toward.empty() || visual.angle != 0 || visual.scale != kNoFactors ||
           visual.size != 1;
}

}  // namespace

VisualEffect::VisualEffect(const VisualSpec& spec, const Names& names, const scene::Scene& scene,
                           Diagnostics& diagnostics)
    : spec_(spec), moves_(moves_of(spec, diagnostics)), object_(scene.object_index()) {
    if (has_centre(spec)) names.need(spec.about, spec.place, "about", diagnostics);
    if (spec.axis || spec.angle != 0) axis_ = axis_of(spec.axis, spec.place, "axis", diagnostics);
    check(diagnostics);
}

void VisualEffect::check(Diagnostics& diagnostics) const {
    const auto error = [&](const char* key, const char* what, const char* remedy) {
        diagnostics.error(spec_.place, key, what, remedy);
    };
    const bool moves_object = (moves_ & frame::kMovesObject) != 0;
    if (displaces(spec_) && !moves_object && (moves_ & frame::kMovesProxies) == 0)
        error(spec_.delay != 0 ? "delay" : "noise", "needs 'proxies' or 'object' among 'moves'",
              "Add 'proxies' to 'moves'.");
    if (moves_object && object_ < 0)
        error("moves", "the scene has no movable object", "Leave out 'object'.");
    if (spec_.size != 1 && !moves_object)
        error("size", "needs 'object' among 'moves'", "Add 'object' to 'moves'.");
    if (spec_.toward.index >= 0 && (spec_.angle != 0 || spec_.scale != kNoFactors))
        error("toward", "motion shown on a line can be neither rotated nor scaled",
              "Leave out angle_deg and 'scale', or 'toward'.");
}

std::optional<Vec3> VisualEffect::axis() const {
    if (spec_.angle.value == 0 && spec_.angle.index < 0) return {};
    return axis_;
}

double VisualEffect::longest_delay() const {
    return spec_.delay.computed() ? spec_.delay.field.max : spec_.delay.value;
}

void VisualEffect::order(double share, std::span<const Vec3> regions_W, const Motions&,
                         frame::TaskFrame& out) const noexcept {
    frame::VisualMap shown;
    shown.moves = moves_;
    shown.object = object_;
    if (spec_.about.index >= 0) shown.p_WC = regions_W[static_cast<size_t>(spec_.about.index)];
    shown.scale = part_of(share, value(spec_.scale));
    shown.R = Quat(Eigen::AngleAxisd(share * spec_.angle.value, axis_));
    shown.size = part_of(share, spec_.size.value);
    shown.delay = share * spec_.delay.value;
    shown.noise = share * value(spec_.noise);
    shown.shift_W = share * value(spec_.shift);
    if (spec_.toward.index >= 0) {
        const Vec3 way = regions_W[static_cast<size_t>(spec_.toward.index)] - shown.p_WC;
        if (way.norm() > 0) shown.along_W = way.normalized();
    }
    add(out.visual, shown);
}

void say(const VisualSpec& spec, std::vector<std::string>& out) {
    if (!spec.toward.empty()) out.push_back("visual clamp toward " + spec.toward);
    if (spec.angle != 0)
        out.push_back(fmt::format("rotation by {} deg about {}", in_words(spec.angle, kDegree),
                                  in_words(as_formula(spec.axis.value_or(Vec3::Zero())))));
    if (spec.scale != kNoFactors) out.push_back("visual gain " + in_words(spec.scale));
    if (shifts(spec)) {
        const auto mm = [&](size_t i) { return in_words(spec.shift[i], 1e-3); };
        out.push_back(fmt::format("shown ({}, {}, {}) mm aside", mm(0), mm(1), mm(2)));
    }
    say_factor("displayed size", spec.size, out);
    if (spec.delay != 0) out.push_back(fmt::format("shown {} ms late", in_words(spec.delay, 1e-3)));
    if (spec.noise != FormulaVec3{})
        out.push_back("shaken by " + in_words(spec.noise, 1e-3) + " mm (SD)");
}

}  // namespace dihaptic::task
