// What the system says of itself and of the user. `root` is put before the path of each of its
// files: "", or in tests a folder with those of another machine.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "servo/real_time.h"

namespace dihaptic::doctor {

/// All of a small file, without the line's end; "" if it cannot be read.
std::string text_of(const std::string& file);

/// "Docker" and the like; "" outside of containers.
std::string container(const std::string& root);
bool is_virtual_machine(const std::string& root);

/// What this process may do.
struct Rights {
    int priority = 0;  ///< that was asked for
    servo::RealTime::Refusals refusals;
    bool unlimited_memory = false;  ///< may be locked
    bool root = false;
    std::string user;
    std::set<std::string> groups;
    unsigned processors = 0;
};
Rights rights_now(int priority);

/// The group whose members may do what real time and devices need.
constexpr const char* kGroup = "haptics";

/// Commands that add a rule of udev's, and that make the user a member of the group.
std::vector<std::string> add_udev_rule(const std::string& rule);
std::vector<std::string> join_group();

}  // namespace dihaptic::doctor
