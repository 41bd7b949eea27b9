// The log panel, which always scrolls to the last line.
#pragma once

#include <QScrollBar>
#include <QTime>

#include "plain_text.h"

namespace dihaptic::gui {

class LogView : public PlainText {
  public:
    LogView() {
        setReadOnly(true);
        setMaximumBlockCount(5000);
        setAccessibleName(QObject::tr("Log"));
    }
    /// Appends a line, preceded by the time of day; problems are set in bold.
    void add(const QString& text, bool problem) {
        QString html = text.toHtmlEscaped();
        html.replace("\n", "<br>");
        if (problem) html = "<b>" + html + "</b>";
        appendHtml(QTime::currentTime().toString("HH:mm:ss") + "  " + html);
        show_last();
    }

  protected:
    void resizeEvent(QResizeEvent* event) override {
        PlainText::resizeEvent(event);
        show_last();
    }

  private:
    void show_last() { verticalScrollBar()->setValue(verticalScrollBar()->maximum()); }
};

}  // namespace dihaptic::gui
