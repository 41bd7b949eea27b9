#include "theme.h"

#include <QApplication>
#include <QColor>
#include <QPainter>
#include <QPalette>
#include <QProxyStyle>
#include <QStyleOption>
#include <algorithm>
#include <cmath>

#include "icons.h"

namespace dihaptic::gui {
namespace {

constexpr double kShapeContrast = 3.1;  // WCAG 2.1, AA: 3 for shapes
constexpr double kTextContrast = 4.6;   // WCAG 2.1, AA: 4.5 for text

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

/// Fusion, with four changes: fields and boxes have an edge that stands out from the background,
/// which the style's own does not in the dark; what is chosen among buttons is marked; and buttons
/// of dialogs have words only, and questions and warnings the window's icons, as the style's are of
/// another family.
class PlainFusion : public QProxyStyle {
  public:
    PlainFusion() : QProxyStyle("Fusion") {}

    int styleHint(StyleHint hint, const QStyleOption* option, const QWidget* widget,
                  QStyleHintReturn* data) const override {
        if (hint == SH_DialogButtonBox_ButtonsHaveIcons) return 0;
        return QProxyStyle::styleHint(hint, option, widget, data);
    }

    int pixelMetric(PixelMetric metric, const QStyleOption* option,
                    const QWidget* widget) const override {
        if (metric == PM_MessageBoxIconSize) return 40;
        return QProxyStyle::pixelMetric(metric, option, widget);
    }

    QIcon standardIcon(StandardPixmap what, const QStyleOption* option,
                       const QWidget* widget) const override {
        switch (what) {
            case SP_MessageBoxQuestion:
                return icon(shapes::kQuestion);
            case SP_MessageBoxInformation:
                return icon(shapes::kInformation);
            case SP_MessageBoxWarning:
            case SP_MessageBoxCritical:
                return icon(shapes::kFault);
            default:
                return QProxyStyle::standardIcon(what, option, widget);
        }
    }

    void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                       const QWidget* widget) const override {
        QProxyStyle::drawPrimitive(element, option, painter, widget);
        const bool enabled = (option->state & State_Enabled) != 0;
        if (element == PE_PanelButtonTool || element == PE_PanelButtonCommand) {
            if ((option->state & State_On) != 0) mark(*option, *painter);
        } else if (element == PE_IndicatorCheckBox || element == PE_IndicatorRadioButton) {
            draw_edge(*option, *painter, element == PE_IndicatorRadioButton);
        } else if (element == PE_FrameLineEdit && enabled &&
                   (option->state & State_HasFocus) == 0) {
            draw_edge(*option, *painter, false);
        }
    }

  private:
    static void mark(const QStyleOption& option, QPainter& painter) {
        constexpr int kBar = 3;  // height of the bar at the bottom [pixels]
        const QRect at = option.rect.adjusted(kBar, 0, -kBar, 0);
        painter.fillRect(QRect(at.left(), at.bottom() - kBar + 1, at.width(), kBar),
                         option.palette.color(QPalette::Link));
    }
    static void draw_edge(const QStyleOption& option, QPainter& painter, bool round) {
        const QColor grey = legible("#808080");
        const QRectF at = QRectF(option.rect).adjusted(0.5, 0.5, -0.5, -0.5);
        painter.save();
        painter.setRenderHint(QPainter::Antialiasing);
        painter.setPen(QPen(grey, round ? 1.3 : 1));  // a curve is paler than a straight line
        painter.setBrush(Qt::NoBrush);
        if (round) {
            painter.drawEllipse(at);
        } else {
            painter.drawRoundedRect(at, 2, 2);
        }
        painter.restore();
    }
};

}  // namespace

void set_dark(bool dark) {
    QApplication::setStyle(new PlainFusion);
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
        case Sign::warning:
            return {"#a35200", "#ffffff", shapes::kWarning};
    }
    return {};
}

QColor tone(Tone tone) {
    return legible(tone == Tone::good ? QColor("#007a55") : QColor("#b3261e"));
}

namespace {

/// The colour, lighter or darker as far as it must be to have this contrast with the paper.
QColor contrasting(const QColor& colour, const QColor& paper, double least) {
    const bool dark = paper.lightness() < 128;
    QColor out = colour.toHsl();
    float lightness = out.lightnessF();
    while (contrast(out, paper) < least && lightness > 0 && lightness < 1) {
        lightness = std::clamp(lightness + (dark ? 0.02F : -0.02F), 0.0F, 1.0F);
        out.setHslF(out.hslHueF(), out.hslSaturationF(), lightness);
    }
    return out.toRgb();
}

}  // namespace

QColor legible(const QColor& colour) {
    return contrasting(colour, QApplication::palette().color(QPalette::Window), kShapeContrast);
}

QColor readable(const QColor& colour, const QColor& paper) {
    return contrasting(colour, paper, kTextContrast);
}

QFont sized(QFont font, double by, bool bold) {
    font.setPointSizeF(font.pointSizeF() * by);
    font.setBold(bold);
    return font;
}

}  // namespace dihaptic::gui
