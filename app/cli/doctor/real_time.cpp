#include "cli/doctor/real_time.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <string.h>

#include <filesystem>
#include <sstream>

namespace dihaptic::doctor {
namespace {

namespace fs = std::filesystem;

#if defined(__aarch64__)
constexpr const char* kArchitecture = "arm64";
#else
constexpr const char* kArchitecture = "amd64";
#endif

std::string add_limit(const std::string& limit) {
    return fmt::format("echo '@{} - {}' | sudo tee -a /etc/security/limits.d/dihaptic.conf", kGroup,
                       limit);
}

/// The command that starts a container with `option`, which grants rights to its root user.
std::string start_container(const std::string& option) {
    return fmt::format("docker run {} ...    # starts the container again", option);
}

/// The release of the real-time kernel installed from Debian's package; "" if there is none.
std::string real_time_kernel_on_disk(const std::string& root) {
    const std::string begin = "vmlinuz-";
    const std::string end = fmt::format("-rt-{}", kArchitecture);
    std::error_code failed;
    for (fs::directory_iterator i(root + "/boot", failed), none; !failed && i != none;
         i.increment(failed)) {
        const std::string name = i->path().filename().string();
        if (name.starts_with(begin) && name.ends_with(end)) return name.substr(begin.size());
    }
    return "";
}

Finding kernel(const std::string& root) {
    const std::string release = text_of(root + "/proc/sys/kernel/osrelease");
    const bool real_time = text_of(root + "/sys/kernel/realtime") == "1" ||
                           text_of(root + "/proc/version").find("PREEMPT_RT") != std::string::npos;
    if (real_time)
        return {Verdict::ok,
                "kernel",
                release +
                    " has PREEMPT_RT, which keeps drivers and other programs from delaying a tick",
                {}};
    const std::string lacking =
        release + " has no PREEMPT_RT: drivers and other programs can delay a tick";
    if (const std::string other = real_time_kernel_on_disk(root); !other.empty())
        return {
            Verdict::lacks,
            "kernel",
            fmt::format("{}. {}, which has it, is installed", lacking, other),
            {fmt::format("sudo reboot    # if {} starts again, choose {} in the boot menu, under "
                         "Advanced options",
                         release, other)}};
    const bool inside = !container(root).empty();
    return {Verdict::lacks,
            "kernel",
            lacking,
            {fmt::format("sudo apt install linux-image-rt-{}    # {}then restart", kArchitecture,
                         inside ? "on the container's host; " : "")}};
}

Finding priority(const Rights& rights) {
    if (rights.refusals.priority == 0)
        return {Verdict::ok,
                "priority",
                fmt::format("{} is available: ticks have priority over other programs",
                            rights.priority),
                {}};
    return {Verdict::lacks,
            "priority",
            fmt::format("{} is not available ({}): ticks are late when other programs are busy",
                        rights.priority, strerrorname_np(rights.refusals.priority)),
            {rights.root ? start_container("--cap-add SYS_NICE")
                         : add_limit(fmt::format("rtprio {}", rights.priority + 1))}};
}

std::string allow_memory(const std::string& root, const Rights& rights) {
    if (!rights.root) return add_limit("memlock unlimited");
    if (container(root).empty())
        return "ulimit -l unlimited    # for programs started from this shell";
    return start_container("--cap-add IPC_LOCK --ulimit memlock=-1");
}

Finding memory(const std::string& root, const Rights& rights) {
    if (rights.refusals.memory != 0)
        return {Verdict::lacks,
                "memory",
                fmt::format("cannot be locked ({}): a tick may wait for the disk",
                            strerrorname_np(rights.refusals.memory)),
                {allow_memory(root, rights)}};
    if (rights.unlimited_memory)
        return {Verdict::ok, "memory", "all of it can be locked: no tick waits for the disk", {}};
    return {Verdict::note,
            "memory",
            "only memory in use at a session's start can be locked: memory requested later may "
            "delay a tick",
            {allow_memory(root, rights)}};
}

Finding wakefulness(const std::string& root, const Rights& rights) {
    constexpr const char* kWhat = "wakefulness";
    std::error_code ignored;
    if (rights.refusals.awake != 0)
        return {
            Verdict::lacks, kWhat,
            fmt::format("processors cannot be kept from deep sleep ({}), from which they wake late",
                        strerrorname_np(rights.refusals.awake)),
            rights.root ? std::vector{start_container("--device /dev/cpu_dma_latency")}
                        : add_udev_rule(fmt::format("KERNEL==\"cpu_dma_latency\", "
                                                    "GROUP=\"{}\", MODE=\"0660\"",
                                                    kGroup))};
    if (!fs::exists(root + "/dev/cpu_dma_latency", ignored))
        return {Verdict::note, kWhat, "Linux does not manage the sleep of processors here", {}};
    return {Verdict::ok, kWhat, "processors can be kept from deep sleep: they wake at once", {}};
}

/// Whether the system's list of groups, which is read at login, names the user as a member.
bool is_listed(const std::string& root, const std::string& user) {
    std::istringstream lines(text_of(root + "/etc/group"));
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(std::string(kGroup) + ":")) continue;
        std::istringstream members(line.substr(line.rfind(':') + 1));
        for (std::string member; std::getline(members, member, ',');) {
            if (member == user) return true;
        }
    }
    return false;
}

