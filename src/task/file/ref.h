// References: names by which one part of a file refers to another.
#pragma once

#include <string>
#include <vector>

#include "base/field.h"

namespace dihaptic::task {

/// The name of a T as written in a file, and the index of that T once it has been looked up
/// (plan/names.h).
template <class T>
struct Ref : std::string {
    int index = -1;  ///< -1: none, or not looked up yet

    using std::string::string;
    Ref(std::string name)  // NOLINT(google-explicit-constructor)
        : std::string(std::move(name)) {}
};

/// Several names. `List`: Texts if a single name may stand without brackets in the file; otherwise
/// a vector.
template <class T, class List = Texts>
struct Refs : List {
    std::vector<int> indices;  ///< indices of the names that exist

    using List::List;
};
template <class T>
using RefList = Refs<T, std::vector<std::string>>;

}  // namespace dihaptic::task
