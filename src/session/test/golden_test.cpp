// Tests that the first seconds of every shipped scene and experiment, with every solver, give the
// same results as when golden.txt was written: bit for bit, in every build.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "person/population.h"
#include "session/replay.h"
#include "testing/files.h"

namespace dihaptic::session::golden_test {
namespace {

constexpr const char* kFile = "src/session/test/golden.txt";
/// Number of ticks to run: normally, and for files with so many contacts that the slowest solvers
/// would take minutes.
constexpr int64_t kTicks = 3000;
constexpr int64_t kFewTicks = 300;

int64_t ticks_of(const std::string& file) {
    return file == "scenes/tower.yaml" || file == "scenes/sponge.yaml" ? kFewTicks : kTicks;
}

/// Maps "FILE SOLVER" to the hash of the results.
using Hashes = std::map<std::string, std::string>;

Hashes read() {
    Hashes out;
    std::istringstream lines(testing::read_file(kFile));
    std::string file, solver, hash;
    while (lines >> file >> solver >> hash) out[file + " " + solver] = hash;
    return out;
}

void write(const Hashes& hashes) {
    std::ofstream out(kFile);
    for (const auto& [name, hash] : hashes) out << name << " " << hash << "\n";
}

/// FNV-1a hash, computed number by number.
class Hash {
  public:
    void add(const std::vector<double>& numbers) {
        for (const double number : numbers)
            value_ = (value_ ^ std::bit_cast<uint64_t>(number)) * 0x100000001b3;
    }
    std::string text() const { return fmt::format("{:016x}", value_); }

  private:
    uint64_t value_ = 0xcbf29ce484222325;
};

Plan plan_of(const std::string& file, contact::Solver solver) {
    Request request;
    request.file = file;
    request.participant = "S07";
    request.set = {fmt::format("dynamics.solver={}", enum_name(solver))};
    Plan plan = make_plan(request);
    if (plan.task != nullptr && plan.driver == nullptr)
        sit_down(plan, person::draw_person(person::Objects::device, 1, "S07"));
    return plan;
}

std::string hash_of(const std::string& file, contact::Solver solver) {
    const testing::TemporaryFolder folder;
    Hash hash;
    int64_t unbalanced = 0;
    std::atomic<bool> stop{false};
    const int64_t ticks = ticks_of(file);
    RunOptions options;
    options.out = folder.path();
    options.in_place_of_log = [&](const auto&, const auto&, const auto&) -> frame::FrameSink {
        return [&](const frame::Frame& frame) {
            if (frame.sequence < ticks) hash.add(outcome_of(frame));
            unbalanced += (frame.status & kUnbalanced) != 0;
            stop = frame.sequence >= ticks;
        };
    };
    run_session(plan_of(file, solver), options, stop, {});
    EXPECT_EQ(unbalanced, 0) << "ticks of " << file << " do not balance, with "
                             << enum_name(solver);
    return hash.text();
}

std::vector<std::string> shipped() {
    std::vector<std::string> out;
    for (const char* folder : {"experiments", "scenes"}) {
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".yaml") out.push_back(entry.path().string());
    }
    std::sort(out.begin(), out.end());
    return out;
}

class Golden : public ::testing::TestWithParam<std::string> {};

TEST_P(Golden, HashesAreThoseThatWereKept) {
    if (!__builtin_cpu_supports("fma"))
        GTEST_SKIP() << "without FMA the C library's sines differ in their last bit";
    const bool renews = std::getenv("DIHAPTIC_RENEW_GOLDEN") != nullptr;
    Hashes hashes = read();
    for (size_t i = 0; i < enum_names(contact::Solver{}).size(); ++i) {
        const auto solver = static_cast<contact::Solver>(i);
        const std::string name = GetParam() + " " + std::string(enum_name(solver));
        const std::string hash = hash_of(GetParam(), solver);
        if (renews) {
            hashes[name] = hash;
        } else {
            EXPECT_EQ(hashes[name], hash)
                << name << " computes something else than it did. When that is meant, renew "
                << kFile << " in the same commit: DIHAPTIC_RENEW_GOLDEN=1 "
                << "build/release/src/session/session_test --gtest_filter='*Golden*'";
        }
    }
    if (renews) write(hashes);
}

INSTANTIATE_TEST_SUITE_P(Shipped, Golden, ::testing::ValuesIn(shipped()), [](const auto& shipped) {
    std::string name = std::filesystem::path(shipped.param).replace_extension("");
    for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    }
    return name;
});

}  // namespace
}  // namespace dihaptic::session::golden_test
