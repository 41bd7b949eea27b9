// Information from the system about itself and the user. `root` is prepended to the path of each
// system file: it is "" or, in tests, a folder with the files of another machine.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "servo/real_time.h"

namespace dihaptic::doctor {

/// The contents of a small file, without the final line end; "" if the file cannot be read.
std::string text_of(const std::string& file);

/// Name of the container in which the program runs, e.g. "Docker"; "" outside containers.
std::string container(const std::string& root);
bool is_virtual_machine(const std::string& root);

/// The rights that this process has.
struct Rights {
    int priority = 0;  ///< the requested priority
    servo::RealTime::Refusals refusals;
    bool unlimited_memory = false;  ///< whether the process may lock an unlimited amount of memory
    bool root = false;
    std::string user;
    std::set<std::string> groups;
    unsigned processors = 0;
};
Rights rights_now(int priority);

/// The group whose members may use real-time scheduling and the devices.
constexpr const char* kGroup = "haptics";

/// The commands that add a udev rule and, below, those that make the user a member of the group.
std::vector<std::string> add_udev_rule(const std::string& rule);
std::vector<std::string> join_group();

}  // namespace dihaptic::doctor
