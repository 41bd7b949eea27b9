// The little of HDF5's C interface that session.nwb needs, with handles that close themselves.
#pragma once

#include <hdf5.h>

#include <string>
#include <vector>

namespace dihaptic::recording::hdf5 {

/// Owns an identifier of any kind. Throws Error when HDF5 gave an invalid one.
class Id {
  public:
    Id() = default;
    explicit Id(hid_t id);
    ~Id();
    Id(Id&& other) noexcept : id_(other.id_) { other.id_ = -1; }
    Id& operator=(Id&& other) noexcept;
    operator hid_t() const {
        return id_;
    }  // NOLINT(google-explicit-constructor): it stands for the id

  private:
    hid_t id_ = -1;
};

Id create_file(const std::string& path);
Id create_group(hid_t parent, const std::string& name);

void write_attribute(hid_t object, const std::string& name, const std::string& value);
void write_attribute(hid_t object, const std::string& name, const std::vector<std::string>& values);
void write_attribute(hid_t object, const std::string& name, double value);
void write_attribute(hid_t object, const std::string& name, float value);
void write_attribute(hid_t object, const std::string& name, int32_t value);

Id write_dataset(hid_t parent, const std::string& name, const std::string& value);
Id write_dataset(hid_t parent, const std::string& name, const std::vector<std::string>& values);
Id write_dataset(hid_t parent, const std::string& name, double value);
Id write_dataset(hid_t parent, const std::string& name, const std::vector<double>& values);
Id write_dataset(hid_t parent, const std::string& name, const std::vector<int64_t>& values);

/// A compressed dataset of rows that grows as they are added. One column: one-dimensional.
class Rows {
  public:
    Rows(hid_t parent, const std::string& name, size_t columns);

    void add(const double* row);
    /// Writes what is buffered; call it before the file is closed.
    void flush();
    hid_t dataset() const { return dataset_; }
    size_t count() const { return written_ + buffer_.size() / columns_; }

  private:
    Id dataset_;
    size_t columns_;
    size_t written_ = 0;
    std::vector<double> buffer_;
};

}  // namespace dihaptic::recording::hdf5
