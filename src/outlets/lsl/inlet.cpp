#include "outlets/lsl/inlet.h"

#include <fmt/format.h>

#include "outlets/lsl/library.h"

namespace dihaptic::outlets::lsl {
namespace {

/// The part of liblsl's C interface that this file uses. liblsl's objects are opaque pointers here
/// too.
struct Receiving {
    Library file;
    int32_t (*resolve)(void** infos, uint32_t most, const char* property, const char* value,
                       int32_t least, double timeout) = nullptr;
    int32_t (*channel_count)(void* info) = nullptr;
    void (*destroy_info)(void* info) = nullptr;
    void* (*create_inlet)(void* info, int32_t buffer, int32_t chunk, int32_t recover) = nullptr;
    void (*destroy_inlet)(void* inlet) = nullptr;
    double (*pull)(void* inlet, float* values, int32_t count, double timeout,
                   int32_t* error) = nullptr;

    Receiving(const std::string& path, const Place& place) : file(load(path, place)) {
        file.find("lsl_resolve_byprop", resolve);
        file.find("lsl_get_channel_count", channel_count);
        file.find("lsl_destroy_streaminfo", destroy_info);
        file.find("lsl_create_inlet", create_inlet);
        file.find("lsl_destroy_inlet", destroy_inlet);
        file.find("lsl_pull_sample_f", pull);
    }
};

constexpr int32_t kBuffered = 1;  // only recent data are useful, so liblsl buffers no more [s]

}  // namespace

struct Inlet::Parts {
    std::string stream;
    Receiving library;
    std::unique_ptr<void, void (*)(void*)> inlet;
    int channels = 0;
};

Inlet::Inlet(const std::string& stream, const std::string& library, const Place& place)
    : parts_(new Parts{stream, Receiving(library, place), {nullptr, nullptr}}) {
    parts_->inlet = {nullptr, parts_->library.destroy_inlet};
}

Inlet::~Inlet() = default;

bool Inlet::find(std::chrono::duration<double> patience) {
    Receiving& library = parts_->library;
    void* found = nullptr;
    if (library.resolve(&found, 1, "name", parts_->stream.c_str(), 1, patience.count()) < 1)
        return false;
    const std::unique_ptr<void, void (*)(void*)> info(found, library.destroy_info);
    parts_->channels = library.channel_count(info.get());
    // liblsl must not reconnect: another stream with this name may have other channels
    parts_->inlet.reset(library.create_inlet(info.get(), kBuffered, 1, 0));
    if (!parts_->inlet)
        throw Error(fmt::format("liblsl cannot open the stream '{}'", parts_->stream),
                    "See liblsl's messages in the terminal.");
    return true;
}

int Inlet::channels() const {
    return parts_->channels;
}

bool Inlet::pull(std::span<float> values, std::chrono::duration<double> patience) {
    int32_t error = 0;
    const double time =
        parts_->library.pull(parts_->inlet.get(), values.data(),
                             static_cast<int32_t>(values.size()), patience.count(), &error);
    if (error != 0 && error != kTimedOut)
        throw Error(
            fmt::format("the stream '{}' sends no sample: {}", parts_->stream, describe(error)),
            "Check that the program that sends it is still running.");
    return time != 0;
}

}  // namespace dihaptic::outlets::lsl
