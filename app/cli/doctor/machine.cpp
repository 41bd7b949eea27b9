#include "cli/doctor/machine.h"

#include <fmt/format.h>
#include <grp.h>
#include <pwd.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace dihaptic::doctor {

std::string text_of(const std::string& file) {
    std::ifstream in(file);
    std::ostringstream out;
    if (in) out << in.rdbuf();
    std::string text = out.str();
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
}

std::string container(const std::string& root) {
    std::error_code ignored;
    if (std::filesystem::exists(root + "/.dockerenv", ignored)) return "Docker";
    if (std::filesystem::exists(root + "/run/.containerenv", ignored)) return "Podman";
    return text_of(root + "/run/systemd/container");
}

bool is_virtual_machine(const std::string& root) {
    return text_of(root + "/proc/cpuinfo").find(" hypervisor") != std::string::npos;
}

Rights rights_now(int priority) {
    Rights out;
    out.priority = priority;
    out.refusals = servo::try_real_time(priority);
    rlimit memory{};
    out.unlimited_memory =
        getrlimit(RLIMIT_MEMLOCK, &memory) == 0 && memory.rlim_cur == RLIM_INFINITY;
    out.root = geteuid() == 0;
    if (const passwd* user = getpwuid(geteuid())) out.user = user->pw_name;
    std::vector<gid_t> ids(static_cast<size_t>(std::max(0, getgroups(0, nullptr))));
    ids.resize(static_cast<size_t>(
        std::max(0, getgroups(static_cast<int>(ids.size()), ids.empty() ? nullptr : ids.data()))));
    ids.push_back(getegid());
    for (const gid_t id : ids) {
        if (const group* named = getgrgid(id)) out.groups.insert(named->gr_name);
    }
    out.processors = std::thread::hardware_concurrency();
    return out;
}

std::vector<std::string> add_udev_rule(const std::string& rule) {
    return {fmt::format("echo '{}' | sudo tee -a /etc/udev/rules.d/70-dihaptic.rules", rule),
            "sudo udevadm control --reload && sudo udevadm trigger"};
}

std::vector<std::string> join_group() {
    return {fmt::format("sudo groupadd -f {}", kGroup),
            fmt::format("sudo usermod -aG {} $USER    # then log in again", kGroup)};
}

}  // namespace dihaptic::doctor
