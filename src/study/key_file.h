// The names behind a study's identifiers. A laboratory that has to know the names keeps them in a
// separate table outside the study's folder, which only its owner may read. Nothing else that the
// program writes contains a name.
#pragma once

#include <string>
#include <vector>

#include "study/study_file.h"

namespace dihaptic::study {

struct Key {
    std::string participant;  ///< identifier
    std::string name;
    std::string contact;

    template <class Self, class Visitor>
    static void visit(Self& key, Visitor& v) {
        v("participant", key.participant, "", "identifier");
        v("name", key.name, "", "name");
        v("contact", key.contact, "", "address or number");
    }
};

class KeyFile {
  public:
    enum class Missing { is_made, is_refused };
    /// Reads the file. Throws Error if the file is in the study's folder, if other users can read
    /// it, if it is not a key file, or if it does not exist, unless `missing` says that a missing
    /// file is to be created.
    KeyFile(const StudyFile& study, std::string file, Missing missing);

    /// Returns the name of the participant; null if the file has none.
    const Key* find(const std::string& participant) const;
    /// Adds a participant and writes the file. Throws Error if the file has a different name for
    /// the participant.
    void add(const Key& key);
    /// Removes a participant and writes the file. Returns whether the file had a name for the
    /// participant.
    bool remove(const std::string& participant);

  private:
    void write() const;

    std::string file_;
    std::vector<Key> keys_;
};

}  // namespace dihaptic::study
