// What a BIDS data set says of itself and of its people: dataset_description.json, README,
// participants.tsv, and a table of recordings for each of them.
#pragma once

#include <string>
#include <vector>

#include "recording/session.h"

namespace dihaptic::analysis::bids {

/// One export at a time gives a data set's runs their numbers, and adds rows to its tables.
class Lock {
  public:
    explicit Lock(const std::string& folder);
    ~Lock();
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

  private:
    int descriptor_;
};

class DataSet {
  public:
    /// `folder` need not be there.
    DataSet(std::string folder, const recording::SessionFolder& session,
            const recording::SessionInfo& info);

    /// "sub-S07"
    const std::string& subject() const { return subject_; }
    /// Throws Error when the session cannot be added: a simulation to persons' data, or a person to
    /// those of a simulation; somebody else whose label is the same, or another task; a recording
    /// that is there.
    void check() const;
    /// Adds the participant, and the recordings, which are named from the subject's folder on.
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
