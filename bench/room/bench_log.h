// A raw log for the ticks of a bench, in a temporary folder that is removed together with the log.
#pragma once

#include <string>

#include "base/temporary_folder.h"
#include "frame/settings.h"
#include "recording/recorder.h"
#include "scene/scene.h"

namespace dihaptic::bench {

class BenchLog {
  public:
    BenchLog(const scene::Scene& scene, const frame::Settings& settings);

    /// Makes a recorder that overwrites this log; the previous one must be finished.
    recording::Recorder record(recording::Writing writing) const;
    /// Path of a file next to the log.
    std::string file(const std::string& name) const { return folder_.file(name); }

  private:
    TemporaryFolder folder_;
    recording::LogHead head_;
};

}  // namespace dihaptic::bench
