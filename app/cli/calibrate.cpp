#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iostream>
#include <thread>

#include "base/field_writer.h"
#include "base/text_file.h"
#include "command.h"
#include "recording/session.h"
#include "rig/calibration_run.h"

namespace dihaptic::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::string rig;
    std::string out;
};

using Clock = std::chrono::steady_clock;

constexpr uint64_t kSeed = 1;  // of the simulated hand's slips

/// Thrown when the person gives up.
struct GivenUp {};

/// Whether a line was entered, without waiting for one. An end of input gives up.
bool entered() {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, 0) <= 0) return false;
    std::string line;
    if (!std::getline(std::cin, line)) throw GivenUp{};
    return true;
}

/// Leads a person through the movement, with real devices whose forces are off.
class Guide {
  public:
    explicit Guide(const rig::Rig& rig) : rig_(rig), sampler_(rig, nullptr) {}

    rig::CalibrationInput lead() {
        say("1. Reset\n"
            "   Hold each arm in the standard configuration: both links at right angles, the thigh "
            "level, "
            "the shin hanging.\n   Let it rest on a block that keeps it there: what is off here is "
            "felt "
            "everywhere.");
        ask("   Then press Enter.", [] {});
        sampler_.activate();
        active_ = true;
        for (size_t i = 1; i < rig_.devices.size(); ++i) carry(i);
        for (size_t i = 0; i < rig_.devices.size(); ++i) touch(i);
        sampler_.deactivate();
        return sampler_.input();
    }

  private:
    static void say(const std::string& text) {
        fmt::print("{}\n", text);
        std::fflush(stdout);
    }
    /// Calls `each` a thousand times a second, or when devices that keep time are ready, until it
    /// returns false.
    template <class Each>
    void repeat(const Each& each) {
        std::exception_ptr failure;
        const auto guarded = [&] {
            try {
                return each();
            } catch (...) {
                failure = std::current_exception();  // not through a vendor's library
                return false;
            }
        };
        if (active_ && sampler_.devices().paces()) {
            sampler_.devices().pace(guarded);
        } else {
            auto due = Clock::now();
            while (guarded()) {
                due += std::chrono::milliseconds(1);
                std::this_thread::sleep_until(due);
            }
        }
        if (failure) std::rethrow_exception(failure);
    }
    /// Waits for Enter.
    template <class Meanwhile>
    void ask(const std::string& text, const Meanwhile& meanwhile) {
        say(text);
        repeat([&] {
            if (stop_requested) throw GivenUp{};
            if (entered()) return false;
            meanwhile();
            return true;
        });
    }
    void tick() {
        sampler_.tick(Clock::now() - begin_);
        if (const std::string trouble = sampler_.trouble(); !trouble.empty())
            throw Error(trouble, "Then calibrate again.");
    }
    bool sampling() { return ++ticks_ % (rig::CalibrationSampler::kEvery.count() / 1000000) == 0; }

    void carry(size_t other) {
        const std::string pair = rig_.devices[0].finger + " and " + rig_.devices[other].finger;
        ask(fmt::format(
                "\n2. Link: {}\n   Join their endpoints by the link. Press Enter when it is fast.",
                pair),
            [&] { tick(); });
        size_t taken = 0;
        {
            ProgressLine line("clouds");
            ask("   Move it through all of the workspace, turning it to all sides, for a minute. "
                "Press "
                "Enter when done.",
                [&] {
                    tick();
                    if (!sampling()) return;
                    sampler_.add_link(other);
                    if (++taken % 25 != 0) return;
                    const double depth = std::min(sampler_.cloud(0)[0], sampler_.cloud(other)[0]);
                    const double share = std::min(1.0, depth / rig::kLeastDepth);
                    line.show(share, fmt::format("{:.0f} mm deep, {:.0f} needed; {} samples",
                                                 depth * 1e3, rig::kLeastDepth * 1e3, taken));
                });
        }
    }
    void touch(size_t device) {
        constexpr int kTouches = 25;
        for (size_t point = 0; point < rig_.jig.size(); ++point) {
            ask(fmt::format("\n3. Jig: touch '{}' with the {}'s endpoint, and press Enter.",
                            rig_.jig[point].name, rig_.devices[device].finger),
                [&] { tick(); });
            int taken = 0;
            repeat([&] {
                if (stop_requested) throw GivenUp{};
                tick();
                if (sampling()) {
                    sampler_.add_touch(device, point);
                    ++taken;
                }
                return taken < kTouches;
            });
        }
    }

    const rig::Rig& rig_;
    rig::CalibrationSampler sampler_;
    bool active_ = false;
    Clock::time_point begin_ = Clock::now();
    int64_t ticks_ = 0;
};

