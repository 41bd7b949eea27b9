// Tests sessions with random extreme settings, and files with random changes, as a careless or
// malicious person might make. Each case runs in its own process, so that the test survives and can
// report what happened.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <map>

#include "base/field_reader.h"
#include "base/random.h"
#include "servo/run.h"
#include "session/check.h"
#include "session/session_run.h"
#include "testing/files.h"

namespace dihaptic::session {

enum class Ending { in_order, faulted, refused, crashed, hung };
constexpr auto enum_names(Ending) {
    return std::array{"in order", "faulted", "refused", "crashed", "hung"};
}

/// Runs `what` in a child process that may use `longest` seconds of processor time. Returns how it
/// ended.
inline Ending ending_of(const std::function<Ending()>& what, unsigned longest) {
    const pid_t child = fork();
    if (child == 0) {
        std::freopen("/dev/null", "w", stderr);
        alarm(20 * longest);  // limits wall-clock time; generous, since the machine may be busy
        const rlimit cpu{longest, longest};
        setrlimit(RLIMIT_CPU, &cpu);
        int code = static_cast<int>(Ending::crashed);
        try {
            code = static_cast<int>(what());
        } catch (const Error&) {
            code = static_cast<int>(Ending::refused);
        } catch (...) {  // any other exception counts as a crash
        }
        _exit(code);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status)) return static_cast<Ending>(WEXITSTATUS(status));
    const int signal = WTERMSIG(status);
    const bool hung = signal == SIGALRM || signal == SIGXCPU || signal == SIGKILL;
    return hung ? Ending::hung : Ending::crashed;
}

/// Lists every setting by its command-line name, with its bounds.
class SettingLister {
  public:
    struct Setting {
        std::string key;
        Field field;
        bool whole = false;
        std::vector<std::string> choices;
    };
    std::vector<Setting> settings;

    void operator()(std::string_view name, double&, Field field = {}) { add(name, field); }
    void operator()(std::string_view name, std::optional<double>&, Field field = {}) {
        add(name, field);
    }
    void operator()(std::string_view name, int&, Field field = {}) { add(name, field, true); }
    void operator()(std::string_view name, bool&, Field field = {}) {
        add(name, field, false, {"yes", "no"});
    }
    void operator()(std::string_view, std::string&, Field = {}) {}
    template <NamedEnum E>
    void operator()(std::string_view name, E& value, Field field = {}) {
        const auto names = enum_names(value);
        add(name, field, false, {names.begin(), names.end()});
    }
    template <class Struct>
    requires Described<Struct, SettingLister>
    void operator()(std::string_view name, Struct& value, Field = {}) {
        const std::string outer = path_;
        path_ += std::string(name) + ".";
        value.visit(*this);
        path_ = outer;
    }

  private:
    void add(std::string_view name, const Field& field, bool whole = false,
             std::vector<std::string> choices = {}) {
        settings.push_back({path_ + si_key(name, field.quantity), field, whole, choices});
    }
    std::string path_;
};

inline double log_uniform(Random& random, double low, double high) {
    return std::exp(random.uniform(std::log(low), std::log(high)));
}

template <class T>
const T& one_of(Random& random, const std::vector<T>& all) {
    return all[static_cast<size_t>(random.uniform(0, static_cast<double>(all.size())))];
}

/// Returns a random value for a setting. Most values are within its bounds, spread evenly over
/// orders of magnitude; some are on a bound, and some outside.
inline std::string extreme_value(Random& random, const SettingLister::Setting& setting) {
    if (!setting.choices.empty()) return one_of(random, setting.choices);
    const double kind = random.uniform(0, 1);
    const double high = std::max(setting.field.max, 1e-9);
    const double low = setting.field.min > 0 ? setting.field.min : high * 1e-9;
    double value = kind < 0.7    ? log_uniform(random, low, high)
                   : kind < 0.8  ? setting.field.max
                   : kind < 0.88 ? setting.field.min
                   : kind < 0.94 ? log_uniform(random, low / 100, high * 100)
                                 : (random.uniform(0, 1) < 0.5 ? 1e300 : -1.0);
    if (setting.whole && std::abs(value) < 1e9) value = std::round(value);
    return fmt::format("{:.17g}", value);
}

/// Returns a request for an experiment with one to five settings, one of which may be given twice.
inline Request extreme_request(uint64_t seed) {
    static const std::vector<std::string> kFiles{
        "experiments/lift-block.yaml",  "experiments/push-block.yaml",
        "experiments/slide-block.yaml", "experiments/toss-block.yaml",
        "experiments/turn-block.yaml",  "experiments/swing-rod.yaml",
        "experiments/hand-over.yaml",   "experiments/catch-block.yaml",
        "scenes/block-on-table.yaml",   "scenes/three-fingers.yaml",
        "scenes/bead-on-string.yaml",   "experiments/reach-to-grasp.yaml"};
    static const std::vector<SettingLister::Setting> kSettings = [] {
        SettingLister lister;
        frame::Settings settings;
        settings.visit(lister);
        return lister.settings;
    }();
    Random random(seed, "extremes");
    Request out;
    out.seed = seed;
    out.file = one_of(random, kFiles);
    if (out.file.find("reach-to-grasp") != std::string::npos)
        out.movement = "movements/reach-to-grasp.csv";
    const int count = 1 + static_cast<int>(random.uniform(0, 5));
    for (int i = 0; i < count; ++i) {
        const SettingLister::Setting& setting = one_of(random, kSettings);
        out.set.push_back(setting.key + "=" + extreme_value(random, setting));
    }
    const auto solvers = enum_names(contact::Solver{});
    const auto couplings = enum_names(frame::CouplingKind{});
    if (random.uniform(0, 1) < 0.7)
        out.set.push_back(fmt::format("coupling.kind={}", couplings[seed % couplings.size()]));
    if (random.uniform(0, 1) < 0.5)
        out.set.push_back(fmt::format("dynamics.solver={}", solvers[seed % solvers.size()]));
    return out;
}

