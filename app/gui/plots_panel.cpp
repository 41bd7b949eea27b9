#include "plots_panel.h"

#include <QVBoxLayout>
#include <cmath>

#include "base/palette.h"
#include "view/colours.h"

namespace dihaptic::gui {
namespace {

/// The colour of the object, as it appears on the screen.
QColor screen_colour(const Vec3& linear) {
    const auto srgb = [](double x) {  // IEC 61966-2-1
        return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    };
    return QColor::fromRgbF(static_cast<float>(srgb(linear.x())),
                            static_cast<float>(srgb(linear.y())),
                            static_cast<float>(srgb(linear.z())));
}

struct TermFinder {
    const void* member;
    frame::Term found{};

    void operator()(const auto& value, const frame::Term& term) {
        if (&value == member) found = term;
    }
    void each(const auto&...) {}
    void changed(const auto&...) {}
};

/// The description in the recording of a member of the Frame, or of the items in one of the Frame's
/// lists.
template <class Item, class T>
frame::Term term_of(T Item::*member) {
    const Item item;
    TermFinder finder{&(item.*member)};
    Item::visit(item, finder);
    return finder.found;
}

}  // namespace

PlotsPanel::PlotsPanel(QWidget* parent) : QWidget(parent), layout_(new QVBoxLayout(this)) {
    layout_->setContentsMargins(9, 2, 9, 2);
    layout_->setSpacing(0);
}

void PlotsPanel::set_scene(const scene::Scene& scene) {
    for (StripChart* chart : {grasp_, fingers_, heights_}) delete chart;
    const int object = scene.object_index();
    has_object_ = object >= 0;
    std::vector<StripChart::Curve> fingers;
    for (const std::string& name : scene::finger_names(scene)) {
        if (fingers.size() == session::CurveSample::kFingers) break;
        fingers.push_back(
            {QString::fromStdString(name), screen_colour(view::finger_colour(fingers.size()))});
    }
    fingers_count_ = fingers.size();
    std::vector<StripChart::Curve> heights = fingers;
    if (has_object_) {
        heights.push_back({QString::fromStdString(scene.bodies[static_cast<size_t>(object)].name),
                           screen_colour(view::body_colour(scene, static_cast<size_t>(object)))});
    }
    const frame::Term grip = term_of(&frame::Frame::grip_force);
    const frame::Term load = term_of(&frame::Frame::load_force);
    const frame::Term force = term_of(&frame::FingerFrame::f_sent_W);
    const frame::Term position = term_of(&frame::FingerFrame::p_WH);
    grasp_ = new StripChart(tr("Grasp"), grip.unit,
                            {{grip.name, palette::kGrip}, {load.name, palette::kLoad}}, 1);
    fingers_ = new StripChart(QString("|%1|").arg(force.name), force.unit, fingers, 1);
    heights_ = new StripChart(QString("%1, z").arg(position.name),
                              QString("m%1").arg(position.unit), heights, 50);
    for (StripChart* chart : {grasp_, fingers_, heights_}) layout_->addWidget(chart, 1);
}

void PlotsPanel::add(const session::CurveSample& sample) {
    if (grasp_ == nullptr) return;
    grasp_->add(sample.time, {sample.grip_force, sample.load_force});
    const auto count = static_cast<std::ptrdiff_t>(fingers_count_);
    fingers_->add(sample.time, {sample.forces.begin(), sample.forces.begin() + count});
    std::vector<double> heights(sample.heights.begin(), sample.heights.begin() + count);
    if (has_object_) heights.push_back(sample.object_height);
    for (double& height : heights) height *= 1e3;
    heights_->add(sample.time, heights);
}

}  // namespace dihaptic::gui
