#include "task/seen_plan.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "frame/shown_texts.h"
#include "scene/colour.h"
#include "task/lookup.h"

namespace dihaptic::task {
namespace {

constexpr size_t kMostLines = 2;                                    // of a state, and of the task
constexpr size_t kMostInText = 4;                                   // numbers
static_assert(frame::TaskFrame::kMostLines == 2 * kMostLines + 2);  // countdown, feedback
static_assert(frame::TaskFrame::kMostNumbers == kMostInText * (1 + frame::TaskFrame::kMostLines));

constexpr const char* kRest = "Take a break";
constexpr const char* kCountdown = "{countdown}";

frame::LookFrame& look_of(TaskPlan::Looks& looks, size_t body) {
    for (frame::LookFrame& look : looks.things) {
        if (look.body == static_cast<int32_t>(body)) return look;
    }
    frame::LookFrame& look = looks.things.emplace_back();
    look.body = static_cast<int32_t>(body);
    return look;
}

}  // namespace

bool is_key(const std::string& text) {
    return text.size() == 1 && std::isalnum(static_cast<unsigned char>(text[0])) != 0;
}

SeenPlanner::SeenPlanner(TaskPlan& plan, const scene::Scene& scene, Diagnostics& diagnostics)
    : plan_(plan),
      diagnostics_(diagnostics),
      regions_(names_of(plan.task.regions)),
      bodies_(names_of(scene.bodies)),
      fingers_(scene::finger_names(scene)) {
    plan_.object = scene.object_index();
}

int SeenPlanner::text(const std::string& text, const Place& place, const char* key) {
    if (text.empty()) return -1;
    const auto found = std::find(plan_.messages.begin(), plan_.messages.end(), text);
    if (found != plan_.messages.end()) return static_cast<int>(found - plan_.messages.begin());
    plan_.messages.push_back(text);
    std::vector<TextNumber> numbers;
    for (const frame::Placeholder& given : frame::placeholders(text)) {
        if (given.name.empty()) {
            diagnostics_.error(place, key,
                               fmt::format("'{}' is no place for a number",
                                           text.substr(given.begin, given.end - given.begin)),
                               "Write e.g. {trial_num} or {countdown:.1f}; for a brace, {{ or }}.");
            continue;
        }
        if (const auto named = number(given.name, place, key)) numbers.push_back(*named);
    }
    if (numbers.size() > kMostInText)
        diagnostics_.error(
            place, key,
            fmt::format("has {} numbers, where {} are the most", numbers.size(), kMostInText),
            "Leave some out, or give them a line of their own.");
    plan_.numbers.push_back(std::move(numbers));
    return static_cast<int>(plan_.messages.size()) - 1;
}

std::optional<TextNumber> SeenPlanner::number(const std::string& name, const Place& place,
                                              const char* key) {
    const auto figures = enum_names(Figure{});
    const auto figure = std::find(figures.begin(), figures.end(), name);
    if (figure != figures.end())
        return TextNumber{static_cast<Figure>(figure - figures.begin()), {}};
    Diagnostics unknown;
    Expression quantity = Expression::compile(name, plan_.quantities, place, key, unknown);
    if (!unknown.has_errors() && quantity.type() == Expression::Type::number)
        return TextNumber{Figure{}, std::move(quantity)};
    std::vector<std::string> names = plan_.quantities.names();
    names.insert(names.end(), figures.begin(), figures.end());
    const std::string guess = nearest(name, names);
    diagnostics_.error(place, key, fmt::format("'{}' is no number that a text may have", name),
                       guess.empty() || guess == name
                           ? fmt::format("Known: {}, and numbers that expressions may name, e.g. "
                                         "a variable or grip_force.",
                                         fmt::join(figures, ", "))
                           : fmt::format("Did you mean {}?", guess),
                       choices_of(names));
    return {};
}

std::vector<int> SeenPlanner::lines(const std::vector<std::string>& texts, const Place& place) {
    if (texts.size() > kMostLines)
        diagnostics_.error(
            place, "lines",
            fmt::format("there are {}, where {} are the most", texts.size(), kMostLines),
            "Leave some out.");
    std::vector<int> out;
    for (const std::string& line : texts) {
        if (const int i = text(line, place, "lines"); i >= 0) out.push_back(i);
    }
    return out;
}

void SeenPlanner::plan_state(const State& state, TaskPlan::Stage& out) {
    add_looks(state.look, out.looks, diagnostics_);
    show(state.show, state.show.place.line > 0 ? state.show.place : state.place, out);
    if (state.countdown) {
        const bool ends = std::any_of(state.exits.begin(), state.exits.end(),
                                      [](const Exit& exit) { return exit.when == When::time; });
        if (!ends)
            diagnostics_.error(state.place, "countdown", "no exit by time ends this state",
                               "Add e.g. - { when: time, after_s: 5, outcome: too late }.");
        out.lines.push_back(text(kCountdown, state.place, "countdown"));
    }
    std::vector<std::string> texts = state.lines;
    if (state.ask) texts.push_back(line_of(*state.ask));
    for (const int line : lines(texts, state.place)) out.lines.push_back(line);
}

void SeenPlanner::show(const Show& given, const Place& place, TaskPlan::Stage& out) {
    for (const std::string& name : given.targets) {
        const int i = look_up(regions_, name, place, "show", "no region", diagnostics_);
        if (i >= 0) out.shown |= 1u << i;
    }
    out.holds_cursor = given.cursor == Cursor::held;
    if (given.cursor == Cursor::no) {
        for (size_t i = 0; i < fingers_.size(); ++i)
            look_of(out.looks, bodies_.size() + i).hidden = 1;
    }
    if (!given.object && plan_.object < 0) {
        diagnostics_.error(place, "object", "the scene has no object that can move",
                           "Leave it out, or hide one of the bodies.");
    } else if (!given.object) {
        look_of(out.looks, static_cast<size_t>(plan_.object)).hidden = 1;
    }
    show_some(given.bodies, "bodies", bodies_, 0, "no body", place, out.looks);
    show_some(given.fingers, "fingers", fingers_, bodies_.size(), "none of the scene's fingers",
              place, out.looks);
}

void SeenPlanner::show_some(const Node& given, const char* key,
                            const std::vector<std::string>& names, size_t first,
                            const char* unknown, const Place& place, TaskPlan::Looks& out) {
    if (given.kind == Node::Kind::null) return;
    if (given.kind != Node::Kind::mapping) {
        diagnostics_.error(place, key, "must have a key for each that is hidden",
                           fmt::format("Write e.g. {}: {{ {}: no }}.", key,
                                       names.empty() ? "name" : names.front()));
        return;
    }
    FieldReader reader(given, diagnostics_);
    for (const Node::Entry& entry : given.entries) {
        const int i = look_up(names, entry.key, entry.value.place, key, unknown, diagnostics_);
        bool shown = true;
        if (entry.value.kind != Node::Kind::scalar || entry.value.scalar.empty()) {
            diagnostics_.error(entry.value.place, entry.key, "must be yes or no",
                               "Write no to hide it.");
            continue;
        }
        reader(entry.key, shown);
        if (i >= 0) look_of(out, first + static_cast<size_t>(i)).hidden = shown ? 0 : 1;
    }
}

void SeenPlanner::add_looks(const std::vector<LookSpec>& specs, TaskPlan::Looks& out,
                            Diagnostics& diagnostics) const {
    const auto index = [&](const std::string& name, const LookSpec& spec, const char* key,
                           const std::vector<std::string>& names, const char* unknown) {
        return name.empty() ? -1 : look_up(names, name, spec.place, key, unknown, diagnostics);
    };
    for (const LookSpec& spec : specs) {
        const int named = static_cast<int>(!spec.body.empty()) +
                          static_cast<int>(!spec.finger.empty()) +
                          static_cast<int>(!spec.target.empty());
        if (named != 1)
            diagnostics.error(spec.place, "look",
                              named == 0 ? "does not say of what" : "is of one thing only",
                              "Give it one of body, finger and target.");
        if (spec.colour.empty() && spec.scale == 1)
            diagnostics.error(spec.place, "look", "changes nothing",
                              "Give it colour, scale or both.");
        const int32_t rgb = scene::read_colour(spec.colour, spec.place, diagnostics);
        const int body = index(spec.body, spec, "body", bodies_, "no body");
        const int finger =
            index(spec.finger, spec, "finger", fingers_, "none of the scene's fingers");
        const int target = index(spec.target, spec, "target", regions_, "no region");
        if (target >= 0) out.targets.push_back({target, Vec3::Zero(), spec.scale, rgb});
        if (body < 0 && finger < 0) continue;
        frame::LookFrame& look =
            look_of(out, body >= 0 ? static_cast<size_t>(body)
                                   : bodies_.size() + static_cast<size_t>(finger));
        if (rgb >= 0) look.colour = rgb;
        look.scale *= spec.scale;
    }
}

void SeenPlanner::plan_task() {
    plan_.lines = lines(plan_.task.lines, plan_.task.place);
    for (const Block& block : plan_.task.blocks) {
        TaskPlan::Opening& opening = plan_.openings.emplace_back();
        opening.rest = block.rest;
        opening.first = static_cast<int>(plan_.pages.size());
        opening.pages = static_cast<int>(block.pages.size());
        if (block.rest > 0) {
            plan_.rest = text(kRest, block.place, "rest");
            plan_.countdown = text(kCountdown, block.place, "rest");
        }
        for (const PageSpec& page : block.pages) {
            if (page.text.empty() && page.picture.empty())
                diagnostics_.error(page.place, "pages", "this page shows nothing",
                                   "Give it text, picture or both.");
            if (!page.key.empty() && !is_key(page.key))
                diagnostics_.error(page.place, "key", fmt::format("'{}' is no key", page.key),
                                   "Write one letter or digit, or leave it out: any will do.");
            plan_.pages.push_back({page, text(page.text, page.place, "text")});
        }
    }
}

}  // namespace dihaptic::task
