#include "recording/hdf5.h"

#include <zlib.h>

#include <array>
#include <bit>
#include <new>
#include <optional>

#include "base/number.h"

namespace dihaptic::recording::hdf5 {
namespace {

constexpr hsize_t kChunkRows = 4096;
constexpr unsigned kDeflate = 3;  // compression level; higher ones take longer for little gain

/// Why an HDF5 call has failed in this thread since the thread's last create_file(), if any has.
thread_local std::optional<WriteFailure> failure;

/// Stores the system's message found in HDF5's error stack, such as "errno = 28, error message =
/// 'No space left on device'".
void note_failure() {
    if (failure) return;
    failure.emplace("HDF5 gives no reason", 0);
    const auto look = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        const std::string text = error->desc == nullptr ? "" : error->desc;
        const auto after = [&](const std::string& key) {
            const size_t from = text.find(key);
            return from == std::string::npos ? std::string() : text.substr(from + key.size());
        };
        const std::string message = after("error message = '");
        if (message.empty()) return 0;
        const std::string number = after("errno = ");
        static_cast<std::optional<WriteFailure>*>(data)->emplace(
            message.substr(0, message.find('\'')),
            whole_number<int>(number.substr(0, number.find(','))).value_or(0));
        return 1;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &failure);
}

void check(herr_t status) {
    if (status < 0) note_failure();
    if (failure) throw *failure;
}

Id string_type() {
    Id type(H5Tcopy(H5T_C_S1));
    check(H5Tset_size(type, H5T_VARIABLE));
    check(H5Tset_cset(type, H5T_CSET_UTF8));
    return type;
}

std::vector<const char*> pointers(const std::vector<std::string>& values) {
    std::vector<const char*> out;
    out.reserve(values.size());
    for (const std::string& value : values) out.push_back(value.c_str());
    return out;
}

Id scalar() {
    return Id(H5Screate(H5S_SCALAR));
}

Id list(size_t size) {
    const hsize_t extent = size;
    return Id(H5Screate_simple(1, &extent, nullptr));
}

void attribute(hid_t object, const std::string& name, hid_t type, hid_t space, const void* data) {
    const Id id(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
    check(H5Awrite(id, type, data));
}

Id dataset(hid_t parent, const std::string& name, hid_t type, hid_t space, const void* data) {
    Id id(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    // HDF5 would fill a megabyte with zeros for each dataset of texts
    const Id transfer(H5Pcreate(H5P_DATASET_XFER));
    check(H5Pset_buffer(transfer, 4096, nullptr, nullptr));
    check(H5Dwrite(id, type, H5S_ALL, H5S_ALL, transfer, data));
    return id;
}

}  // namespace

Id::Id(hid_t id) : id_(id) {
    check(id < 0 ? -1 : 0);
}

Id::~Id() {
    if (id_ >= 0 && !failure && H5Idec_ref(id_) < 0) note_failure();
}

Id& Id::operator=(Id&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
}

Id create_file(const std::string& path) {
    H5dont_atexit();
    failure.reset();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are thrown, not printed
    return Id(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
}

void flush(hid_t file) {
    check(H5Fflush(file, H5F_SCOPE_GLOBAL));
}

void close(Id file) {
    flush(file);
    { const Id last = std::move(file); }
    check(0);
}

int64_t rows_of(const std::string& file, const std::string& dataset) {
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t data = opened < 0 ? -1 : H5Dopen2(opened, dataset.c_str(), H5P_DEFAULT);
    const hid_t space = data < 0 ? -1 : H5Dget_space(data);
    hsize_t extent[H5S_MAX_RANK] = {};
    const int rank = space < 0 ? -1 : H5Sget_simple_extent_dims(space, extent, nullptr);
    if (space >= 0) H5Sclose(space);
    if (data >= 0) H5Dclose(data);
    if (opened >= 0) H5Fclose(opened);
    return rank < 1 ? -1 : static_cast<int64_t>(extent[0]);
}

Id create_group(hid_t parent, const std::string& name) {
    return Id(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
}

void write_attribute(hid_t object, const std::string& name, const std::string& value) {
    const char* text = value.c_str();
    attribute(object, name, string_type(), scalar(), &text);
}

void write_attribute(hid_t object, const std::string& name,
                     const std::vector<std::string>& values) {
    attribute(object, name, string_type(), list(values.size()), pointers(values).data());
}

void write_attribute(hid_t object, const std::string& name, double value) {
    attribute(object, name, H5T_NATIVE_DOUBLE, scalar(), &value);
}

void write_attribute(hid_t object, const std::string& name, float value) {
    attribute(object, name, H5T_NATIVE_FLOAT, scalar(), &value);
}

void write_attribute(hid_t object, const std::string& name, int32_t value) {
    attribute(object, name, H5T_NATIVE_INT32, scalar(), &value);
}

Id write_dataset(hid_t parent, const std::string& name, const std::string& value) {
    const char* text = value.c_str();
    return dataset(parent, name, string_type(), scalar(), &text);
}

Id write_dataset(hid_t parent, const std::string& name, const std::vector<std::string>& values) {
    return dataset(parent, name, string_type(), list(values.size()), pointers(values).data());
}

Id write_dataset(hid_t parent, const std::string& name, double value) {
    return dataset(parent, name, H5T_NATIVE_DOUBLE, scalar(), &value);
}

Id write_dataset(hid_t parent, const std::string& name, const std::vector<double>& values) {
    return dataset(parent, name, H5T_NATIVE_DOUBLE, list(values.size()), values.data());
}

Id write_dataset(hid_t parent, const std::string& name, const std::vector<int64_t>& values) {
    return dataset(parent, name, H5T_NATIVE_INT64, list(values.size()), values.data());
}

namespace {

hid_t type_of(Numbers numbers) {
    if (numbers == Numbers::whole) return H5T_NATIVE_INT64;
    return numbers == Numbers::exact ? H5T_NATIVE_DOUBLE : H5T_NATIVE_FLOAT;
}

/// The bytes of a column's chunk as HDF5's shuffle filter has them: the first byte of each number,
/// then the second of each, and so on. Below the last row, there are zeros.
template <class T>
void shuffled(const std::vector<double>& rows, size_t columns, size_t column,
              std::vector<Bytef>& out) {
    out.assign(kChunkRows * sizeof(T), 0);
    for (size_t row = 0; row * columns < rows.size(); ++row) {
        const auto bytes = std::bit_cast<std::array<Bytef, sizeof(T)>>(
            static_cast<T>(rows[row * columns + column]));
        for (size_t i = 0; i < bytes.size(); ++i) out[i * kChunkRows + row] = bytes[i];
    }
}

/// Compresses chunks as HDF5's deflate filter does, but keeps its tables from one to the next.
class Deflate {
  public:
    Deflate() {
        if (deflateInit(&stream_, kDeflate) != Z_OK) throw std::bad_alloc();
    }
    ~Deflate() { deflateEnd(&stream_); }
    Deflate(const Deflate&) = delete;
    Deflate& operator=(const Deflate&) = delete;

    /// False if the bytes become no fewer.
    bool compress(std::vector<Bytef>& bytes, std::vector<Bytef>& out) {
        out.resize(bytes.size());
        deflateReset(&stream_);
        stream_.next_in = bytes.data();
        stream_.avail_in = static_cast<uInt>(bytes.size());
        stream_.next_out = out.data();
        stream_.avail_out = static_cast<uInt>(out.size());
        if (deflate(&stream_, Z_FINISH) != Z_STREAM_END) return false;
        out.resize(stream_.total_out);
        return true;
    }

  private:
    z_stream stream_{};
};

}  // namespace

Rows::Rows(hid_t parent, const std::string& name, size_t columns, Numbers numbers)
    : columns_(columns), numbers_(numbers) {
    const int rank = columns == 1 ? 1 : 2;
    const hsize_t none[2] = {0, columns};
    const hsize_t most[2] = {H5S_UNLIMITED, columns};
    const hsize_t chunk[2] = {kChunkRows, 1};  // single columns, which compress better
    const Id space(H5Screate_simple(rank, none, most));
    const Id create(H5Pcreate(H5P_DATASET_CREATE));
    check(H5Pset_chunk(create, rank, chunk));
    check(H5Pset_shuffle(create));
    check(H5Pset_deflate(create, kDeflate));
    dataset_ = Id(H5Dcreate2(parent, name.c_str(), type_of(numbers), space, H5P_DEFAULT, create,
                             H5P_DEFAULT));
    buffer_.reserve(kChunkRows * columns);
}

void Rows::add(const double* row) {
    buffer_.insert(buffer_.end(), row, row + columns_);
    if (buffer_.size() >= kChunkRows * columns_) write_chunks();
}

void Rows::finish() {
    if (!buffer_.empty()) write_chunks();
}

void Rows::write_chunks() {
    // by itself, HDF5 takes more than twice as long: it passes rows through a cache, fills chunks
    // with zeros first, and converts numbers one after the other
    thread_local Deflate deflate;
    thread_local std::vector<Bytef> bytes, compressed;
    constexpr uint32_t kNotCompressed = 1 << 1;  // the second filter
    const hsize_t extent[2] = {written_ + buffer_.size() / columns_, columns_};
    check(H5Dset_extent(dataset_, extent));
    for (size_t column = 0; column < columns_; ++column) {
        if (numbers_ == Numbers::whole) shuffled<int64_t>(buffer_, columns_, column, bytes);
        if (numbers_ == Numbers::exact) shuffled<double>(buffer_, columns_, column, bytes);
        if (numbers_ == Numbers::real) shuffled<float>(buffer_, columns_, column, bytes);
        const bool smaller = deflate.compress(bytes, compressed);
        const std::vector<Bytef>& out = smaller ? compressed : bytes;
        const hsize_t at[2] = {written_, column};
        check(H5Dwrite_chunk(dataset_, H5P_DEFAULT, smaller ? 0 : kNotCompressed, at, out.size(),
                             out.data()));
    }
    written_ = extent[0];
    buffer_.clear();
}

}  // namespace dihaptic::recording::hdf5
