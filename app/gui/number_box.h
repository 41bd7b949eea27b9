// A field for a number, which looks and is typed the same in every language: with a point before
// its decimals, as in files. A comma that is typed becomes one; Qt's own field would leave it out
// where it parts thousands, and read 1,5 as 15.
#pragma once

#include <QDoubleSpinBox>

namespace dihaptic::gui {

class NumberBox : public QDoubleSpinBox {
    Q_OBJECT

  public:
    explicit NumberBox(QWidget* parent = nullptr) : QDoubleSpinBox(parent) {
        setLocale(QLocale::c());
    }

  protected:
    QValidator::State validate(QString& text, int& at) const override {
        text.replace(',', '.');
        return QDoubleSpinBox::validate(text, at);
    }
};

}  // namespace dihaptic::gui
