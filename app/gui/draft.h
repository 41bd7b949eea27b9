// Unsaved changes to a file, kept so that they outlive the window. Drafts are kept in the user's
// own folder, $XDG_STATE_HOME/dihaptic/drafts or ~/.local/state/dihaptic/drafts, because the file's
// folder may belong to another person. Only one window at a time holds a file's draft, so that a
// second window notices the first.
#pragma once

#include <QDateTime>
#include <QString>
#include <optional>

#include "base/descriptor.h"

namespace dihaptic::gui {

class Draft {
  public:
    struct Left {
        QString text;
        QDateTime at;
    };

    /// `file`: path of the edited file, with links resolved.
    explicit Draft(const QString& file);
    ~Draft();
    Draft(const Draft&) = delete;
    Draft& operator=(const Draft&) = delete;

    /// Takes the draft, unless another window holds it. Returns whether this window now holds the
    /// draft. Throws Error when no draft can be kept.
    bool take();
    /// The unsaved text left by a window that has ended. To be called only while holding the draft.
    std::optional<Left> left() const;
    /// Stores the text as the draft. Throws Error when this fails.
    void write(const QString& text) const;
    void remove() const;

  private:
    QString head() const;
    bool try_lock();

    QString file_;
    QString path_;
    Descriptor lock_;
};

}  // namespace dihaptic::gui
