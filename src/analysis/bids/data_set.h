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

    /// Folder of the session's recordings, within the data set: "sub-S07", or "sub-S07/ses-day1" of
    /// a study's session.
    std::string place() const { return visit_.empty() ? subject_ : subject_ + "/" + visit_; }
    /// The beginning of the names of its recordings' files: "sub-S07", or "sub-S07_ses-day1".
    std::string stem() const { return visit_.empty() ? subject_ : subject_ + "_" + visit_; }
    /// Throws Error when the session cannot be added: a simulation to people's data or a person to
    /// simulated data; a participant whose label belongs to another; a recording that the data set
    /// already contains.
    void check() const;
    /// The recording of this session that the data set contains; empty: none.
    std::string recording_there() const;
    /// Adds the participant, and the recordings, whose paths begin at place().
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
    std::string visit_;  ///< "ses-day1"; empty: the session does not belong to a study
};

}  // namespace dihaptic::analysis::bids
