// References: names by which one part of a file means another.
#pragma once

#include <string>
#include <vector>

#include "base/field.h"

namespace dihaptic::task {

/// A name of a T as a file has it, and once it has been looked up (plan/names.h), which T it is.
template <class T>
struct Ref : std::string {
    int index = -1;  ///< -1: there is none, or it has not been looked up

    using std::string::string;
    Ref(std::string name)  // NOLINT(google-explicit-constructor)
        : std::string(std::move(name)) {}
};

/// Names of several. `List`: Texts, where the file may have one name alone, or else a vector.
template <class T, class List = Texts>
struct Refs : List {
    std::vector<int> indices;  ///< of those that there are

    using List::List;
};
template <class T>
using RefList = Refs<T, std::vector<std::string>>;

}  // namespace dihaptic::task
