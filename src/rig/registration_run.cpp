#include "rig/registration_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/random.h"
#include "model/minimum_jerk.h"
#include "rig/guided_steps.h"

namespace dihaptic::rig {
namespace {

constexpr int kCrossSamples = 25;           // number of samples per cross: half a second
constexpr double kMostMovedOnCross = 2e-3;  // largest movement of a finger at rest on a cross [m]
constexpr double kMoveToCross = 0.8;        // time of a simulated finger from cross to cross [s]
constexpr double kRest = 0.7;               // time spent on each cross [s]

/// A simulated hand whose finger moves from point to point and rests at each of them.
class TouchingHand final : public hand::Driver {
  public:
    explicit TouchingHand(std::vector<Vec3> places) : places_(std::move(places)) {}

    double duration() const override {
        return static_cast<double>(places_.size()) * (kMoveToCross + kRest);
    }
    const std::vector<Phase>& phases() const override { return phases_; }

  private:
    hand::FingerTarget do_target(int, double t) const noexcept override {
        const double each = kMoveToCross + kRest;
        const auto i = std::min(static_cast<size_t>(std::max(0.0, t) / each), places_.size() - 1);
        const Vec3& from = places_[i == 0 ? 0 : i - 1];
        const auto course = model::minimum_jerk((t - static_cast<double>(i) * each) / kMoveToCross);
        hand::FingerTarget out;
        out.p_WT = from + course.share * (places_[i] - from);
        return out;
    }

    std::vector<Vec3> places_;
    std::vector<Phase> phases_;
};

std::vector<Vec3> places_of(const display::Display& display) {
    std::vector<Vec3> out;
    for (const display::Cross& cross : display::crosses()) out.push_back(display.at(cross));
    return out;
}

/// Reads the position of one finger's endpoint.
class Endpoint {
  public:
    Endpoint(const Rig& rig, const std::string& finger, const hand::Driver* driver)
        : X_WD_(device_of(rig, finger).X_WD()),
          devices_(make(rig, finger, driver)),
          claims_(claim_devices(rig, {finger}, *devices_)),
          reader_(*devices_, {finger}) {
        devices_->activate();
    }
    ~Endpoint() { devices_->deactivate(); }
    Endpoint(const Endpoint&) = delete;
    Endpoint& operator=(const Endpoint&) = delete;

    DeviceReader& reader() { return reader_; }
    /// Position of the endpoint in the hand's units [m].
    Vec3 p_W() const { return X_WD_ * (reader_.readings()[0].p_DH / devices_->info(0).scale); }

  private:
    static std::unique_ptr<devices::DeviceGroup> make(const Rig& rig, const std::string& finger,
                                                      const hand::Driver* driver) {
        devices::Context context;
        context.driver = driver;
        context.impedance.stiffness = 1e5;  // makes the simulated finger practically rigid
        context.impedance.damping = 150;
        return make_devices(rig, {finger}, context);
    }

    Pose X_WD_;
    std::unique_ptr<devices::DeviceGroup> devices_;
    std::vector<devices::DeviceClaim> claims_;
    DeviceReader reader_;
};

/// The mean and the spread of positions that should be equal.
struct Rested {
    Vec3 sum = Vec3::Zero();
    Eigen::AlignedBox3d box;
    int count = 0;

    void add(const Vec3& p) {
        sum += p;
        box.extend(p);
        ++count;
    }
    Vec3 mean() const { return sum / count; }
    double moved() const { return box.diagonal().norm(); }
};

std::vector<Vec3> lead_person(const Rig& rig, const std::string& finger, const Guide& guide) {
    Endpoint endpoint(rig, finger, nullptr);
    const auto count = static_cast<int>(display::crosses().size());
    GuidedSteps steps(endpoint.reader(), guide, count);
    std::vector<Vec3> out;
    for (int i = 0; i < count; ++i) {
        steps.begin_step(
            fmt::format("Put the {}'s endpoint where you see cross {}, and keep it "
                        "there. The head stays on its rest.",
                        finger, i + 1));
        while (true) {
            steps.wait();
            Rested rested;
            steps.sample([&](bool) {
                rested.add(endpoint.p_W());
                return rested.count < kCrossSamples;
            });
            if (rested.moved() <= kMostMovedOnCross) {
                out.push_back(rested.mean());
                break;
            }
            steps.tell(0, fmt::format("It moved by {:.1f} mm: hold it still once more.",
                                      rested.moved() * 1e3));
        }
    }
    return out;
}

std::vector<Vec3> simulate(const Rig& rig, const std::string& finger, const display::Display& seen,
                           const Guide& guide, const SimulatedTouch& simulated) {
    Random random(simulated.seed, "registration");
    std::vector<Vec3> places = places_of(seen);
    for (Vec3& p : places)
        p += simulated.noise * Vec3(random.normal(), random.normal(), random.normal());
    const TouchingHand hand(places);
    Endpoint endpoint(rig, finger, &hand);
    Guidance told;
    told.text = "A simulated finger touches the crosses.";
    std::vector<Vec3> out;
    std::vector<Rested> rested(places.size());
    for (Time now{0}; now < from_seconds(hand.duration()); now += DeviceReader::kTick) {
        endpoint.reader().tick(now);
        if (now % GuidedSteps::kEvery != Time(0)) continue;
        told.share = seconds(now) / hand.duration();
        guide.show(told);
        guide.done();  // throws if the person has cancelled
        const double each = kMoveToCross + kRest;
        const auto i = static_cast<size_t>(seconds(now) / each);
        if (seconds(now) - static_cast<double>(i) * each > kMoveToCross + kRest / 2)
            rested[i].add(endpoint.p_W());
    }
    for (const Rested& rest : rested) out.push_back(rest.mean());
    return out;
}

}  // namespace

std::vector<Vec3> lead_registration(const Rig& rig, const std::string& finger,
                                    const display::Display& seen, const Guide& guide,
                                    const SimulatedTouch& simulated) {
    return is_real(rig) ? lead_person(rig, finger, guide)
                        : simulate(rig, finger, seen, guide, simulated);
}

}  // namespace dihaptic::rig
