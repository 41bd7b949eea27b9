#include "tuning_panel.h"

#include <QComboBox>
#include <cmath>

#include "number_box.h"

namespace dihaptic::gui {

TuningPanel::TuningPanel(QWidget* parent) : QWidget(parent) {
    setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Maximum);
    auto* form = new QFormLayout(this);
    frame::Knobs::visit([&](auto knob, const frame::Knob& is) {
        if (is.label != nullptr) add(form, knob, is);
    });
}

template <NamedEnum E>
void TuningPanel::add(QFormLayout* form, E frame::Knobs::*knob, const frame::Knob& is) {
    auto* box = new QComboBox;
    for (const char* name : enum_names(E{})) box->addItem(QString(name).replace('_', ' '));
    box->setToolTip(is.what);
    form->addRow(is.label, box);
    connect(box, &QComboBox::activated, this,
            [this, knob, is](int index) { turn(knob, is, static_cast<E>(index)); });
    show_.emplace_back([this, knob, box] { box->setCurrentIndex(static_cast<int>(knobs_.*knob)); });
}

void TuningPanel::add(QFormLayout* form, double frame::Knobs::*knob, const frame::Knob& is) {
    auto* box = new NumberBox;
    const bool may_be_unset = is.unset != nullptr;
    // an unset knob is stored as one step below the smallest value, and shown as text
    box->setRange(may_be_unset ? is.least - is.step : is.least, is.most);
    if (may_be_unset) box->setSpecialValueText(tr("automatic"));
    box->setSingleStep(is.step);
    box->setDecimals(std::max(0, static_cast<int>(std::ceil(-std::log10(is.step)))));
    if (is.unit != std::string("1")) box->setSuffix(QString(" ") + is.unit);
    box->setKeyboardTracking(false);  // a number takes effect once completely typed
    box->setToolTip(QString(is.what).replace("NaN", tr("automatic")));
    form->addRow(is.label, box);
    connect(box, &QDoubleSpinBox::valueChanged, this, [this, knob, is](double value) {
        turn(knob, is, value < is.least ? kUnmeasured : value);
    });
    show_.emplace_back([this, knob, box] {
        box->setValue(std::isnan(knobs_.*knob) ? box->minimum() : knobs_.*knob);
    });
}

/// Changes one knob. The other knobs keep their exact values, although their boxes may show them
/// rounded.
template <class T>
void TuningPanel::turn(T frame::Knobs::*knob, const frame::Knob& is, T value) {
    if (setting_) return;
    knobs_.*knob = value;
    Q_EMIT turned(knobs_, QString("%1: %2").arg(is.key, QString::fromStdString(words(is, value))));
}

void TuningPanel::set_knobs(const frame::Knobs& knobs) {
    setting_ = true;
    knobs_ = knobs;
    for (const auto& show : show_) show();
    setting_ = false;
}

}  // namespace dihaptic::gui
