// The files with which a BIDS data set describes itself and its participants:
// dataset_description.json, README, participants.tsv, and a table of recordings per participant.
#pragma once

#include <string>
#include <vector>

#include "base/descriptor.h"
#include "recording/session.h"

namespace dihaptic::analysis::bids {

/// Locks a data set, so that one export at a time numbers its runs and adds rows to its tables.
class Lock {
  public:
    explicit Lock(const std::string& folder);

  private:
    Descriptor descriptor_;
};

class DataSet {
  public:
    /// `folder` need not exist.
    DataSet(std::string folder, const recording::SessionFolder& session,
            const recording::SessionInfo& info);

    /// E.g. "sub-S07".
    const std::string& subject() const { return subject_; }
    /// Throws Error when the session cannot be added: a simulation to people's data or a person to
    /// simulated data; a participant whose label belongs to another; a recording that the data set
    /// already contains.
    void check() const;
    /// Adds the participant, and the recordings, whose paths begin at the subject's folder.
    void add(const std::vector<std::string>& recordings) const;

  private:
    std::string file(const std::string& name) const { return folder_ + "/" + name; }
    std::string scans() const;
    void check_kind() const;
    void check_participant() const;
    void check_recordings() const;
    void describe() const;
    void add_participant() const;

    std::string folder_;
    const recording::SessionFolder& session_;
    const recording::SessionInfo& info_;
    std::string subject_;
};

}  // namespace dihaptic::analysis::bids
