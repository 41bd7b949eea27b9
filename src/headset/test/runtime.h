// The interface between a test and the test runtime, an OpenXR runtime that has no headset but
// keeps the pictures that a headset would show.
#pragma once

#include <cstdint>
#include <vector>

namespace dihaptic::headset::test {

/// An OpenXR pose: x, y, z, and the quaternion's x, y, z, w.
struct RuntimePose {
    float p[3] = {0, 0, 0};
    float R[4] = {0, 0, 0, 1};
};

struct RuntimeEye {
    RuntimePose pose;                             ///< pose in the requested space
    float left = 0, right = 0, up = 0, down = 0;  ///< angles [rad]
};

/// What the runtime pretends to measure.
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
    std::vector<uint8_t> rgba;  ///< rows of pixels, from bottom to top
    RuntimeEye eye;             ///< the eye for which the program says that the picture was drawn
};

/// What the program has handed over last.
struct Handed {
    int64_t count = 0;  ///< number of pictures handed over so far
    int layers = 0;
    int64_t time = 0;  ///< time at which the picture should appear, on the runtime's clock [ns]
    RuntimePicture eyes[2];
    RuntimePicture words;  ///< empty: none
    RuntimePose words_pose;
};

// Each of these functions takes the library's internal lock.
extern "C" {
/// Sets what the runtime pretends from the next picture onwards.
using PretendFunction = void (*)(const Pretence&);
constexpr const char* kPretend = "dihaptic_pretend";
/// Waits until a picture that was begun after the last pretence has been handed over. Returns false
/// if none arrives within a minute.
using WaitFunction = bool (*)(Handed&);
constexpr const char* kWaitForPicture = "dihaptic_wait_for_picture";
}

}  // namespace dihaptic::headset::test
