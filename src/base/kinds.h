// Configuration structs (base/field.h) whose keys depend on their kind: a sphere has a radius, and
// a box has a size. A function that is found by argument-dependent lookup returns such a struct
// once for each kind:
//
//     inline Kinds<Ball> kinds_of(const Ball& ball) {
//         return each_kind<BallKind>("kind", ball, [](Ball& b, BallKind kind) { b.kind = kind; });
//     }
//
// docs/reference.md and the schemas for editors are generated from the result.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "base/field.h"

namespace dihaptic {

template <class Struct>
struct Kinds {
    std::string_view key;  ///< the key in the file that gives the kind
    /// The word for each kind, with a struct of that kind; "" stands for any other word.
    std::vector<std::pair<std::string_view, Struct>> each;
};

template <class Struct>
concept HasKinds = requires(const Struct& s) {
    kinds_of(s);
};

/// Returns one struct for each value of an enum; `set` stores the value in the struct.
template <NamedEnum E, class Struct, class Set>
Kinds<Struct> each_kind(std::string_view key, const Struct& value, const Set& set) {
    static constexpr auto kNames = enum_names(E{});
    Kinds<Struct> out{key, {}};
    for (size_t i = 0; i < kNames.size(); ++i)
        set(out.each.emplace_back(kNames[i], value).second, static_cast<E>(i));
    return out;
}

}  // namespace dihaptic
