#include "session/safety_limits.h"

#include <fmt/format.h>

#include <limits>
#include <optional>

namespace dihaptic::session {
namespace {

/// A limit converted to a number, so that two limits can be compared. An unset value means that
/// there is no limit.
struct Limit {
    std::string name;
    Field field;
    double value = 0;
    std::string shown;
};

/// Visits SafetySettings and collects its numbers and choices.
class Limits {
  public:
    explicit Limits(frame::SafetySettings settings) { settings.visit(*this); }

    void operator()(std::string_view name, double& value, Field field = {}) {
        add(name, field, value, fmt::format("{:g} {}", value, si_symbol(field.quantity)));
    }
    void operator()(std::string_view name, std::optional<double>& value, Field field = {}) {
        if (value) return (*this)(name, *value, field);
        add(name, field, std::numeric_limits<double>::infinity(), "nothing");
    }
    void operator()(std::string_view, int&, Field = {}) {}
    void operator()(std::string_view, std::string&, Field = {}) {}
    template <NamedEnum E>
    void operator()(std::string_view name, E& value, Field field = {}) {
        add(name, field, static_cast<double>(value), std::string(enum_name(value)));
    }

    const std::vector<Limit>& all() const { return limits_; }

  private:
    void add(std::string_view name, const Field& field, double value, std::string shown) {
        limits_.push_back({std::string(name), field, value, std::move(shown)});
    }
    std::vector<Limit> limits_;
};

/// The limits that a rig sets, with the origin of each limit.
struct RigLimits {
    frame::SafetySettings allowed;
    Origins set_by;
    bool real;

    /// Returns the origin of the rig's limit on this setting; nullopt if the rig sets none.
    std::optional<std::string> limit_of(const std::string& name) const {
        const auto found = set_by.find("safety." + name);
        if (found != set_by.end()) return found->second;
        if (real) return "the default for real devices";
        return std::nullopt;
    }
};

void overlay(frame::SafetySettings& safety, const Node& settings, Origins& origins) {
    const Node* const node =
        settings.kind == Node::Kind::mapping ? settings.find("safety") : nullptr;
    if (node == nullptr || node->kind != Node::Kind::mapping) return;
    Diagnostics told_already;
    FieldReader reader(*node, told_already, &origins, "safety");
    safety.visit(reader);
}

Place place_of_limit(const Plan& plan, const std::string& name) {
    const auto origin = plan.origins.find("safety." + name);
    return {origin == plan.origins.end() ? "" : origin->second, 0};
}

bool wider(const Limit& limit, const Limit& wish) {
    switch (limit.field.tighter) {
        case Tighter::less:
            return wish.value > limit.value;
        case Tighter::more:
            return wish.value < limit.value;
        case Tighter::fixed:
            return wish.value != limit.value;
        case Tighter::none:
            break;
    }
    return false;
}

void refuse(const Plan& plan, const std::string& name, const std::string& key,
            const std::string& what, Diagnostics& diagnostics) {
    diagnostics.error(place_of_limit(plan, name), "safety." + key, what,
                      "A scene, an experiment or a command line may only tighten the rig's safety "
                      "limits: leave it out, or change settings: safety: of the rig file.");
}

void check_switch(const Plan& plan, const RigLimits& rig, Diagnostics& diagnostics) {
    const frame::SafetySettings& asked = plan.settings.safety;
    const auto finger = rig.set_by.find("safety.dead_man_finger");
    if (finger == rig.set_by.end() || rig.allowed.dead_man_finger.empty()) return;
    if (asked.dead_man_finger != rig.allowed.dead_man_finger) {
        refuse(plan, "dead_man_finger", "dead_man_finger",
               fmt::format("'{}' removes the dead-man switch of the {}'s device, which {} requires",
                           asked.dead_man_finger, rig.allowed.dead_man_finger, finger->second),
               diagnostics);
    } else if (asked.dead_man_button != rig.allowed.dead_man_button) {
        refuse(plan, "dead_man_button", "dead_man_button",
               fmt::format("{} differs from button {} of {}", asked.dead_man_button,
                           rig.allowed.dead_man_button, finger->second),
               diagnostics);
    }
}

}  // namespace

void limit_safety(Plan& plan, const SafetySources& sources, Diagnostics& diagnostics) {
    RigLimits rig{{}, {}, rig::is_real(plan.rig)};
    overlay(rig.allowed, sources.rig, rig.set_by);

    std::erase_if(plan.origins, [](const auto& one) { return one.first.starts_with("safety."); });
    plan.settings.safety = rig.allowed;
    plan.origins.insert(rig.set_by.begin(), rig.set_by.end());
    for (const Node* const other : sources.others)
        overlay(plan.settings.safety, *other, plan.origins);

    const Limits allowed(rig.allowed);
    const Limits asked(plan.settings.safety);
    for (size_t i = 0; i < asked.all().size(); ++i) {
        const Limit& limit = allowed.all()[i];
        const Limit& wish = asked.all()[i];
        const std::optional<std::string> set_by = rig.limit_of(limit.name);
        if (!set_by || !wider(limit, wish)) continue;
        refuse(plan, limit.name, si_key(limit.name, limit.field.quantity),
               fmt::format("{} widens what {} allows: {}", wish.shown, *set_by, limit.shown),
               diagnostics);
    }
    check_switch(plan, rig, diagnostics);
}

std::vector<std::string> describe_safety(const Plan& plan) {
    std::vector<std::string> out;
    const Limits limits(plan.settings.safety);
    for (const Limit& limit : limits.all()) {
        const auto origin = plan.origins.find("safety." + limit.name);
        if (origin == plan.origins.end()) continue;
        out.push_back(fmt::format("safety.{}: {}, by {}", limit.name, limit.shown, origin->second));
    }
    const auto finger = plan.origins.find("safety.dead_man_finger");
    if (finger != plan.origins.end()) {
        out.push_back(fmt::format("safety.dead_man_finger: {}, button {}, by {}",
                                  plan.settings.safety.dead_man_finger,
                                  plan.settings.safety.dead_man_button, finger->second));
    }
    return out;
}

}  // namespace dihaptic::session
