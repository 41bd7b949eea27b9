#include "task/file/sampled_path.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "base/installed.h"
#include "base/table.h"
#include "base/text_file.h"

namespace dihaptic::task {
namespace {

/// Returns the coordinate along one axis at the fraction s of the interval from times[i] to times[i
/// + 1].
double along(const std::vector<double>& times, const std::vector<double>& places, size_t i,
             double s) {
    if (places.empty()) return 0;
    const auto slope = [&](size_t k) {
        if (k == 0 || k + 1 == times.size()) return 0.0;
        return (places[k + 1] - places[k - 1]) / (times[k + 1] - times[k - 1]);
    };
    const double duration = times[i + 1] - times[i];
    const double rise = places[i + 1] - places[i];
    const double begin = duration * slope(i);
    const double end = duration * slope(i + 1);
    // cubic Hermite polynomial, relative to the first position of the path
    return places[i] - places[0] +
           s * (begin + s * (3 * rise - 2 * begin - end + s * (begin + end - 2 * rise)));
}

void check_columns(const CsvFile& table) {
    const bool timed = table.has("time_s");
    if (timed && (table.has("x_mm") || table.has("y_mm") || table.has("z_mm"))) return;
    throw Error(table.head(), timed ? "z_mm" : "time_s",
                fmt::format("no column has this name; the columns are {}",
                            shortened(fmt::format("{}", fmt::join(table.columns(), ", ")))),
                "The first line names the columns: time_s, and some of x_mm, y_mm, z_mm.");
}

}  // namespace

void SampledPath::read_file(const std::string& folder, Diagnostics& diagnostics) {
    if (file.empty()) return;
    if (!times.empty() || !x.empty() || !y.empty() || !z.empty()) {
        diagnostics.error(place, "file", "is given together with positions",
                          "Leave out one or the other.");
        return;
    }
    const std::string path = named_in(folder, file);
    try {
        read_table(CsvFile::given(path, diagnostics, check_columns), diagnostics);
        file.clear();
    } catch (const Error& e) {
        if (e.problems().front().place.line > 0) return diagnostics.add(e.problems());
        diagnostics.error(place, "file", fmt::format("'{}' is empty, or cannot be read", path),
                          "Name a CSV file, relative to the experiment's, whose first line is e.g. "
                          "time_s,x_mm,y_mm,z_mm.");
    }
}

void SampledPath::read_table(const CsvFile& table, Diagnostics& diagnostics) {
    struct Column {
        const char* name;
        double unit;
        std::vector<double>& to;
    };
    const std::array columns{Column{"time_s", 1, times}, Column{"x_mm", 1e-3, x},
                             Column{"y_mm", 1e-3, y}, Column{"z_mm", 1e-3, z}};
    for (const Column& column : columns) {
        for (size_t row = 0; row < table.rows() && table.has(column.name); ++row) {
            const double value = table.number(row, column.name);
            if (!std::isfinite(value))
                throw Error(
                    table.place(row), column.name,
                    fmt::format("'{}' is not a number", shortened(table.text(row, column.name))),
                    "Fill in the number, or leave out the row.");
            if (column.to.data() == times.data() && row > 0 && value <= times.back())
                throw Error(table.place(row), column.name,
                            fmt::format("time goes from {:.9g} to {:.9g} s", times.back(), value),
                            "Sort the times, and leave out duplicates.");
            column.to.push_back(column.unit * value);
        }
    }
    if (times.size() < 2)
        diagnostics.error(table.head(), "time_s",
                          "there are fewer than two times below this heading",
                          "Give a row for each position, at least two.");
}

bool SampledPath::check(Diagnostics& diagnostics) const {
    if (!file.empty()) return false;  // errors in the file have already been reported
    if (times.size() < 2) {
        diagnostics.error(place, "times", "has fewer than two times",
                          "Give times_s: [0, 0.5, 1] and e.g. z_mm: [0, 20, 0], or a file with the "
                          "columns time_s and z_mm.");
        return false;
    }
    bool good = true;
    const auto expect = [&](bool so, const char* key, const std::string& what,
                            const std::string& remedy) {
        if (!so) diagnostics.error(place, key, what, remedy);
        good = good && so;
    };
    for (size_t i = 1; i < times.size() && good; ++i) {
        expect(times[i] > times[i - 1], "times", fmt::format("does not ascend after item {}", i),
               "Sort the times, and leave out duplicates.");
    }
    struct Axis {
        const char* name;
        const std::vector<double>& places;
    };
    for (const Axis& axis : {Axis{"x", x}, Axis{"y", y}, Axis{"z", z}}) {
        expect(axis.places.empty() || axis.places.size() == times.size(), axis.name,
               fmt::format("has {} positions for {} times", axis.places.size(), times.size()),
               "Give one position for each time.");
        const auto bad = std::find_if(axis.places.begin(), axis.places.end(),
                                      [](double p) { return !std::isfinite(p); });
        expect(bad == axis.places.end(), axis.name,
               fmt::format("has no number in row {}", bad - axis.places.begin() + 1),
               "Fill in the number, or leave out the row.");
    }
    expect(!x.empty() || !y.empty() || !z.empty(), "x", "is missing, and so are 'y' and 'z'",
           "Give the positions along at least one axis.");
    return good;
}

Vec3 SampledPath::way(double t) const noexcept {
    const double at = std::clamp(times[0] + t, times.front(), times.back());
    const auto next = std::upper_bound(times.begin() + 1, times.end() - 1, at);
    const auto i = static_cast<size_t>(next - times.begin()) - 1;
    const double s = (at - times[i]) / (times[i + 1] - times[i]);
    return {along(times, x, i, s), along(times, y, i, s), along(times, z, i, s)};
}

}  // namespace dihaptic::task
