#include "bench/cyclictest.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/child.h"
#include "base/diagnostics.h"
#include "base/number.h"

namespace dihaptic::bench {
namespace {

constexpr int kMostLate = 1000000;  // [us]; cyclictest counts later wake-ups separately

/// Runs cyclictest to its end, without its output. Returns the failure; "" if none.
std::string run(const std::vector<std::string>& arguments) {
    Child child;
    const int failed =
        child.start({"cyclictest", arguments, {Launch::kKept, Launch::kNothing, Launch::kNothing}});
    if (failed == ENOENT) return "cyclictest is not installed (Debian package rt-tests)";
    const std::optional<int> status = child.wait();
    if (!status) return "cyclictest did not run";
    return *status == 0 ? "" : "cyclictest failed";
}

}  // namespace

int64_t Wakeups::count() const {
    int64_t sum = 0;
    for (const auto& [us, count] : counts_) sum += count;
    return sum;
}

int64_t Wakeups::later_than(double us) const {
    int64_t sum = 0;
    for (auto it = counts_.upper_bound(static_cast<int>(us)); it != counts_.end(); ++it)
        sum += it->second;
    return sum;
}

double Wakeups::quantile(double share) const {
    const auto rank = static_cast<int64_t>(share * static_cast<double>(count() - 1));
    int64_t sum = 0;
    for (const auto& [us, count] : counts_) {
        sum += count;
        if (sum > rank) return us;
    }
    return NAN;
}

std::string run_cyclictest(const Cyclictest& wanted, double seconds, Wakeups& wakeups) {
    std::vector<std::string> arguments{
        "--quiet", fmt::format("--interval={:.0f}", wanted.settings.tick() * 1e6),
        fmt::format("--loops={:.0f}", seconds * wanted.settings.rate),
        fmt::format("--histogram={}", kMostLate), "--json=" + wanted.file};
    if (wanted.priority) {
        arguments.push_back(fmt::format("--priority={}", wanted.settings.real_time_priority));
    } else {
        arguments.emplace_back("--policy=other");
    }
    if (wanted.locked_memory) arguments.emplace_back("--mlockall");
    if (std::string failed = run(arguments); !failed.empty()) return failed;
    try {
        std::ifstream file(wanted.file);
        const auto thread = nlohmann::json::parse(file).at("thread").at("0");
        int64_t counted = 0;
        for (const auto& [us, count] : thread.at("histogram").items()) {
            wakeups.add(whole_number<int>(us).value(), count.get<int64_t>());
            counted += count.get<int64_t>();
        }
        const auto beyond = thread.at("cycles").get<int64_t>() - counted;
        if (beyond > 0) wakeups.add(thread.at("max").get<int>(), beyond);
    } catch (const std::exception&) {
        return "this version of cyclictest writes no readable figures";
    }
    return "";
}

}  // namespace dihaptic::bench
