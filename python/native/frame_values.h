// FrameValue and FrameRows read a frame's values, by name, as numbers and arrays for Python.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "frame/frame.h"
#include "recording/frame_row.h"

namespace dihaptic::python {

/// Numbers from Python, of any type.
using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// One value of a frame, by its list ("": the tick itself), the item in it, and its name.
class FrameValue {
  public:
    FrameValue(const std::string& list, size_t item, const std::string& name)
        : list_(list), item_(item), name_(name) {}

    /// None if the frame has no such value.
    pybind11::object of(const frame::Frame& frame) {
        found_ = pybind11::none();
        here_ = list_.empty();
        frame::Frame::visit(frame, *this);
        return found_;
    }

    // as a visitor
    template <class T>
    void operator()(const T& value, const frame::Term& term) {
        if (!here_ || name_ != term.name) return;
        if constexpr (std::is_same_v<T, Vec3>) {
            found_ = pybind11::cast(value);
        } else if constexpr (std::is_same_v<T, Quat>) {
            found_ = pybind11::cast(Eigen::Vector4d(value.w(), value.x(), value.y(), value.z()));
        } else if constexpr (std::is_same_v<T, Time>) {
            found_ = pybind11::cast(value.count());
        } else if constexpr (std::is_enum_v<T>) {
            found_ = pybind11::cast(static_cast<int>(value));
        } else {
            found_ = pybind11::cast(value);
        }
    }
    template <class T>
    void each(const char* list, const std::vector<T>& items, const char*) {
        if (list_ != list || item_ >= items.size()) return;
        here_ = true;
        T::visit(items[item_], *this);
        here_ = false;
    }
    template <class T>
    void changed(const char* list, const std::vector<T>& items, const std::vector<uint16_t>&,
                 const char* meaning) {
        each(list, items, meaning);
    }

  private:
    std::string list_;
    size_t item_;
    std::string name_;
    bool here_ = false;
    pybind11::object found_;
};

/// The items of one list of a frame as rows of numbers, with the columns of session.nwb.
class FrameRows {
  public:
    explicit FrameRows(const std::string& list) : list_(list) {}

    std::vector<std::vector<double>> of(const frame::Frame& frame) {
        frame::Frame::visit(frame, *this);
        return rows_;
    }

    // as a visitor
    template <class T>
    void operator()(const T&, const frame::Term&) {}  // a tick has it once
    template <class T>
    void each(const char* list, const std::vector<T>& items, const char*) {
        if (list_ != list) return;
        for (const T& item : items) {
            recording::FrameRow row;
            T::visit(item, row);
            rows_.push_back(std::move(row.numbers));
        }
    }
    template <class T>
    void changed(const char* list, const std::vector<T>& items, const std::vector<uint16_t>&,
                 const char* meaning) {
        each(list, items, meaning);
    }

  private:
    std::string list_;
    std::vector<std::vector<double>> rows_;
};

}  // namespace dihaptic::python
