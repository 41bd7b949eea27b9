// load() loads liblsl when a rig needs it.
#pragma once

#include "base/library.h"

namespace dihaptic::outlets::lsl {

/// `path` is the path of the library's file; if it is empty, the system finds the library. Throws
/// Error for `place`.
inline Library load(const std::string& path, const Place& place) {
    return {{"liblsl",
             {"liblsl.so.2", "liblsl.so"},
             false,
             "Install it from github.com/sccn/liblsl/releases, or name its file: library: "
             "/usr/lib/liblsl.so.",
             {}},
            path,
            place};
}

constexpr int kTimedOut = -1;  // lsl_timeout_error

/// `error` is an lsl_error_code_t returned by a call.
inline const char* describe(int32_t error) {
    switch (error) {
        case kTimedOut:
            return "it timed out";
        case -2:
            return "the stream was lost";
        case -3:
            return "it does not accept this sample";
        default:
            return "an internal error";
    }
}

}  // namespace dihaptic::outlets::lsl
