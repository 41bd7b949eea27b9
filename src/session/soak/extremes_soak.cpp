// Runs two thousand sessions with random extreme settings and checks five thousand mutated files.
#include "session/test/extremes.h"

#include <cstdio>

namespace dihaptic::session {
namespace {

TEST(ExtremesSoak, TwoThousandSessionsEndInOrderOrAreRefused) {
    Endings endings;
    for (uint64_t seed = 1000; seed < 3000; ++seed) {
        const Request request = extreme_request(seed);
        const Ending ending = ending_of(
            [&] {
                if (seed % 20 != 0) return run_extreme(request, std::chrono::seconds(3));
                // one session in twenty writes all of its files
                const testing::TemporaryFolder folder;
                RunOptions options;
                options.out = folder.path();
                const std::atomic<bool> go_on{false};
                const RunResult result = run_session(make_plan(request), options, go_on, {});
                return result.fault.empty() ? Ending::in_order : Ending::faulted;
            },
            300);
        ++endings[ending];
        EXPECT_TRUE(ending != Ending::crashed && ending != Ending::hung)
            << enum_name(ending) << ": " << words(request);
    }
    std::printf("of 2000 sessions: %s\n", words(endings).c_str());
}

TEST(ExtremesSoak, FiveThousandMutatedFilesAreReadOrRefused) {
    const MutatedFiles files;
    Endings endings;
    std::string file, text;
    for (uint64_t seed = 10'000; seed < 15'000; ++seed) {
        const Ending ending = files.check(seed, file, text);
        ++endings[ending];
        EXPECT_TRUE(ending != Ending::crashed && ending != Ending::hung)
            << enum_name(ending) << ", seed " << seed << ": " << file << "\n"
            << text;
    }
    std::printf("of 5000 files: %s\n", words(endings).c_str());
}

}  // namespace
}  // namespace dihaptic::session
