// Wraps the few parts of HDF5's C interface that session.nwb needs. Handles close themselves.
#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace dihaptic::recording::hdf5 {

// If the disk is full, HDF5 crashes when it closes objects that it could not write, or at the
// latest when the program ends. Therefore, once a call has failed, the thread closes nothing until
// it calls create_file() again, and nothing is closed at program exit either. The leak is small,
// and the file's disk space is released when the file is truncated to zero length, as write_nwb()
// does.

/// The reason why a file could not be written, with the system's errno, or 0 if HDF5 gives none.
struct WriteFailure : std::runtime_error {
    WriteFailure(const std::string& why, int number) : std::runtime_error(why), error(number) {}
    int error;
};

/// Owns an HDF5 identifier of any kind. Throws WriteFailure when HDF5 returned an invalid
/// identifier.
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
/// Writes all buffered data. Must be called while all objects are still open, because closing an
/// object cannot report an error.
void flush(hid_t file);
/// Closes the file, in which no object may be open any more. Throws WriteFailure unless the whole
/// file was written.
void close(Id file);
/// Number of rows in a dataset of a file; -1 if there is no such dataset or if it cannot be read.
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

/// A compressed dataset that grows as rows are added. If it has only one column, the dataset is
/// one-dimensional.
class Rows {
  public:
    Rows(hid_t parent, const std::string& name, size_t columns, Numbers numbers = Numbers::real);

    void add(const double* row);
    /// Writes the buffered rows; must be called after the last one, before the file is closed.
    void finish();
    hid_t dataset() const { return dataset_; }
    size_t count() const { return written_ + buffer_.size() / columns_; }

  private:
    void write_chunks();

    Id dataset_;
    size_t columns_;
    Numbers numbers_;
    size_t written_ = 0;
    std::vector<double> buffer_;
};

}  // namespace dihaptic::recording::hdf5
