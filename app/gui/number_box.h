// A number field that looks the same in every language and uses a decimal point, as files do. A
// typed comma becomes a point; Qt's own field would take the comma for a thousands separator, and
// read 1,5 as 15.
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