/// Beside the rig file, unless another is asked for.
std::string output_file(const Options& options, const rig::Rig& rig) {
    if (!options.out.empty()) return options.out;
    const fs::path file(options.rig);
    const std::string name =
        rig.calibration.empty() ? file.stem().string() + "-calibration.yaml" : rig.calibration;
    return (file.parent_path() / name).string();
}

void print_result(const rig::Rig& rig, const rig::CalibrationResult& result) {
    const rig::Calibration& c = result.calibration;
    const auto mm = [](double metres) { return metres * 1e3; };
    if (rig.devices.size() > 1) {
        double before = 0;
        size_t count = 0;
        for (const rig::LinkResidual& r : result.before) {
            if (r.slip) continue;
            before += r.misfit * r.misfit;
            ++count;
        }
        before = std::sqrt(before / static_cast<double>(std::max<size_t>(1, count)));
        fmt::print("link of {:.2f} mm, misfit along it, by samples held out:\n", mm(c.link_length));
        fmt::print("  before  {:7.3f} mm rms\n", mm(before));
        fmt::print(
            "  after   {:7.3f} mm rms, {:.3f} mm at worst; {:.1f} % of the samples were slips\n",
            mm(c.link_rms), mm(c.link_worst), c.slips * 100);
        fmt::print("endpoints agree to {:.3f} mm rms in space\n", mm(c.agreement_rms));
    }
    if (c.jig_rms)
        fmt::print("jig: {:.3f} mm rms, {:.3f} mm at worst\n", mm(*c.jig_rms), mm(*c.jig_worst));
    else
        fmt::print("no jig: the world stays as the rig file has it\n");
    const double degree = 180 / std::acos(-1.0);
    for (const rig::DeviceCalibration& d : c.devices) {
        fmt::print("{:8} shift [{:.2f}, {:.2f}, {:.2f}] mm, turn [{:.2f}, {:.2f}, {:.2f}] deg",
                   d.finger, mm(d.shift.x()), mm(d.shift.y()), mm(d.shift.z()), d.turn.x() * degree,
                   d.turn.y() * degree, d.turn.z() * degree);
        if (d.joint_offset) {
            fmt::print(", joints {:.2f} and {:.2f} deg\n", d.joint_offset->y() * degree,
                       d.joint_offset->z() * degree);
        } else {
            fmt::print(
                ", stretch [{:.4f}, {:.4f}, {:.4f}]; without joint angles, bends of its space "
                "remain\n",
                d.stretch.x(), d.stretch.y(), d.stretch.z());
        }
    }
}

void calibrate(const Options& options) {
    Diagnostics diagnostics;
    const rig::Rig rig = rig::read_rig_to_calibrate(options.rig, diagnostics);
    diagnostics.throw_if_errors();
    print(diagnostics.problems());
    rig::CalibrationInput input;
    if (rig.devices.front().backend == "simulated") {
        ProgressLine line("calibrate");
        input = rig::simulate_calibration(rig, kSeed, [&](double share) {
            line.show(share);
            return !stop_requested.load();
        });
    } else {
        try {
            input = Guide(rig).lead();
        } catch (const GivenUp&) {
            stop_requested.store(true);
        }
    }
    if (stop_requested) {
        fmt::print(stderr, "interrupted: nothing was stored\n");
        exit_code = kFailed;
        return;
    }
    rig::CalibrationResult result = rig::calibrate(input);
    result.calibration.date = recording::iso_now().substr(0, 10);
    const std::string out = output_file(options, rig);
    const std::string picture = fs::path(out).replace_extension(".svg").string();
    write_file(to_yaml(write_fields(result.calibration)), out);
    write_file(rig::residual_picture(result, rig.title), picture);
    fmt::print("{}\n", rig.title);
    print_result(rig, result);
    fmt::print("picture: {}\ncalibration: {}\n", picture, out);
    if (rig.calibration.empty()) {
        fmt::print("\nfor the rig file:\n\ncalibration: {}\n",
                   fs::path(out).lexically_proximate(fs::path(options.rig).parent_path()).string());
    }
}

}  // namespace

void add_calibrate(CLI::App& app) {
    auto* command = app.add_subcommand(
        "calibrate",
        "Find where a rig's devices truly are, by a link between their endpoints and a jig");
    auto options = std::make_shared<Options>();
    command->add_option("RIG", options->rig, "rig file, with the jig's points if there is one")
        ->required();
    command->add_option("-o,--out", options->out,
                        "calibration file; otherwise the rig's own, beside it. The picture of what "
                        "remains gets its name");
    command->footer(
        "\nExample:\n  dihaptic calibrate rigs/premium-misplaced.yaml -o "
        "calibration.yaml");
    command->callback([options] { calibrate(*options); });
}

}  // namespace dihaptic::cli
