#include "task/expression/quantities.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/unmeasured.h"
#include "frame/displayed.h"
#include "model/grasp.h"

namespace dihaptic::task {
namespace {

constexpr int kComponent = sizeof(double);  // offset between the components of a vector [bytes]

/// The part of `name` after the thing's name and a dot; "" if `name` is just the thing's name.
/// Returns nullopt if `name` belongs to something else.
std::optional<std::string_view> member_of(std::string_view name, const std::string& thing) {
    if (!name.starts_with(thing)) return std::nullopt;
    name.remove_prefix(thing.size());
    if (name.empty()) return name;
    if (!name.starts_with('.')) return std::nullopt;
    return name.substr(1);
}

/// Returns -1 if `member` is `whole`, the index of the component if `member` is a component of
/// `whole`, and nullopt otherwise.
std::optional<int> component_of(std::string_view member, std::string_view whole, int count = 3) {
    if (!member.starts_with(whole)) return std::nullopt;
    std::string_view rest = member.substr(whole.size());
    if (rest.empty()) return -1;
    if (!whole.empty()) {
        if (!rest.starts_with('.')) return std::nullopt;
        rest.remove_prefix(1);
    }
    const size_t i =
        rest.size() == 1 ? std::string_view("xyzw").find(rest) : std::string_view::npos;
    if (i >= static_cast<size_t>(count)) return std::nullopt;
    return static_cast<int>(i);
}

/// Whether the contact's body belongs to the thing. Fingers are numbered after the scene's bodies.
bool is_thing(const Quantities::Thing& thing, int body, int bodies) noexcept {
    const int finger = body - bodies;
    if (finger < 0) return body == thing.body;
    return scene::contains(thing.fingers, static_cast<size_t>(finger));
}

/// The pinch force of a hand: half the sum of the normal forces of its fingers along the axis from
/// its first finger to the middle of the others, computed in the same way as the grip_force of all
/// fingers.
double grip_of(const scene::FingerSet& hand, const frame::Frame& last) noexcept {
    std::array<size_t, scene::kMostFingers> fingers{};
    size_t count = 0;
    for (size_t i = 0; i < last.fingers.size(); ++i) {
        if (scene::contains(hand, i)) fingers[count++] = i;
    }
    if (count < 2) return kUnmeasured;
    const Vec3 axis = model::grasp_axis(
        count, [&](size_t i) -> const Vec3& { return last.fingers[fingers[i]].p_WP; });
    const auto bodies = static_cast<int>(last.bodies.size());
    double squeeze = 0;
    for (const frame::ContactFrame& contact : last.contacts) {
        for (size_t i = 0; i < count; ++i) {
            const int proxy = bodies + static_cast<int>(fingers[i]);
            if (contact.a != proxy && contact.b != proxy) continue;
            const double on_proxy = (contact.b == proxy ? 1 : -1) * contact.n_W.dot(axis);
            squeeze += (i == 0 ? -1 : 1) * contact.normal_force * on_proxy;
        }
    }
    return squeeze / 2;
}

double fingers_that_press(const Quantities::Thing& body, const Quantities::Thing& who,
                          const frame::Frame& last) noexcept {
    const auto bodies = static_cast<int>(last.bodies.size());
    scene::FingerSet which;
    for (const frame::ContactFrame& contact : last.contacts) {
        if (contact.normal_force <= 0 || (contact.a != body.body && contact.b != body.body))
            continue;
        const int other = (contact.a == body.body ? contact.b : contact.a) - bodies;
        const auto finger = static_cast<size_t>(other);
        if (other >= 0 && scene::contains(who.fingers, finger)) which[finger] = true;
    }
    return static_cast<double>(which.count());
}

double normal_force_between(const Quantities::Thing& a, const Quantities::Thing& b,
                            const frame::Frame& last) noexcept {
    const auto bodies = static_cast<int>(last.bodies.size());
    double sum = 0;
    for (const frame::ContactFrame& contact : last.contacts) {
        const bool ab = is_thing(a, contact.a, bodies) && is_thing(b, contact.b, bodies);
        const bool ba = is_thing(b, contact.a, bodies) && is_thing(a, contact.b, bodies);
        if (ab || ba) sum += contact.normal_force;
    }
    return sum;
}

}  // namespace

struct Quantities::Member {
    std::string_view name;
    Source::Format format;
    int offset;
    int count;  // number of components
    Dimension dimension;
    double scale;
};

/// A visitor that finds the offset of each quantity within an item of the Frame.
struct Quantities::Lister {
    const void* item;
    std::vector<Member> members{};

