// A raw log to record a bench's ticks to, in a temporary folder that goes away with it.
#pragma once

#include <string>

#include "base/temporary_folder.h"
#include "recording/recorder.h"
#include "scene/scene.h"
#include "servo/settings.h"

namespace dihaptic::measure {

class BenchLog {
  public:
    BenchLog(const scene::Scene& scene, const servo::Settings& settings);

    /// A recorder of this log, from its beginning; the one before must be finished.
    recording::Recorder record(recording::Writing writing) const;
    /// A file beside it.
    std::string file(const std::string& name) const { return folder_.file(name); }

  private:
    TemporaryFolder folder_;
    recording::LogHead head_;
};

}  // namespace dihaptic::measure
