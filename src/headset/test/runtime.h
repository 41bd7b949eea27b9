// The interface between a test and the test runtime: an OpenXR runtime that has no headset, and
// keeps the pictures that one would show.
#pragma once

#include <cstdint>
#include <vector>

namespace dihaptic::headset::test {

/// A pose of OpenXR: x, y, z and the quaternion's x, y, z, w.
struct RuntimePose {
    float p[3] = {0, 0, 0};
    float R[4] = {0, 0, 0, 1};
};

struct RuntimeEye {
    RuntimePose pose;                             ///< pose in the space that is asked for
    float left = 0, right = 0, up = 0, down = 0;  ///< angles [rad]
};

/// What the runtime pretends.
struct Pretence {
    RuntimeEye eyes[2];
    RuntimePose head;
    bool has_stage = true;
    bool has_headset = true;
    bool tracked = true;
    bool located = true;
    bool visible = true;
    bool ends = false;  ///< whether the runtime ends the session
};

struct RuntimePicture {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;  ///< rows from bottom to top
    RuntimeEye eye;             ///< the eye for which the program says that it drew
};

/// What the program handed over last.
struct Handed {
    int64_t count = 0;  ///< number of pictures so far
    int layers = 0;
    int64_t time = 0;  ///< when it should appear, on the runtime's clock [ns]
    RuntimePicture eyes[2];
    RuntimePicture words;  ///< empty: none
    RuntimePose words_pose;
};

// Each of these functions takes the library's own lock.
extern "C" {
/// Sets what is pretended from the next picture on.
using PretendFunction = void (*)(const Pretence&);
constexpr const char* kPretend = "dihaptic_pretend";
/// Waits until a picture has been handed over that was begun after the last pretence; false: none
/// came in a minute.
using WaitFunction = bool (*)(Handed&);
constexpr const char* kWaitForPicture = "dihaptic_wait_for_picture";
}

}  // namespace dihaptic::headset::test