    template <class Value>
    void operator()(const Value& value, const frame::Term& term) {
        using Format = Source::Format;
        Format format = Format::f64;
        int count = 1;
        if constexpr (std::is_same_v<Value, Vec3>) {
            count = 3;
        } else if constexpr (std::is_same_v<Value, Quat>) {
            count = 4;
        } else if constexpr (!std::is_same_v<Value, double>) {
            static_assert(sizeof(Value) == 4 || sizeof(Value) == 8);
            format = sizeof(Value) == 8                ? Format::i64
                     : std::is_same_v<Value, uint32_t> ? Format::u32
                                                       : Format::i32;
        }
        const auto offset = reinterpret_cast<const char*>(&value) - static_cast<const char*>(item);
        const auto unit = unit_in_si(term.unit);
        members.push_back(
            {term.name, format, static_cast<int>(offset), count, unit.dimension, unit.si});
    }
    template <class Item>
    void each(const char* /*name*/, const std::vector<Item>& /*list*/, const char* /*meaning*/) {}
    template <class Item>
    void changed(const char* /*name*/, const std::vector<Item>& /*list*/,
                 const std::vector<uint16_t>& /*which*/, const char* /*meaning*/) {}
};

template <class Item>
std::vector<Quantities::Member> Quantities::members() {
    const Item item{};
    Lister lister{&item};
    if constexpr (std::is_same_v<Item, frame::Handle>) {
        lister(item.p_WH, {"handle_position", "m", "W", ""});
        lister(item.v_WH, {"handle_velocity", "m/s", "W", ""});
        lister(item.R_WH, {"handle_orientation", "1", "W", ""});
        lister(item.w_WH, {"handle_angular_velocity", "rad/s", "W", ""});
    } else {
        Item::visit(item, lister);
    }
    return lister.members;
}

const std::vector<Quantities::Member>& Quantities::members_of(Source::From from) {
    using From = Source::From;
    static const std::map<From, std::vector<Member>> kMembers{
        {From::frame, members<frame::Frame>()},    {From::finger, members<frame::FingerFrame>()},
        {From::handle, members<frame::Handle>()},  {From::turn, members<frame::TurnFrame>()},
        {From::body, members<frame::BodyFrame>()}, {From::joint, members<frame::JointFrame>()},
    };
    return kMembers.at(from);
}

Quantities::Quantities(Names names) : names_(std::move(names)) {
    const scene::FingerSet all = scene::first_fingers(names_.fingers.size());
    names_.hands.push_back({"hand", all});
    names_.hands.push_back({"", all});
    add("time_in_state", {.dimension = dimension(Quantity::time), .kind = Kind::figure}, 1);
    add("time_in_trial", {.dimension = dimension(Quantity::time), .kind = Kind::figure}, 1);
    add("trial_num", {.kind = Kind::figure}, 1);
    add("attempt", {.kind = Kind::figure}, 1);
    regions_ = static_cast<int>(values_.size());
    starts_ = regions_ + 4 * static_cast<int>(names_.regions.size());
    values_.resize(static_cast<size_t>(starts_) + 3 * names_.bodies.size(), 0.0);
}

Symbol Quantities::add(const std::string& name, Symbol symbol, int slots) {
    symbol.slot = static_cast<int>(values_.size());
    values_.resize(values_.size() + static_cast<size_t>(slots), 0.0);
    symbols_[name] = symbol;
    return symbol;
}

Symbol Quantities::define(std::string name, Dimension dimension, Kind kind) {
    return add(name, {.dimension = dimension, .kind = kind}, 1);
}

Symbol Quantities::define_unnamed(Dimension dimension) {
    const Symbol out{static_cast<int>(values_.size()), Symbol::Type::number, dimension,
                     Kind::figure};
    values_.push_back(kUnmeasured);
    return out;
}

Symbol Quantities::define_text(std::string name, std::vector<std::string> levels, Kind kind) {
    const Symbol out = add(name, {.type = Symbol::Type::text, .kind = kind}, 1);
    for (const std::string& level : levels) text(level);
    levels_[out.slot] = std::move(levels);
    return out;
}

int Quantities::text(std::string_view text) {
    const auto found = std::find(texts_.begin(), texts_.end(), text);
    if (found == texts_.end()) {
        texts_.emplace_back(text);
        return static_cast<int>(texts_.size()) - 1;
    }
    return static_cast<int>(found - texts_.begin());
}

const std::vector<std::string>* Quantities::levels(int slot) const {
    const auto found = levels_.find(slot);
    return found == levels_.end() ? nullptr : &found->second;
}

bool Quantities::has_level(std::string_view text) const {
    return std::ranges::any_of(levels_, [&](const auto& levels) {
        return std::ranges::find(levels.second, text) != levels.second.end();
    });
}

std::optional<Quantities::Thing> Quantities::thing(std::string_view name) const {
    const auto index = [&](const std::vector<std::string>& list) {
        return static_cast<size_t>(std::find(list.begin(), list.end(), name) - list.begin());
    };
    if (const size_t i = index(names_.fingers); i < names_.fingers.size())
        return Thing{-1, scene::finger_set(i)};
    if (const size_t i = index(names_.bodies); i < names_.bodies.size())
        return Thing{static_cast<int>(i), {}};
    for (const Names::Hand& hand : names_.hands) {
        if (hand.name == name) return Thing{-1, hand.fingers};
    }
    return std::nullopt;
}

std::optional<int> Quantities::region(std::string_view name) const {
    const auto found = std::find(names_.regions.begin(), names_.regions.end(), name);
    if (found == names_.regions.end()) return std::nullopt;
    return region(static_cast<size_t>(found - names_.regions.begin()));
}

std::vector<std::string> Quantities::things() const {
    std::vector<std::string> out = names_.bodies;
    out.insert(out.end(), names_.fingers.begin(), names_.fingers.end());
    for (const Names::Hand& hand : names_.hands) {
        if (!hand.name.empty()) out.push_back(hand.name);
    }
    return out;
}

std::vector<std::string> Quantities::names() const {
    std::vector<std::string> out;
    const auto add_members = [&](const std::string& before, Source::From from) {
        for (const Member& member : members_of(from))
            out.push_back(before + std::string(member.name));
    };
    const auto add_thing = [&](const std::string& name, std::initializer_list<const char*> more) {
        out.push_back(name);
        for (const char* member : more) out.push_back(name + "." + member);
    };
    for (const auto& [name, symbol] : symbols_) out.push_back(name);
    for (const std::string& name : names_.fingers) {
        add_thing(name, {"x", "y", "z", "speed", "shown"});
        add_members(name + ".", Source::From::finger);
        add_members(name + ".", Source::From::turn);
    }
    for (const std::string& name : names_.bodies) {
        add_thing(name, {"x", "y", "z", "speed", "start"});
        add_members(name + ".", Source::From::body);
    }
    for (const std::string& name : names_.joints) add_members(name + ".", Source::From::joint);
    for (const Names::Hand& hand : names_.hands) {
        if (!hand.name.empty()) add_thing(hand.name, {"x", "y", "z", "speed", "shown"});
    }
    for (const std::string& name : names_.regions) add_thing(name, {"x", "y", "z", "radius"});
    add_members("", Source::From::frame);
    return out;
}

std::optional<Symbol> Quantities::find(std::string_view name) {
    if (const auto known = symbols_.find(name); known != symbols_.end()) return known->second;
    const std::string whole(name);
    for (size_t i = 0; i < names_.fingers.size(); ++i) {
        if (const auto member = member_of(name, names_.fingers[i])) {
            if (const auto found = find_of_finger(whole, *member, static_cast<int>(i)))
                return found;
        }
    }
    for (size_t i = 0; i < names_.bodies.size(); ++i) {
        if (const auto member = member_of(name, names_.bodies[i])) {
            if (const auto found = find_of_body(whole, *member, static_cast<int>(i))) return found;
        }
    }
    if (const auto found = find_of_joint(whole)) return found;
    for (const Names::Hand& hand : names_.hands) {
        if (const auto member = member_of(name, hand.name)) {
            if (const auto found = find_of_hand(whole, *member, hand.fingers)) return found;
        }
    }
    for (size_t i = 0; i < names_.regions.size(); ++i) {
        if (const auto member = member_of(name, names_.regions[i])) {
            if (const auto found = find_of_region(*member, i)) return found;
        }
    }
    return find_member(whole, name, {.from = Source::From::frame});
}

std::optional<Symbol> Quantities::find_of_joint(const std::string& name) {
    for (size_t i = 0; i < names_.joints.size(); ++i) {
        const auto member = member_of(name, names_.joints[i]);
        if (!member) continue;
        const Source source{.from = Source::From::joint, .index = static_cast<int>(i)};
        if (const auto found = find_member(name, *member, source)) return found;
    }
    return std::nullopt;
}

std::optional<Symbol> Quantities::find_member(const std::string& name, std::string_view member,
                                              Source source) {
    for (const Member& known : members_of(source.from)) {
        const auto component = component_of(member, known.name, known.count == 1 ? 0 : known.count);
        if (!component || (*component < 0 && known.count == 4)) continue;
        source.format = known.format;
        source.offset = known.offset + kComponent * std::max(0, *component);
        source.scale = known.scale;
        const bool vector = *component < 0 && known.count == 3;
        const Symbol out = add(name,
                               {.type = vector ? Symbol::Type::vector : Symbol::Type::number,
                                .dimension = known.dimension},
                               vector ? 3 : 1);
        for (int i = 0; i < (vector ? 3 : 1); ++i) {
            source.slot = out.slot + i;
            sources_.push_back(source);
            source.offset += kComponent;
        }
        return out;
    }
    return std::nullopt;
}

std::optional<Symbol> Quantities::find_of_finger(const std::string& name, std::string_view member,
                                                 int i) {
    using From = Source::From;
    if (component_of(member, "shown"))
        return find_of_hand(name, member, scene::finger_set(static_cast<size_t>(i)));
    if (const auto component = component_of(member, "")) {
        const std::string position = "handle_position";
        return find_member(name, *component < 0 ? position : position + "." + std::string(member),
                           {.from = From::handle, .index = i});
    }
    if (member == "speed")
        return find_of_hand(name, member, scene::finger_set(static_cast<size_t>(i)));
    for (const From from : {From::handle, From::finger, From::turn}) {
        if (const auto found = find_member(name, member, {.from = from, .index = i})) return found;
    }
    return std::nullopt;
}

std::optional<Symbol> Quantities::find_of_body(const std::string& name, std::string_view member,
                                               int i) {
    const Source source{.from = Source::From::body, .index = i};
    if (const auto component = component_of(member, "start")) {
        return Symbol{start(static_cast<size_t>(i)) + std::max(0, *component),
                      *component < 0 ? Symbol::Type::vector : Symbol::Type::number,
                      dimension(Quantity::length), Kind::region};
    }
    if (const auto component = component_of(member, "")) {
        const std::string position = "position";
        return find_member(name, *component < 0 ? position : position + "." + std::string(member),
                           source);
    }
    if (member != "speed") return find_member(name, member, source);
    const auto found = find_member(name, "velocity.x", source);
    sources_.back().format = Source::Format::norm;
    return found;
}

/// Finds a quantity of a hand: the middle of its handles, the displayed position of this point, or
/// its speed.
std::optional<Symbol> Quantities::find_of_hand(const std::string& name, std::string_view member,
                                               const scene::FingerSet& fingers) {
    Source source{.from = Source::From::middle, .a = {-1, fingers}};
    if (member == "speed") {
        source.format = Source::Format::norm;
        const Symbol out = add(name, {.dimension = dimension(Quantity::speed)}, 1);
        source.slot = out.slot;
        sources_.push_back(source);
        return out;
    }
    if (member == "grip_force" && fingers.count() > 1) {
        return Symbol{slot_of({.from = Source::From::grip, .a = {-1, fingers}}),
                      Symbol::Type::number, dimension(Quantity::force)};
    }
    auto component = component_of(member, "");
    if (!component) component = component_of(member, "position");
    if (!component) {
        component = component_of(member, "shown");
        source.shown = true;
    }
    if (!component) return std::nullopt;
    const bool vector = *component < 0;
    const Symbol out = add(name,
                           {.type = vector ? Symbol::Type::vector : Symbol::Type::number,
                            .dimension = dimension(Quantity::length)},
                           vector ? 3 : 1);
    for (int i = 0; i < (vector ? 3 : 1); ++i) {
        source.index = vector ? i : *component;
        source.slot = out.slot + i;
        sources_.push_back(source);
    }
    return out;
}

std::optional<Symbol> Quantities::find_of_region(std::string_view member, size_t i) const {
    if (member == "radius")
        return Symbol{region(i) + 3, Symbol::Type::number, dimension(Quantity::length),
                      Kind::region};
    auto component = component_of(member, "");
    if (!component) component = component_of(member, "position");
    if (!component) return std::nullopt;
    return Symbol{region(i) + std::max(0, *component),
                  *component < 0 ? Symbol::Type::vector : Symbol::Type::number,
                  dimension(Quantity::length), Kind::region};
}

int Quantities::slot_of(Source source) {
    for (const Source& known : sources_) {
        if (known.from == source.from && known.a == source.a && known.b == source.b)
            return known.slot;
    }
    source.slot = static_cast<int>(values_.size());
    values_.push_back(0);
    sources_.push_back(source);
    return source.slot;
}

int Quantities::pressing(int body, const scene::FingerSet& fingers) {
    return slot_of({.from = Source::From::pressing, .a = {body, {}}, .b = {-1, fingers}});
}

int Quantities::contact_force(const Thing& a, const Thing& b) {
    return slot_of({.from = Source::From::contact, .a = a, .b = b});
}

/// Returns a component of the middle of the hand's handles, or the speed of this point.
double Quantities::middle(const Source& source, const frame::Frame& last,
                          std::span<const frame::Handle> handles) noexcept {
    const bool speed = source.format == Source::Format::norm;
    Vec3 sum = Vec3::Zero();
    for (size_t i = 0; i < handles.size(); ++i) {
        if (scene::contains(source.a.fingers, i)) sum += speed ? handles[i].v_WH : handles[i].p_WH;
    }
    const Vec3 mean = sum / static_cast<double>(source.a.fingers.count());
    if (speed) return mean.norm();
    return (source.shown ? frame::displayed_hand(last, source.a.fingers, mean)
                         : mean)[source.index];
}

double Quantities::read(const Source& source, const frame::Frame& last,
                        std::span<const frame::Handle> handles) noexcept {
    using From = Source::From;
    const char* item = nullptr;
    const auto look_in = [&](const auto& list) {
        const auto i = static_cast<size_t>(source.index);
        if (i < list.size()) item = reinterpret_cast<const char*>(&list[i]);
    };
    switch (source.from) {
        case From::frame:
            item = reinterpret_cast<const char*>(&last);
            break;
        case From::finger:
            look_in(last.fingers);
            break;
        case From::handle:
            look_in(handles);
            break;
        case From::turn:
            // turns do not store their finger, so there must be one for each finger
            if (last.turns.size() == last.fingers.size()) look_in(last.turns);
            break;
        case From::body:
            look_in(last.bodies);
            break;
        case From::joint:
            look_in(last.joints);
            break;
        case From::middle:
            return middle(source, last, handles);
        case From::pressing:
            return fingers_that_press(source.a, source.b, last);
        case From::contact:
            return normal_force_between(source.a, source.b, last);
        case From::grip:
            return grip_of(source.a.fingers, last);
    }
    if (item == nullptr) return kUnmeasured;
    return number_at(item + source.offset, source.format) * source.scale;
}

double Quantities::number_at(const char* at, Source::Format format) noexcept {
    const auto value = [&](auto as) {
        std::memcpy(&as, at, sizeof as);
        return as;
    };
    switch (format) {
        case Source::Format::f64:
            return value(double{});
        case Source::Format::i32:
            return value(int32_t{});
        case Source::Format::i64:
            return static_cast<double>(value(int64_t{}));
        case Source::Format::u32:
            return value(uint32_t{});
        case Source::Format::norm:
            break;
    }
    const auto v = value(std::array<double, 3>{});
    return Vec3(v[0], v[1], v[2]).norm();
}

void Quantities::update(const frame::Frame& last, std::span<const frame::Handle> handles) noexcept {
    for (const Source& source : sources_) set(source.slot, read(source, last, handles));
    if (!rates_.empty()) update_rates(last);
}

void Quantities::read_frame(const frame::Frame& last, std::span<const frame::Handle> handles,
                            std::span<double> values) const noexcept {
    for (const Source& source : sources_)
        values[static_cast<size_t>(source.slot)] = read(source, last, handles);
    for (const Rate& rate : rates_) {
        const auto at = static_cast<size_t>(rate.slot);
        if (!rate.of_handle) values[at] = values_[at];
    }
}

std::optional<int> Quantities::rate(int slot) {
    const auto known = std::find_if(rates_.begin(), rates_.end(),
                                    [&](const Rate& rate) { return rate.of == slot; });
    if (known != rates_.end()) return known->slot;
    const auto source = std::ranges::find(sources_, slot, &Source::slot);
    if (source == sources_.end()) return {};
    const bool of_handle = source->reads_handles();
    const int out = define_unnamed({}).slot;
    rates_.push_back({slot, out, of_handle});
    return out;
}

void Quantities::update_rates(const frame::Frame& last) noexcept {
    if (last.sequence < 0) return;
    if (last.sequence != sequence_ + 1) ticks_ = 0;
    sequence_ = last.sequence;
    const size_t at = ticks_ % kRateTicks;
    const double now = seconds(last.time);
    for (Rate& rate : rates_) {
        const double value = values_[static_cast<size_t>(rate.of)];
        const bool full = ticks_ >= kRateTicks;
        set(rate.slot, full ? (value - rate.past[at]) / (now - times_[at]) : kUnmeasured);
        rate.past[at] = value;
    }
    times_[at] = now;
    ++ticks_;
}

}  // namespace dihaptic::task
