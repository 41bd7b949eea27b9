// Wraps the few parts of HDF5's C interface that session.nwb needs, with handles that close
// themselves.
#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace dihaptic::recording::hdf5 {

// HDF5 crashes when it closes objects that it could not write for lack of space, at the latest at
// the program's end. Therefore, once a call has failed, its thread closes nothing until it calls
// create_file() again, and nothing is closed at the program's end either. The leak is small, and
// the file's space is released when it is truncated to zero length, as write_nwb() does.

/// The reason why a file could not be written, and the system's errno; 0 if HDF5 gives none.
struct WriteFailure : std::runtime_error {
    WriteFailure(const std::string& why, int number) : std::runtime_error(why), error(number) {}
    int error;
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
    }  // NOLINT(google-explicit-constructor): used in place of the id

  private:
    hid_t id_ = -1;
};

Id create_file(const std::string& path);
/// Writes all buffered data. Call it while all objects are still open, since closing them cannot
/// throw.
void flush(hid_t file);
/// Closes the file; everything in it must be closed. Throws WriteFailure unless the whole file was
/// written.
void close(Id file);
/// Number of rows of a dataset in a file; -1 if there is no such dataset, or it cannot be read.
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

enum class Numbers {
    real,   ///< 32-bit floating point
    exact,  ///< 64-bit floating point
    whole,  ///< 64-bit integers
};

/// A compressed dataset that grows as rows are added. With one column it is one-dimensional.
class Rows {
  public:
    Rows(hid_t parent, const std::string& name, size_t columns, Numbers numbers = Numbers::real);

    void add(const double* row);
    /// Writes the buffered rows; call it before the file is closed.
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
