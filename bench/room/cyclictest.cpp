#include "bench/cyclictest.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "base/number.h"

namespace dihaptic::bench {
namespace {

constexpr int kMostLate = 1000000;  // [us]; cyclictest counts later wake-ups separately

/// Runs a program to its end, without its output. Returns the failure; "" if none.
std::string run(std::vector<std::string> arguments) {
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int failed = posix_spawnp(&child, argv[0], &files, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (failed == ENOENT) return "cyclictest is not installed (Debian package rt-tests)";
    int status = 0;
    if (failed != 0 || waitpid(child, &status, 0) != child) return "cyclictest did not run";
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return "cyclictest failed";
    return "";
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
        "cyclictest",
        "--quiet",
        fmt::format("--interval={:.0f}", wanted.settings.tick() * 1e6),
        fmt::format("--loops={:.0f}", seconds * wanted.settings.rate),
        fmt::format("--histogram={}", kMostLate),
        "--json=" + wanted.file};
    if (wanted.priority) {
        arguments.push_back(fmt::format("--priority={}", wanted.settings.real_time_priority));
    } else {
        arguments.emplace_back("--policy=other");
    }
    if (wanted.locked_memory) arguments.emplace_back("--mlockall");
    if (std::string failed = run(std::move(arguments)); !failed.empty()) return failed;
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
