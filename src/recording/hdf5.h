// The little of HDF5's C interface that session.nwb needs, with handles that close themselves.
#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace dihaptic::recording::hdf5 {

// HDF5 crashes when it closes, at the program's end at the latest, what it could not write for lack
// of space. So once a call has failed nothing is closed any more until the next create_file(), and
// at the program's end neither. What that leaks is small, and the file gives its space back when it
// is cut to nothing, as write_nwb() does.

/// Why a file could not be written.
struct WriteFailure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Owns an identifier of any kind. Throws WriteFailure when HDF5 gave an invalid one.
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
/// Writes everything that is buffered. Call it while all that was made is open: closing cannot
/// throw.
void flush(hid_t file);
/// Closes the file, after everything in it. Throws WriteFailure unless the whole file was written.
void close(Id file);
/// Rows of a dataset in a file; -1: there is no such dataset, or it cannot be read.
int64_t rows_of(const std::string& file, const std::string& dataset);
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

enum class Numbers { real, whole };  ///< of 32 bits, or integers of 64

/// A compressed dataset of rows that grows as they are added. One column: one-dimensional.
class Rows {
  public:
    Rows(hid_t parent, const std::string& name, size_t columns, Numbers numbers = Numbers::real);

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
