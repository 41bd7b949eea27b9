#include "theme.h"

#include <QApplication>
#include <QColor>
#include <QPalette>
#include <QStyleFactory>
#include <algorithm>
#include <cmath>

#include "icons.h"

namespace dihaptic::gui {
namespace {

constexpr double kShapeContrast = 3.1;  // WCAG 2.1, AA: 3 for shapes

/// Relative luminance as defined there.
double luminance(const QColor& colour) {
    const auto linear = [](double x) {
        return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(colour.redF()) + 0.7152 * linear(colour.greenF()) +
           0.0722 * linear(colour.blueF());
}

double contrast(const QColor& a, const QColor& b) {
    const auto [dark, light] = std::minmax({luminance(a), luminance(b)});
    return (light + 0.05) / (dark + 0.05);
}

}  // namespace

void set_dark(bool dark) {
    QApplication::setStyle(QStyleFactory::create("Fusion"));
    const QColor window = dark ? "#2b2f36" : "#f3f2ef";
    const QColor base = dark ? "#21252b" : "#ffffff";
    const QColor text = dark ? "#e6e6e3" : "#20242a";
    const QColor button = dark ? "#3a3f48" : "#e4e2dc";
    const QColor highlight = dark ? "#2f6fb3" : "#0072b2";
    const QColor link = dark ? "#6aaef0" : "#0067a3";
    QPalette palette(text, button, button.lighter(120), button.darker(160), button.darker(120),
                     text, Qt::white, base, window);
    palette.setColor(QPalette::Highlight, highlight);
    palette.setColor(QPalette::HighlightedText, Qt::white);
    palette.setColor(QPalette::Link, link);
    palette.setColor(QPalette::PlaceholderText, dark ? "#9aa0a8" : "#6b6f75");
    palette.setColor(QPalette::ToolTipBase, base);
    palette.setColor(QPalette::ToolTipText, text);
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
        palette.setColor(QPalette::Disabled, role, dark ? "#7b8087" : "#9a9a96");
    QApplication::setPalette(palette);
}

SignLook look_of(Sign sign) {
    switch (sign) {
        case Sign::idle:
            return {"#3d4652", "#ffffff", shapes::kReady};
        case Sign::busy:
            return {"#3d4652", "#ffffff", shapes::kWaiting};
        case Sign::running:
            return {"#00664a", "#ffffff", shapes::kPlay};
        case Sign::paused:
            return {"#f0c000", "#1a1a1a", shapes::kPause};
        case Sign::stopped:
            return {"#b3261e", "#ffffff", shapes::kHalted};
        case Sign::fault:
            return {"#7a1f7f", "#ffffff", shapes::kFault};
    }
    return {};
}

QColor tone(Tone tone) {
    return legible(tone == Tone::good ? QColor("#007a55") : QColor("#b3261e"));
}

QColor legible(const QColor& colour) {
    const QColor paper = QApplication::palette().color(QPalette::Window);
    const bool dark = paper.lightness() < 128;
    QColor out = colour.toHsl();
    float lightness = out.lightnessF();
    while (contrast(out, paper) < kShapeContrast && lightness > 0 && lightness < 1) {
        lightness = std::clamp(lightness + (dark ? 0.02F : -0.02F), 0.0F, 1.0F);
        out.setHslF(out.hslHueF(), out.hslSaturationF(), lightness);
    }
    return out.toRgb();
}

QFont sized(QFont font, double by, bool bold) {
    font.setPointSizeF(font.pointSizeF() * by);
    font.setBold(bold);
    return font;
}

}  // namespace dihaptic::gui
