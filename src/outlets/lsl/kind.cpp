#include "outlets/lsl/kind.h"

#include <fmt/format.h>

#include "base/json_schema.h"
#include "base/number.h"
#include "outlets/lsl/library.h"

namespace dihaptic::outlets::lsl {
namespace {

struct Options {
    std::string name = "Dihaptic";  ///< prefix of the streams' names
    std::string library;            ///< path of liblsl; if empty, the system finds it

    template <class Visitor>
    void visit(Visitor& v) {
        v("name", name, says("Beginning of the streams' names."));
        v("library", library, says("Path of liblsl, if it is not found automatically."));
    }
};

Options read_options(const OutletConfig& config, Diagnostics& diagnostics) {
    Options options;
    read_given_fields(options, config.options, diagnostics);
    return options;
}

/// The part of liblsl's C interface that this file uses. liblsl's objects are opaque pointers here
/// too.
struct Interface {
    Library file;
    void* (*create_streaminfo)(const char* name, const char* type, int32_t channels, double rate,
                               int format, const char* source) = nullptr;
    void (*destroy_streaminfo)(void* info) = nullptr;
    void* (*get_desc)(void* info) = nullptr;
    void* (*append_child)(void* element, const char* name) = nullptr;
    void* (*append_child_value)(void* element, const char* name, const char* value) = nullptr;
    void* (*create_outlet)(void* info, int32_t chunk, int32_t seconds) = nullptr;
    void (*destroy_outlet)(void* outlet) = nullptr;
    int32_t (*push_sample_ft)(void* outlet, const float* values, double time) = nullptr;
    int32_t (*push_sample_strt)(void* outlet, const char** values, double time) = nullptr;
    double (*local_clock)() = nullptr;

    Interface(const std::string& path, const Place& place) : file(load(path, place)) {
        file.find("lsl_create_streaminfo", create_streaminfo);
        file.find("lsl_destroy_streaminfo", destroy_streaminfo);
        file.find("lsl_get_desc", get_desc);
        file.find("lsl_append_child", append_child);
        file.find("lsl_append_child_value", append_child_value);
        file.find("lsl_create_outlet", create_outlet);
        file.find("lsl_destroy_outlet", destroy_outlet);
        file.find("lsl_push_sample_ft", push_sample_ft);
        file.find("lsl_push_sample_strt", push_sample_strt);
        file.find("lsl_local_clock", local_clock);
    }
};

constexpr int kFloat = 1;         // cft_float32
constexpr int kString = 3;        // cft_string
constexpr int32_t kBuffer = 360;  // how long a reader may be absent; this is liblsl's default [s]

class Lsl final : public Outlet {
  public:
    Lsl(const Options& options, const About& about, const Place& place)
        : library_(options.library, place), place_(place) {
        // Both clocks are monotonic, but their zeros may differ.
        const auto now = Clock::now().time_since_epoch();
        offset_ = library_.local_clock() - std::chrono::duration<double>(now).count();
        markers_ = open(options.name + " markers", "Markers", {{"code", ""}}, 0, kString,
                        about.session + "/markers");
        handles_ = open(options.name + " handles", "Haptics", about.channels, about.rate, kFloat,
                        about.session + "/handles");
    }

    void mark(int code, Clock::time_point at) override {
        const std::string text = number_text(code);
        const char* value = text.c_str();
        must(library_.push_sample_strt(markers_.get(), &value, time(at)), "a code");
    }
    void sample(std::span<const float> values, Clock::time_point at) override {
        must(library_.push_sample_ft(handles_.get(), values.data(), time(at)), "a sample");
    }

  private:
    /// An object created by liblsl, together with the function that destroys it.
    using Made = std::unique_ptr<void, void (*)(void*)>;

    double time(Clock::time_point at) const {
        return offset_ + std::chrono::duration<double>(at.time_since_epoch()).count();
    }
    static void must(int32_t result, const char* what) {
        if (result != 0)
            throw Error(
                fmt::format("liblsl did not accept {}: {} ({})", what, describe(result), result),
                "See liblsl's messages in the terminal.");
    }
    Made open(const std::string& name, const char* type, const std::vector<Channel>& channels,
              double rate, int format, const std::string& source) const {
        const Made info(
            library_.create_streaminfo(name.c_str(), type, static_cast<int32_t>(channels.size()),
                                       rate, format, source.c_str()),
            library_.destroy_streaminfo);
        if (!info)
            throw Error(place_, "name", fmt::format("liblsl cannot describe the stream '{}'", name),
                        "See liblsl's messages in the terminal, or remove the outlet.");
        void* list = library_.append_child(library_.get_desc(info.get()), "channels");
        for (const Channel& channel : channels) {
            void* one = library_.append_child(list, "channel");
            library_.append_child_value(one, "label", channel.label.c_str());
            library_.append_child_value(one, "unit", channel.unit.c_str());
        }
        Made outlet(library_.create_outlet(info.get(), 0, kBuffer), library_.destroy_outlet);
        if (!outlet)
            throw Error(place_, "kind", fmt::format("liblsl cannot open the stream '{}'", name),
                        "Allow multicast on this machine's network, or remove the outlet.");
        return outlet;
    }

    Interface library_;
    Place place_;
    double offset_ = 0;
    Made markers_{nullptr, nullptr};
    Made handles_{nullptr, nullptr};
};

void check(const OutletConfig& config, Diagnostics& diagnostics) {
    read_options(config, diagnostics);
}

std::unique_ptr<Outlet> make(const OutletConfig& config, const About& about) {
    Diagnostics diagnostics;
    const Options options = read_options(config, diagnostics);
    diagnostics.throw_if_errors();
    return std::make_unique<Lsl>(options, about, config.place);
}

}  // namespace

Kind kind() {
    return {"lsl",
            check,
            make,
            true,
            false,
            [](JsonSchema& schema) {
                schema.part_of_kind("options", "lsl", "Options.lsl", Options{}); }};
}

}  // namespace dihaptic::outlets::lsl
