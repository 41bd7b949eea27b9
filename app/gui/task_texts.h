// What the running task says to the person: its texts, either over the scene or on a page in the
// scene's place, and the questions that it asks.
#pragma once

#include <optional>

#include "questions_view.h"
#include "session/plan.h"

namespace dihaptic::gui {

class TaskTexts {
  public:
    struct Words {
        QString message;  ///< texts over the scene
        QString page;     ///< text of the page shown instead of the scene
        QString picture;  ///< picture on that page
    };
    /// Reads the texts of a new frame. Returns whether they changed.
    bool follow(const session::Plan& plan, const frame::Frame& frame);
    void clear() { *this = {}; }
    Words words(const session::Plan& plan) const;

  private:
    QString said_;
    int page_ = -1;  // index of the page on which the texts are shown; -1 if there is none
};

/// The form that is being filled in, or the rating that can be answered with a click; nullopt if
/// there is none.
std::optional<Asked> asked_in(const frame::Frame& frame, const task::TaskPlan& plan);

}  // namespace dihaptic::gui
