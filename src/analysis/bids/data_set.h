// Writes the files in which a BIDS data set describes itself and its participants:
// dataset_description.json, README, participants.tsv, and a table of recordings per participant.
#pragma once

#include <string>
#include <vector>

#include "base/descriptor.h"
#include "recording/session.h"

namespace dihaptic::analysis::bids {

/// Locks a data set, so that only one export at a time numbers its runs and adds rows to its
/// tables.
class Lock {
  public:
    explicit Lock(const std::string& folder);

  private:
    Descriptor descriptor_;
};

class DataSet {
  public:
    /// The folder `folder` need not exist yet.
    DataSet(std::string folder, const recording::SessionFolder& session,
            const recording::SessionInfo& info);

    /// Folder of the session's recordings, relative to the data set: "sub-S07" or, for a session of
    /// a study, "sub-S07/ses-day1".
    std::string place() const { return visit_.empty() ? subject_ : subject_ + "/" + visit_; }
    /// Prefix of the names of the session's recording files: "sub-S07" or, for a session of a
    /// study, "sub-S07_ses-day1".
    std::string stem() const { return visit_.empty() ? subject_ : subject_ + "_" + visit_; }
    /// Throws Error when the session cannot be added: a simulation to a data set of real people or
    /// a real person to simulated data, a participant whose label belongs to another participant,
    /// or a recording that the data set already contains.
    void check() const;
    /// Path of this session's recording in the data set; empty if there is none.
    std::string recording_there() const;
    /// Adds the participant and the recordings, whose paths must begin with place().
    void add(const std::vector<std::string>& recordings) const;

  private:
    std::string file(const std::string& name) const { return folder_ + "/" + name; }
    std::string scans() const;
    void check_kind() const;
    void check_participant() const;
    void check_recordings() const;
    void describe() const;
    void add_hed_version() const;
    void describe_participants() const;
    void add_participant() const;
    void add_visit() const;

    std::string folder_;
    const recording::SessionFolder& session_;
    const recording::SessionInfo& info_;
    std::string subject_;
    std::string visit_;  ///< "ses-day1"; empty if the session does not belong to a study
};

}  // namespace dihaptic::analysis::bids
