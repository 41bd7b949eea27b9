#include "task/plan/seen_plan.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "frame/shown_texts.h"
#include "scene/colour.h"

namespace dihaptic::task {
namespace {

// maximum number of lines in a state, and of lines for the whole task
constexpr size_t kMostLines = 2;
constexpr size_t kMostInText = 4;                                   // numbers
static_assert(frame::TaskFrame::kMostLines == 2 * kMostLines + 2);  // countdown, feedback
static_assert(frame::TaskFrame::kMostNumbers == kMostInText * (1 + frame::TaskFrame::kMostLines));

constexpr const char* kRest = "Take a break";
constexpr const char* kCountdown = "{countdown}";
constexpr const char* kConfirm = "All answered. Enter: done; Backspace: change the last answer";

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

SeenPlanner::SeenPlanner(const Planning& given)
    : Planning(given), bodies_(scene.bodies.size()), fingers_(scene.fingers.size()) {
    plan.object = scene.object_index();
}

int SeenPlanner::text(const std::string& text, const Place& place, const char* key) {
    if (text.empty()) return -1;
    const auto found = std::find(plan.messages.begin(), plan.messages.end(), text);
    if (found != plan.messages.end()) return static_cast<int>(found - plan.messages.begin());
    plan.messages.push_back(text);
    std::vector<TextNumber> numbers;
    for (const frame::Placeholder& given : frame::placeholders(text)) {
        if (given.name.empty()) {
            diagnostics.error(place, key,
                              fmt::format("'{}' is not a valid number in a text",
                                          text.substr(given.begin, given.end - given.begin)),
                              "Write e.g. {trial_num} or {countdown:.1f}; for a brace, {{ or }}.");
            continue;
        }
        if (const auto named = number(given.name, place, key)) numbers.push_back(*named);
    }
    if (numbers.size() > kMostInText)
        diagnostics.error(
            place, key,
            fmt::format("has {} numbers, but at most {} are allowed", numbers.size(), kMostInText),
            "Leave some out, or move them to another line.");
    plan.numbers.push_back(std::move(numbers));
    return static_cast<int>(plan.messages.size()) - 1;
}

std::optional<TextNumber> SeenPlanner::number(const std::string& name, const Place& place,
                                              const char* key) {
    if (const auto figure = enum_named<Figure>(name)) return TextNumber{*figure, {}};
    Diagnostics unknown;
    Expression quantity = Expression::compile(name, plan.quantities, place, key, unknown);
    if (!unknown.has_errors() && quantity.type() == Expression::Type::number)
        return TextNumber{Figure{}, std::move(quantity)};
    std::vector<std::string> known = plan.quantities.names();
    const auto figures = enum_names(Figure{});
    known.insert(known.end(), figures.begin(), figures.end());
    const std::string guess = nearest(name, known);
    diagnostics.error(
        place, key, fmt::format("'{}' is not a number that a text can show", name),
        guess.empty() || guess == name
            ? fmt::format(
                  "Known: {}, and numbers that expressions can use, e.g. a variable or grip_force.",
                  fmt::join(figures, ", "))
            : fmt::format("Did you mean {}?", guess),
        choices_of(known));
    return {};
}

std::vector<int> SeenPlanner::lines(const std::vector<std::string>& texts, const Place& place) {
    if (texts.size() > kMostLines)
        diagnostics.error(
            place, "lines",
            fmt::format("there are {}, but at most {} are allowed", texts.size(), kMostLines),
            "Leave some out.");
    std::vector<int> out;
    for (const std::string& line : texts) {
        if (const int i = text(line, place, "lines"); i >= 0) out.push_back(i);
    }
    return out;
}

void SeenPlanner::plan_state(const State& state, TaskPlan::PlannedState& out) {
    for (const LookSpec& spec : state.look) {
        if (!spec.during.empty())
            diagnostics.error(spec.place, "during", "belongs to the looks of conditions",
                              "Leave it out: a state's look lasts as long as the state.");
    }
    check_looks(state.look, diagnostics);
    add_looks(state.look, kAnyState, out.looks);
    show(state.show, state.show.place.line > 0 ? state.show.place : state.place, out);
    if (state.countdown) {
        const bool ends = std::any_of(state.exits.begin(), state.exits.end(),
                                      [](const Exit& exit) { return exit.when == When::time; });
        if (!ends)
            diagnostics.error(state.place, "countdown",
                              "needs an exit by time, which this state does not have",
                              "Add e.g. - { when: time, after_s: 5, outcome: too late }.");
        out.lines.push_back(text(kCountdown, state.place, "countdown"));
    }
    for (const int line : lines(state.lines, state.place)) out.lines.push_back(line);
}

std::vector<int> SeenPlanner::question(const AskSpec& ask, size_t number, const State& state) {
    std::vector<std::string> texts;
    if (state.form) {
        texts.push_back(
            fmt::format("{} of {}: {}", number, state.questions().size(), ask.question));
    } else if (!ask.question.empty()) {
        texts.push_back(ask.question);
    }
    texts.push_back(line_of(ask));
    if (texts.size() + state.lines.size() > kMostLines)
        diagnostics.error(state.place, "lines",
                          fmt::format("there are {}, including {} of the question, but at most {} "
                                      "are allowed",
                                      texts.size() + state.lines.size(), texts.size(), kMostLines),
                          "Leave some out, or write them into the message.");
    return lines(texts, ask.place);
}

std::vector<int> SeenPlanner::confirmation(const State& state) {
    return lines({kConfirm}, state.place);
}

void SeenPlanner::show(const Show& given, const Place& place, TaskPlan::PlannedState& out) {
    for (const std::string& name : given.targets) {
        const int i = names.find<Region>(name, place, "show", diagnostics);
        if (i >= 0) out.shown |= 1u << i;
    }
    out.holds_cursor = given.cursor == Cursor::held;
    if (!given.held_from.empty()) {
        out.held_from = names.find<State>(given.held_from, place, "held_from", diagnostics);
        if (!out.holds_cursor)
            diagnostics.error(place, "held_from", "is used only with 'cursor: held'",
                              "Write cursor: held, or leave it out.");
    }
    if (given.cursor == Cursor::no) {
        for (size_t i = 0; i < fingers_; ++i) look_of(out.looks, bodies_ + i).hidden = 1;
    }
    if (!given.object && plan.object < 0) {
        diagnostics.error(place, "object", "the scene has no movable object",
                          "Leave it out, or hide one of the bodies.");
    } else if (!given.object) {
        look_of(out.looks, static_cast<size_t>(plan.object)).hidden = 1;
    }
    show_some<scene::Body>(given.bodies, "bodies", 0, place, out.looks);
    show_some<scene::Finger>(given.fingers, "fingers", bodies_, place, out.looks);
}

template <class T>
void SeenPlanner::show_some(const Node& given, const char* key, size_t first, const Place& place,
                            TaskPlan::Looks& out) {
    if (given.kind == Node::Kind::null) return;
    if (given.kind != Node::Kind::mapping) {
        const std::vector<std::string>& all = names.all<T>();
        diagnostics.error(
            place, key, "must have one key for each hidden item",
            fmt::format("Write e.g. {}: {{ {}: no }}.", key, all.empty() ? "name" : all.front()));
        return;
    }
    FieldReader reader(given, diagnostics);
    for (const Node::Entry& entry : given.entries) {
        const int i = names.find<T>(entry.key, entry.value.place, key, diagnostics);
        bool shown = true;
        if (entry.value.kind != Node::Kind::scalar || entry.value.scalar.empty()) {
            diagnostics.error(entry.value.place, entry.key, "must be yes or no",
                              "Write 'no' to hide the item.");
            continue;
        }
        reader(entry.key, shown);
        if (i >= 0) look_of(out, first + static_cast<size_t>(i)).hidden = shown ? 0 : 1;
    }
}

void SeenPlanner::check_looks(const std::vector<LookSpec>& specs, Diagnostics& found) {
    for (const LookSpec& spec : specs) {
        const int named = static_cast<int>(!spec.body.empty()) +
                          static_cast<int>(!spec.finger.empty()) +
                          static_cast<int>(!spec.target.empty());
        if (named != 1)
            found.error(spec.place, "look",
                        named == 0 ? "does not name an object" : "names more than one object",
                        "Give it one of 'body', 'finger' and 'target'.");
        if (spec.colour.empty() && spec.scale == 1 && !spec.hidden)
            found.error(spec.place, "look", "changes nothing",
                        "Give it 'colour', 'scale' or 'hidden'.");
        scene::read_colour(spec.colour, spec.place, found);
    }
}

void SeenPlanner::add_looks(const std::vector<LookSpec>& specs, int state,
                            TaskPlan::Looks& out) const {
    Diagnostics reported;  // by check_looks()
    for (const LookSpec& spec : specs) {
        const std::vector<int>& during = spec.during.indices;
        if (!during.empty() && std::ranges::find(during, state) == during.end()) continue;
        const int32_t rgb = scene::read_colour(spec.colour, spec.place, reported);
        if (spec.target.index >= 0)
            out.targets.push_back({spec.target.index, Vec3::Zero(), spec.scale, rgb});
        if (spec.target.index >= 0 && spec.hidden) out.hidden_targets |= 1u << spec.target.index;
        const int body = spec.body.index;
        const int finger = spec.finger.index;
        if (body < 0 && finger < 0) continue;
        frame::LookFrame& look = look_of(
            out, body >= 0 ? static_cast<size_t>(body) : bodies_ + static_cast<size_t>(finger));
        if (rgb >= 0) look.colour = rgb;
        look.scale *= spec.scale;
        if (spec.hidden) look.hidden = 1;
    }
}

void SeenPlanner::plan_task() {
    plan.lines = lines(plan.task.lines, plan.task.place);
    for (const Block& block : plan.task.blocks) {
        TaskPlan::Opening& opening = plan.openings.emplace_back();
        opening.rest = block.rest;
        opening.first = static_cast<int>(plan.pages.size());
        opening.pages = static_cast<int>(block.pages.size());
        if (block.rest > 0) {
            plan.rest = text(kRest, block.place, "rest");
            plan.countdown = text(kCountdown, block.place, "rest");
        }
        for (const PageSpec& page : block.pages) {
            if (page.text.empty() && page.picture.empty())
                diagnostics.error(page.place, "pages", "a page has neither text nor a picture",
                                  "Give the page text, picture or both.");
            if (!page.key.empty() && !is_key(page.key))
                diagnostics.error(page.place, "key",
                                  fmt::format("'{}' is not a valid key", page.key),
                                  "Write one letter or digit, or leave it out to accept any key.");
            plan.pages.push_back({page, text(page.text, page.place, "text")});
        }
    }
}

}  // namespace dihaptic::task
