#include "bench/contact_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::bench {
namespace {

/// An HDF5 identifier that closes itself.
struct Close {
    herr_t (*close)(hid_t);
    void operator()(const hid_t* id) const {
        close(*id);
        delete id;
    }
};
using Id = std::unique_ptr<const hid_t, Close>;

Id own(hid_t id, herr_t (*close)(hid_t)) {
    if (id < 0) return {nullptr, {close}};
    return {new hid_t(id), {close}};
}

constexpr auto kRemedy =
    "Give a file in the FCLIB layout: fclib_local/W/{m,n,nz,p,i,x} and fclib_local/vectors/{q,mu}.";

/// Largest problem: W is stored as a dense matrix, of which the solvers make several copies.
constexpr size_t kMostContacts = 2000;
constexpr hssize_t kMostNumbers = 9 * kMostContacts * kMostContacts;

template <class T>
std::vector<T> read(hid_t file, const std::string& path, hid_t type, const std::string& name) {
    const Id dataset = own(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
    if (!dataset) throw Error({name, 0}, path, "is missing", kRemedy);
    const Id space = own(H5Dget_space(*dataset), H5Sclose);
    const hssize_t count = space ? H5Sget_simple_extent_npoints(*space) : -1;
    if (count > kMostNumbers)
        throw Error({name, 0}, path,
                    fmt::format("has {} numbers, more than {}", count, kMostNumbers), kRemedy);
    std::vector<T> out(static_cast<size_t>(std::max<hssize_t>(count, 0)));
    if (count <= 0 || H5Dread(*dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) < 0)
        throw Error({name, 0}, path, "cannot be read", kRemedy);
    return out;
}

Id open_file(const std::string& name) {
    if (!std::filesystem::is_regular_file(name))
        throw Error({name, 0}, "", "there is no such file", "Check the name and the folder.");
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // we report errors ourselves
    Id file = own(H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file) {
        const bool signed_as_one = H5Fis_hdf5(name.c_str()) > 0;
        throw Error(
            {name, 0}, "",
            signed_as_one ? "is an HDF5 file, but damaged or cut short" : "is not an HDF5 file",
            kRemedy);
    }
    return file;
}

/// Contents of a file, unchanged, with W in compressed columns or rows.
struct Fclib {
    static constexpr int kColumns = -1;
    static constexpr int kRows = -2;
    std::vector<double> q;
    std::vector<double> mu;
    int layout = 0;  ///< kColumns or kRows
    std::vector<int> p;
    std::vector<int> i;
    std::vector<double> x;
};

Fclib read_fclib(const std::string& name) {
    const Id file = open_file(name);
    const auto integers = [&](const char* path) {
        return read<int>(*file, path, H5T_NATIVE_INT, name);
    };
    const auto numbers = [&](const char* path) {
        return read<double>(*file, path, H5T_NATIVE_DOUBLE, name);
    };
    Fclib out;
    out.q = numbers("fclib_local/vectors/q");
    out.mu = numbers("fclib_local/vectors/mu");
    out.layout = integers("fclib_local/W/nz").front();
    out.p = integers("fclib_local/W/p");
    out.i = integers("fclib_local/W/i");
    out.x = numbers("fclib_local/W/x");
    return out;
}

void require(bool holds, const std::string& name, const char* key, const char* otherwise) {
    if (!holds) throw Error({name, 0}, key, otherwise, kRemedy);
}

/// Throws Error when values or sizes are impossible.
void check_fclib(const Fclib& in, const std::string& name) {
    const auto want = [&](bool holds, const char* key, const char* otherwise) {
        require(holds, name, key, otherwise);
    };
    const auto finite = [](const std::vector<double>& values) {
        return std::all_of(values.begin(), values.end(),
                           [](double value) { return std::isfinite(value); });
    };
    want(finite(in.q), "fclib_local/vectors/q", "has values that are not finite");
    want(finite(in.mu), "fclib_local/vectors/mu", "has values that are not finite");
    want(std::all_of(in.mu.begin(), in.mu.end(), [](double value) { return value >= 0; }),
         "fclib_local/vectors/mu", "has values below zero");
    want(finite(in.x), "fclib_local/W/x", "has values that are not finite");
    const size_t n = in.q.size();
    want(in.mu.size() <= kMostContacts, "fclib_local/vectors/mu", "has more than 2000 contacts");
    want(n == 3 * in.mu.size(), "fclib_local/vectors", "q does not have three rows for each mu");
    want(in.layout == Fclib::kColumns || in.layout == Fclib::kRows, "fclib_local/W/nz",
         "is neither -1 (columns) nor -2 (rows)");
    want(in.p.size() == n + 1, "fclib_local/W/p", "does not fit q");
}

Eigen::MatrixXd matrix_of(const Fclib& in, const std::string& name) {
    const size_t n = in.q.size();
    const auto size = static_cast<Eigen::Index>(n);
    Eigen::MatrixXd W = Eigen::MatrixXd::Zero(size, size);
    for (size_t major = 0; major < n; ++major) {
        for (int k = in.p[major]; k < in.p[major + 1]; ++k) {
            const auto at = static_cast<size_t>(k);
            require(k >= 0 && at < in.x.size() && at < in.i.size(), name, "fclib_local/W/p",
                    "points outside x or i");
            require(in.i[at] >= 0 && in.i[at] < size, name, "fclib_local/W/i", "points outside W");
            const auto minor = static_cast<Eigen::Index>(in.i[at]);
            const auto other = static_cast<Eigen::Index>(major);
            (in.layout == Fclib::kColumns ? W(minor, other) : W(other, minor)) = in.x[at];
        }
    }
    return W;
}

}  // namespace

contact::DelassusProblem read_contact_file(const std::string& name) {
    const Fclib in = read_fclib(name);
    check_fclib(in, name);
    const auto vector_of = [](const std::vector<double>& values) {
        return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                                 static_cast<Eigen::Index>(values.size()));
    };
    contact::DelassusProblem out;
    out.W = matrix_of(in, name);
    out.q = vector_of(in.q);
    out.mu = vector_of(in.mu);
    return out;
}

}  // namespace dihaptic::bench
