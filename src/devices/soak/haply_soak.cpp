// Sends commands to a fake Haply service for a minute at each rate, on the real clock. No command
// may be lost or doubled. Prints how long an answer takes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/statistics.h"
#include "devices/haply/test/numbered_run.h"

namespace dihaptic::devices::haply {
namespace {

class StillDriver final : public hand::Driver {
  public:
    double duration() const override { return 60; }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int, double) const noexcept override { return {}; }
    std::vector<Phase> phases_;
};

/// The service's rate [Hz]; at 0, it answers at once.
class HaplySoak : public ::testing::TestWithParam<double> {};

TEST_P(HaplySoak, LosesAndDoublesNoCommandInAMinute) {
    const StillDriver driver;
    Context context;
    context.driver = &driver;
    FakeService::Setup setup;
    setup.devices = {{"thumb", {}, {}}, {"index", {}, {}}};
    setup.rate = GetParam();
    FakeService service(setup, context);
    const auto devices =
        find_backend("haply")->make(rig_of(service, setup.devices, "time_out_ms: 1000, "), context);
    devices->activate();
    const int ticks = setup.rate > 0 ? static_cast<int>(60 * setup.rate) : 200'000;
    const NumberedRun run = expect_no_command_lost_or_doubled(*devices, service, 1, ticks);
    fmt::print(
        "service {}: {} commands in {:.2f} s, {:.0f} a second; round trip median {:.0f}, "
        "p99 {:.0f}, p99.9 {:.0f}, at worst {:.0f} us\n",
        setup.rate > 0 ? fmt::format("at {:g} Hz", setup.rate) : "that answers at once", ticks,
        run.duration, ticks / run.duration, quantile(run.round_trip, 0.5) * 1e6,
        quantile(run.round_trip, 0.99) * 1e6, quantile(run.round_trip, 0.999) * 1e6,
        quantile(run.round_trip, 1) * 1e6);
}
INSTANTIATE_TEST_SUITE_P(Rates, HaplySoak, ::testing::Values(1000.0, 2000.0, 4000.0, 0.0));

}  // namespace
}  // namespace dihaptic::devices::haply
