// References: names by which one part of a file refers to another.
#pragma once

#include <string>
#include <vector>

#include "base/field.h"

namespace dihaptic::task {

/// The name of a T as written in a file and, once the name has been looked up, the index of that T
/// (plan/names.h).
template <class T>
struct Ref : std::string {
    int index = -1;  ///< -1 if there is none or the name has not been looked up yet

    using std::string::string;
    Ref(std::string name)  // NOLINT(google-explicit-constructor)
        : std::string(std::move(name)) {}
};

/// A list of names. `List` is Texts if the file may give a single name without brackets; otherwise,
/// it is a vector.
template <class T, class List = Texts>
struct Refs : List {
    std::vector<int> indices;  ///< indices of those names that exist

    using List::List;
};
template <class T>
using RefList = Refs<T, std::vector<std::string>>;

}  // namespace dihaptic::task
