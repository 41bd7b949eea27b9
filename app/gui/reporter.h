// Writes the report of a session in a separate thread, for the window.
#pragma once

#include <QObject>
#include <thread>

namespace dihaptic::gui {

class Reporter : public QObject {
    Q_OBJECT

  public:
    using QObject::QObject;
    ~Reporter() override;

    /// Writes the report of the session in `folder`. Only one report is written at a time: if
    /// another is being written, does nothing but tell this.
    void write(const QString& folder);
    bool busy() const { return thread_.joinable(); }

  Q_SIGNALS:
    /// `text`: what is being done, or why not.
    void told(const QString& text);
    void written(const QString& page);
    void failed(const QString& why);

  private:
    std::thread thread_;
};

}  // namespace dihaptic::gui