/// Checks whether the user is a member of the group to which the rules above give access.
Finding membership(const std::string& root, const Rights& rights) {
    if (rights.groups.contains(kGroup))
        return {Verdict::ok, "group", fmt::format("{} is a member of {}", rights.user, kGroup), {}};
    if (is_listed(root, rights.user))
        return {
            Verdict::lacks,
            "group",
            fmt::format("{} has become a member of {}, but logged in before", rights.user, kGroup),
            {"su - $USER    # or log out, and in again"}};
    return {Verdict::lacks, "group",
            fmt::format("{} is not a member of {}, for which the rules above are made", rights.user,
                        kGroup),
            join_group()};
}

Finding governor(const std::string& root) {
    std::set<std::string> other;
    size_t all = 0;
    size_t performing = 0;
    std::error_code failed;
    const std::string folder = root + "/sys/devices/system/cpu";
    for (fs::directory_iterator i(folder, failed), end; !failed && i != end; i.increment(failed)) {
        const std::string is = text_of(i->path().string() + "/cpufreq/scaling_governor");
        if (is.empty()) continue;
        ++all;
        performing += is == "performance" ? 1 : 0;
        if (is != "performance") other.insert(is);
    }
    if (all == 0)
        return {Verdict::note, "frequency", "Linux does not set the speed of processors here", {}};
    if (other.empty())
        return {Verdict::ok,
                "frequency",
                "all processors run at their highest speed (performance)",
                {}};
    return {Verdict::lacks,
            "frequency",
            fmt::format(
                "{} of {} processors slow down when idle ({}): a tick after a pause takes longer",
                all - performing, all, fmt::join(other, ", ")),
            {"echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"
             "    # until the next restart"}};
}

Finding kind_of_machine(const std::string& root) {
    std::vector<std::string> kinds;
    if (is_virtual_machine(root)) kinds.emplace_back("a virtual machine");
    if (const std::string name = container(root); !name.empty())
        kinds.push_back(fmt::format("a container ({})", name));
    if (kinds.empty())
        return {Verdict::ok, "machine", "neither a virtual machine nor a container", {}};
    return {Verdict::note,
            "machine",
            fmt::format("{}: its host may withdraw the processor at any time; this affects real "
                        "devices, but not simulated ones",
                        fmt::join(kinds, " with ")),
            {}};
}

Finding processors(const Rights& rights) {
    if (rights.processors == 1)
        return {Verdict::note,
                "processors",
                "one, which the servo shares with the window and the recording",
                {}};
    return {Verdict::ok, "processors", fmt::format("{}", rights.processors), {}};
}

}  // namespace

Findings real_time(const std::string& root, const Rights& rights) {
    Findings out{kernel(root), priority(rights), memory(root, rights), wakefulness(root, rights)};
    if (!rights.root && (rights.refusals.any() || !rights.unlimited_memory))
        out.push_back(membership(root, rights));
    out.push_back(governor(root));
    out.push_back(kind_of_machine(root));
    out.push_back(processors(rights));
    return out;
}

}  // namespace dihaptic::doctor
