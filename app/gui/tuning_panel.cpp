#include "tuning_panel.h"

#include <QFormLayout>

namespace dihaptic::gui {
namespace {

QDoubleSpinBox* box(double least, double most, double step, int decimals, const QString& unit) {
    auto* out = new QDoubleSpinBox;
    out->setRange(least, most);
    out->setSingleStep(step);
    out->setDecimals(decimals);
    out->setSuffix(unit);
    out->setKeyboardTracking(false);  // a number counts once it is typed completely
    return out;
}

template <class Enum>
QComboBox* choice() {
    auto* out = new QComboBox;
    for (const char* name : enum_names(Enum{})) out->addItem(name);
    return out;
}

constexpr double kUnset = -0.1;  // below the least damping; shown in words

}  // namespace

TuningPanel::TuningPanel(QWidget* parent)
    : QWidget(parent),
      proxy_(choice<scene::ProxyKind>()),
      coupling_(choice<haptics::CouplingKind>()),
      stiffness_(box(1, 20000, 100, 0, " N/m")),
      damping_(box(kUnset, 50, 0.1, 1, " N s/m")),
      smoothing_(box(0.01, 1, 0.05, 2, "")),
      solver_(choice<dynamics::Solver>()),
      friction_(box(0, 5, 0.1, 2, " x")) {
    setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Maximum);
    proxy_->setToolTip("changes once the fingers are clear of everything");
    friction_->setToolTip("every coefficient of friction, times those of the scene");
    damping_->setSpecialValueText("k h / 2");
    smoothing_->setToolTip("share of the new force in the force sent: of the dual spring");
    auto* form = new QFormLayout(this);
    form->addRow("&Coupling", coupling_);
    form->addRow("Stiff&ness", stiffness_);
    form->addRow("&Damping", damping_);
    form->addRow("S&moothing", smoothing_);
    form->addRow("Contact so&lver", solver_);
    form->addRow("Frict&ion", friction_);
    form->addRow("Pro&xy", proxy_);
    connect(solver_, &QComboBox::activated, this,
            [this](int index) { Q_EMIT solver_chosen(static_cast<dynamics::Solver>(index)); });
    connect(coupling_, &QComboBox::activated, this, &TuningPanel::tune);
    for (QDoubleSpinBox* value : {stiffness_, damping_, smoothing_})
        connect(value, &QDoubleSpinBox::valueChanged, this, &TuningPanel::tune);
    connect(friction_, &QDoubleSpinBox::valueChanged, this, [this](double scale) {
        if (!setting_) Q_EMIT friction_scaled(scale);
    });
    connect(proxy_, &QComboBox::activated, this,
            [this](int index) { Q_EMIT proxy_chosen(static_cast<scene::ProxyKind>(index)); });
}

void TuningPanel::set_settings(const servo::Settings& settings) {
    setting_ = true;
    const haptics::Tuning tuning = settings.coupling.tuning();
    coupling_->setCurrentIndex(static_cast<int>(tuning.kind));
    stiffness_->setValue(tuning.stiffness);
    damping_->setValue(tuning.damping.value_or(kUnset));
    smoothing_->setValue(tuning.smoothing);
    friction_->setValue(1);
    proxy_->setCurrentIndex(static_cast<int>(settings.proxy.kind));
    solver_->setCurrentIndex(static_cast<int>(settings.dynamics.solver));
    setting_ = false;
}

void TuningPanel::tune() {
    if (setting_) return;
    const double damping = damping_->value();
    Q_EMIT tuned({static_cast<haptics::CouplingKind>(coupling_->currentIndex()),
                  stiffness_->value(), damping < 0 ? std::nullopt : std::optional(damping),
                  smoothing_->value()});
}

}  // namespace dihaptic::gui
