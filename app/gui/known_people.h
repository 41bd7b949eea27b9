// The people of whom something has been recorded, or who have been added to the study: what the
// window says about them before they are recorded again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recording/session.h"
#include "session/resume.h"

namespace dihaptic::gui {

struct KnownPerson {
    recording::Participant participant;
    std::string last;       ///< start of the last session, ISO 8601; "" if there has been none
    std::string title;      ///< title of the last session's experiment
    std::string group;      ///< group in the study or, if it is concealed, its code
    std::string day;        ///< next session in the study; "" if all are complete
    bool member = false;    ///< whether the person takes part in the study
    bool complete = false;  ///< whether the person has a complete session of the open experiment
};

class KnownPeople {
  public:
    /// `out`: folder with recordings. `title` and `experiment`: title and file of the open
    /// experiment. If a study with participants has this experiment, its people are known too.
    KnownPeople(std::string out, std::string title, const std::string& experiment);

    /// Those who were recorded last come first.
    const std::vector<KnownPerson>& people() const { return people_; }
    const KnownPerson* find(const std::string& id) const;
    std::vector<std::string> identifiers() const;
    /// Title of the study to which the experiment belongs; "" if there is none.
    const std::string& study() const { return study_; }
    /// The file of the study in which this person takes part; "" if there is none.
    std::string study_of(const std::string& id) const;
    /// The person's unfinished session of the open experiment; nullopt if there is none.
    std::optional<session::Unfinished> unfinished(const std::string& id) const;

  private:
    void add_recorded();
    void add_members(const std::string& experiment);
    KnownPerson& person(const std::string& id);

    std::string out_, title_, study_, study_file_;
    std::vector<KnownPerson> people_;
};

}  // namespace dihaptic::gui
