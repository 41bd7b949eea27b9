// A raw log that a bench records its ticks to, in a temporary folder that is removed with it.
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

    /// Makes a recorder that writes this log anew; the one before must be finished.
    recording::Recorder record(recording::Writing writing) const;
    /// Path of a file beside the log.
    std::string file(const std::string& name) const { return folder_.file(name); }

  private:
    TemporaryFolder folder_;
    recording::LogHead head_;
};

}  // namespace dihaptic::bench
