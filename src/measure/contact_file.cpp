#include "measure/contact_file.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

#include "base/diagnostics.h"

namespace dihaptic::measure {
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
    "Give a file of the FCLIB kind: fclib_local/W/{m,n,nz,p,i,x} and fclib_local/vectors/{q,mu}.";

/// W is kept as a dense matrix, of which the solvers make several.
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

}  // namespace

contact::DelassusProblem read_contact_file(const std::string& name) {
    if (!std::filesystem::is_regular_file(name))
        throw Error({name, 0}, "", "there is no such file", "Check the name and the folder.");
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // we say what is wrong ourselves
    const Id file = own(H5Fopen(name.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (!file) {
        const bool signed_as_one = H5Fis_hdf5(name.c_str()) > 0;
        throw Error(
            {name, 0}, "",
            signed_as_one ? "is an HDF5 file, but damaged or cut short" : "is not an HDF5 file",
            kRemedy);
    }
    const auto integers = [&](const char* path) {
        return read<int>(*file, path, H5T_NATIVE_INT, name);
    };
    const auto numbers = [&](const char* path) {
        return read<double>(*file, path, H5T_NATIVE_DOUBLE, name);
    };
    const std::vector<double> q = numbers("fclib_local/vectors/q");
    const std::vector<double> mu = numbers("fclib_local/vectors/mu");
    const int layout = integers("fclib_local/W/nz").front();
    const std::vector<int> p = integers("fclib_local/W/p");
    const std::vector<int> index = integers("fclib_local/W/i");
    const std::vector<double> x = numbers("fclib_local/W/x");

    const auto want = [&](bool holds, const char* key, const char* otherwise) {
        if (!holds) throw Error({name, 0}, key, otherwise, kRemedy);
    };
    const auto finite = [](const std::vector<double>& values) {
        return std::all_of(values.begin(), values.end(),
                           [](double value) { return std::isfinite(value); });
    };
    want(finite(q), "fclib_local/vectors/q", "has values that are not finite");
    want(finite(mu), "fclib_local/vectors/mu", "has values that are not finite");
    want(std::all_of(mu.begin(), mu.end(), [](double value) { return value >= 0; }),
         "fclib_local/vectors/mu", "has values below zero");
    want(finite(x), "fclib_local/W/x", "has values that are not finite");

    const size_t n = q.size();
    want(mu.size() <= kMostContacts, "fclib_local/vectors/mu", "has more than 2000 contacts");
    want(n == 3 * mu.size(), "fclib_local/vectors", "q has not three rows for each mu");
    constexpr int kColumns = -1;
    constexpr int kRows = -2;
    want(layout == kColumns || layout == kRows, "fclib_local/W/nz",
         "is neither -1 (columns) nor -2 (rows)");
    want(p.size() == n + 1, "fclib_local/W/p", "does not fit q");

    contact::DelassusProblem out;
    const auto size = static_cast<Eigen::Index>(n);
    out.W = Eigen::MatrixXd::Zero(size, size);
    out.q = Eigen::Map<const Eigen::VectorXd>(q.data(), size);
    out.mu = Eigen::Map<const Eigen::VectorXd>(mu.data(), static_cast<Eigen::Index>(mu.size()));
    for (size_t major = 0; major < n; ++major) {
        for (int k = p[major]; k < p[major + 1]; ++k) {
            const auto at = static_cast<size_t>(k);
            want(k >= 0 && at < x.size() && at < index.size(), "fclib_local/W/p",
                 "points outside x or i");
            want(index[at] >= 0 && index[at] < size, "fclib_local/W/i", "points outside W");
            const auto minor = static_cast<Eigen::Index>(index[at]);
            const auto other = static_cast<Eigen::Index>(major);
            (layout == kColumns ? out.W(minor, other) : out.W(other, minor)) = x[at];
        }
    }
    return out;
}

}  // namespace dihaptic::measure
