// Iterates over the parts of a struct that have a given type, using the struct's visit()
// (base/field.h).
#pragma once

#include <concepts>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/field.h"

namespace dihaptic::task {

/// Combines several functions into an overload set.
template <class... F>
struct Overloaded : F... {
    using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

/// A visitor that calls f(value, key, place) for each value that f accepts, in a struct and in the
/// structs nested in it. `place` is that of the struct that directly contains the value.
template <class F>
class Each {
  public:
    explicit Each(F& f) : f_(f) {}

    template <class T>
    void operator()(std::string_view key, T& value, Field = {}) {
        key_ = key;
        look_into(value);
    }
    template <class T>
    void look_into(T& value) {
        if constexpr (std::invocable<F&, T&, std::string_view, const Place&>) {
            f_(value, key_, *place_);
        } else if constexpr (Described<T, Each>) {
            const Place* const outer = place_;
            if constexpr (requires { value.place.line; }) place_ = &value.place;
            value.visit(*this);
            place_ = outer;
        }
    }
    template <class T>
    void look_into(std::optional<T>& value) {
        if (value) look_into(*value);
    }
    template <class T>
    requires Described<T, Each>
    void look_into(std::vector<T>& values) {
        for (T& value : values) look_into(value);
    }

  private:
    static inline const Place kNowhere{};

    F& f_;
    std::string_view key_;
    const Place* place_ = &kNowhere;
};

template <class Struct, class F>
void each(Struct& value, F f) {
    Each<F>(f).look_into(value);
}

}  // namespace dihaptic::task
