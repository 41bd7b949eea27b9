// The system's information on itself and on the user. `root` is put before the path of each system
// file: "", or in tests a folder with the files of another machine.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "servo/real_time.h"

namespace dihaptic::doctor {

/// The content of a small file, without the line end; "" if it cannot be read.
std::string text_of(const std::string& file);

/// "Docker" and the like; "" outside of containers.
std::string container(const std::string& root);
bool is_virtual_machine(const std::string& root);

/// The rights of this process.
struct Rights {
    int priority = 0;  ///< the priority requested
    servo::RealTime::Refusals refusals;
    bool unlimited_memory = false;  ///< whether unlimited memory may be locked
    bool root = false;
    std::string user;
    std::set<std::string> groups;
    unsigned processors = 0;
};
Rights rights_now(int priority);

/// The group whose members may use real-time scheduling and the devices.
constexpr const char* kGroup = "haptics";

/// Commands that add a udev rule, and that make the user a member of the group.
std::vector<std::string> add_udev_rule(const std::string& rule);
std::vector<std::string> join_group();

}  // namespace dihaptic::doctor
