// What somebody typed into a file and has not saved, so that it outlives the window. It is kept in
// the user's own folder, $XDG_STATE_HOME/dihaptic/drafts or ~/.local/state/dihaptic/drafts, because
// the folder of the file may be a stranger's. One window at a time has a file's draft, and is so
// known to a second one.
#pragma once

#include <QDateTime>
#include <QString>
#include <optional>

namespace dihaptic::gui {

class Draft {
  public:
    struct Left {
        QString text;
        QDateTime at;
    };

    /// `file`: by the path of what is edited, without links.
    explicit Draft(const QString& file);
    ~Draft();
    Draft(const Draft&) = delete;
    Draft& operator=(const Draft&) = delete;

    /// Whether this window has the draft, or has got it now; false: another window has it. Throws
    /// Error when none can be kept.
    bool take();
    /// What a window left that ended before it was saved. To be called by who has the draft.
    std::optional<Left> left() const;
    /// The same. Throws Error.
    void write(const QString& text) const;
    void remove() const;

  private:
    QString head() const;
    bool try_lock();

    QString file_;
    QString path_;
    int lock_ = -1;
};

}  // namespace dihaptic::gui
