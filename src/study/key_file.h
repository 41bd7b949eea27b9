// The names behind a study's identifiers. A laboratory that has to know them keeps them in a table
// of its own, outside the study's folder, which only its owner may read. Nothing else that the
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
    /// Reads the file. Throws Error if it lies in the study's folder, if others can read it, if it
    /// is not a key file or, unless a missing file is to be made, if it does not exist.
    KeyFile(const StudyFile& study, std::string file, Missing missing);

    /// Null if the file has no name for the participant.
    const Key* find(const std::string& participant) const;
    /// Adds a participant, and writes the file. Throws Error if the participant has another name.
    void add(const Key& key);
    /// Removes a participant, and writes the file. Returns whether there was a name.
    bool remove(const std::string& participant);

  private:
    void write() const;

    std::string file_;
    std::vector<Key> keys_;
};

}  // namespace dihaptic::study
