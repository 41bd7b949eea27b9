// Provides, for each kind of outlet, an outlet that tests can create and then cause to fail.
#pragma once

#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "base/temporary_folder.h"
#include "outlets/outlet.h"
#include "outlets/test/fake_lsl.h"
#include "testing/far_end.h"

namespace dihaptic::outlets {

class Fallible {
  public:
    virtual ~Fallible() = default;
    /// The outlet's options, as in a rig file.
    virtual std::string options() const = 0;
    /// After this call, the outlet cannot be opened.
    virtual void never_open() = 0;
    /// After this call, the outlet fails in every call that can fail.
    virtual void fail() = 0;
};

class FallibleSerial final : public Fallible {
  public:
    std::string options() const override { return "{ port: " + port_ + " }"; }
    void never_open() override { fail(); }
    void fail() override { far_.reset(); }

  private:
    std::unique_ptr<testing::FarEnd> far_ = std::make_unique<testing::FarEnd>();
    std::string port_ = far_->port;
};

class FallibleLsl final : public Fallible {
  public:
    FallibleLsl() { setenv("DIHAPTIC_FAKE_LSL", (folder_.path() + "/lsl.txt").c_str(), 1); }
    ~FallibleLsl() override { fake_lsl_fails(FakeLslFails::nothing); }
    std::string options() const override {
        return fmt::format("{{ library: {} }}", DIHAPTIC_FAKE_LSL);
    }
    void never_open() override { fake_lsl_fails(FakeLslFails::opening); }
    void fail() override { fake_lsl_fails(FakeLslFails::every_push); }

  private:
    TemporaryFolder folder_;
};

/// Returns null for a kind of outlet that has no Fallible yet.
inline std::unique_ptr<Fallible> make_fallible(const std::string& kind) {
    if (kind == "serial") return std::make_unique<FallibleSerial>();
    if (kind == "lsl") return std::make_unique<FallibleLsl>();
    return nullptr;
}

}  // namespace dihaptic::outlets