inline std::string words(const Request& request) {
    return fmt::format("{} {}{}", request.file,
                       request.movement.empty() ? "" : "--movement " + request.movement + " ",
                       fmt::format("--set {}", fmt::join(request.set, " --set ")));
}

/// Runs the first `longest` of a session, without writing its files. In every tick, the forces must
/// be such that they may be sent to devices; otherwise the session counts as crashed.
inline Ending run_extreme(const Request& request, Time longest) {
    const Plan plan = make_plan(request);
    const auto servo = make_servo(plan);
    servo->activate();
    const std::atomic<bool> go_on{false};
    bool sound = true;
    servo::run_virtual(
        *servo, {},
        [&](const frame::Frame& frame) {
            for (const frame::FingerFrame& finger : frame.fingers) {
                const double force = finger.f_sent_W.norm();
                const bool off = (frame.status & kForceOff) != 0;
                sound = sound && (off ? force == 0 : force <= 100 * (1 + 1e-9));
            }
        },
        longest, go_on);
    servo->deactivate();
    if (!sound) return Ending::crashed;
    return servo->fault() ? Ending::faulted : Ending::in_order;
}

/// Returns the text after one to four changes: to a byte, a line, a number, or the kind of a value.
inline std::string mutated(std::string text, Random& random) {
    static const std::vector<std::string> kNumbers{"0",
                                                   "-1",
                                                   "1e308",
                                                   "-1e308",
                                                   "1e-308",
                                                   "1e400",
                                                   ".nan",
                                                   ".inf",
                                                   "nan",
                                                   "0x10",
                                                   "1_000",
                                                   "1,5",
                                                   "99999999999999999999",
                                                   "1e9",
                                                   "-0.0",
                                                   "1e-9",
                                                   "2147483648",
                                                   "+-3",
                                                   "",
                                                   "1e"};
    static const std::vector<std::string> kThings{"[]",  "{}",  "[1, 2]",    "{a: 1}",  "yes", "~",
                                                  "'x'", "*a",  "&a b",      "!!int 3", "|",   ">",
                                                  "- -", "? a", "{{{{{{{{{", "[[[[[[[", "\t",  "#"};
    const auto at = [&](size_t size) {
        return static_cast<size_t>(
            random.uniform(0, static_cast<double>(std::max<size_t>(size, 1))));
    };
    const auto changes = 1 + at(4);
    for (size_t n = 0; n < changes && !text.empty(); ++n) {
        std::vector<size_t> lines{0};
        for (size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') lines.push_back(i + 1);
        const size_t line = lines[at(lines.size())];
        const size_t next = std::min(text.find('\n', line), text.size() - 1) + 1;
        const auto spot = at(text.size());
        switch (at(8)) {
            case 0:
                text[spot] = static_cast<char>(at(256));
                break;
            case 1:
                text.erase(spot, 1 + at(20));
                break;
            case 2:
                text.insert(spot, text.substr(at(text.size()), 1 + at(40)));
                break;
            case 3:
                text.erase(line, next - line);
                break;
            case 4:
                text.insert(line, text.substr(line, next - line));
                break;
            case 5: {  // moves a line
                const std::string moved = text.substr(line, next - line);
                text.erase(line, next - line);
                text.insert(std::min(spot, text.size()), moved);
                break;
            }
            case 6: {
                const size_t from = text.find_first_of("0123456789", spot);
                if (from == std::string::npos) break;
                const size_t to = text.find_first_not_of("0123456789.eE+-", from);
                text.replace(from, (to == std::string::npos ? text.size() : to) - from,
                             one_of(random, kNumbers));
                break;
            }
            default: {
                const size_t colon = text.find(": ", spot);
                if (colon == std::string::npos) break;
                const size_t end = std::min(text.find('\n', colon), text.size());
                text.replace(colon + 2, end - colon - 2, one_of(random, kThings));
            }
        }
    }
    return text;
}

/// Copies of all shipped text files, one of which is mutated at a time.
class MutatedFiles {
  public:
    MutatedFiles() {
        for (const char* folder : {"scenes", "rigs", "experiments", "movements", "meshes"}) {
            std::filesystem::copy(folder, folder_.file(folder));
            if (std::string(folder) == "meshes") continue;
            for (const auto& entry : std::filesystem::directory_iterator(folder))
                files_.push_back(entry.path().string());
        }
        std::sort(files_.begin(), files_.end());
    }

    /// Mutates the file that `seed` selects, and checks it. `file` is set to its name.
    Ending check(uint64_t seed, std::string& file, std::string& text) const {
        Random random(seed, "mutations");
        file = one_of(random, files_);
        text = mutated(testing::read_file(file), random);
        folder_.write(file, text);
        const Ending out = ending_of(
            [&] {
                Diagnostics diagnostics;
                check_file(folder_.file(file), diagnostics);
                return diagnostics.has_errors() ? Ending::refused : Ending::in_order;
            },
            20);
        folder_.write(file, testing::read_file(file));
        return out;
    }

  private:
    testing::TemporaryFolder folder_;
    std::vector<std::string> files_;
};

using Endings = std::map<Ending, int>;

inline std::string words(const Endings& endings) {
    std::string out;
    for (const auto& [ending, count] : endings)
        out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, enum_name(ending));
    return out;
}

}  // namespace dihaptic::session
