// Measures contrasts as WCAG 2.1 defines them, in both themes.
#include "theme.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QCheckBox>
#include <QImage>
#include <QLineEdit>
#include <QPalette>
#include <QRadioButton>
#include <QTextBlock>
#include <QTextLayout>
#include <QToolButton>
#include <algorithm>
#include <cmath>
#include <set>

#include "base/palette.h"
#include "code_edit.h"

namespace dihaptic::gui {
namespace {

constexpr double kText = 4.5;   // AA, for text
constexpr double kShape = 3.0;  // AA, for shapes and large text

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

class ThemeTest : public ::testing::TestWithParam<bool> {
  protected:
    ThemeTest() { set_dark(GetParam()); }
    static QColor colour(QPalette::ColorRole role, QPalette::ColorGroup group = QPalette::Active) {
        return QApplication::palette().color(group, role);
    }

    int count_ = 1;
    char name_[5] = "test";
    char* names_[2] = {name_, nullptr};
    const bool offscreen_ = qputenv("QT_QPA_PLATFORM", "offscreen");
    QApplication application_{count_, names_};
};

TEST_P(ThemeTest, TextsCanBeRead) {
    for (const auto& [ink, paper] : {std::pair{QPalette::WindowText, QPalette::Window},
                                     {QPalette::Text, QPalette::Base},
                                     {QPalette::ButtonText, QPalette::Button},
                                     {QPalette::HighlightedText, QPalette::Highlight},
                                     {QPalette::PlaceholderText, QPalette::Base},
                                     {QPalette::ToolTipText, QPalette::ToolTipBase},
                                     {QPalette::Link, QPalette::Base}}) {
        EXPECT_GE(contrast(colour(ink), colour(paper)), kText) << ink << " on " << paper;
    }
}

/// The smallest contrast of a coloured piece of the text with its background.
double least_contrast_in(CodeEdit& edit) {
    double least = 21;
    const QColor paper = QApplication::palette().color(QPalette::Base);
    for (QTextBlock block = edit.document()->begin(); block.isValid(); block = block.next()) {
        for (const auto& range : block.layout()->formats())
            least = std::min(least, contrast(range.format.foreground().color(), paper));
    }
    return least;
}

TEST_P(ThemeTest, ColoursOfAFilesTextCanBeRead) {
    CodeEdit edit;
    edit.setPlainText("key: 'quoted'  # comment\n");
    QCoreApplication::processEvents();
    EXPECT_LT(least_contrast_in(edit), 20) << "nothing is coloured";
    EXPECT_GE(least_contrast_in(edit), kText);
    set_dark(!GetParam());
    QCoreApplication::processEvents();
    EXPECT_GE(least_contrast_in(edit), kText) << "after a change of the theme";
}

TEST_P(ThemeTest, SignsCanBeReadAndToldApart) {
    std::set<QString> icons;
    for (int i = 0; i < kSigns; ++i) {
        const SignLook look = look_of(static_cast<Sign>(i));
        EXPECT_GE(contrast(look.ink, look.fill), kText) << i;
        EXPECT_TRUE(icons.insert(QString::fromStdString(std::string(look.icon))).second) << i;
    }
    EXPECT_GE(contrast(look_of(Sign::paused).fill, look_of(Sign::stopped).fill), kShape);
}

TEST_P(ThemeTest, ColoursOfDataStandOut) {
    std::vector<QColor> colours{palette::kGrip, palette::kLoad, "#808080"};
    for (size_t i = 0; i < palette::kFingers.size(); ++i) colours.emplace_back(palette::finger(i));
    for (const QColor& colour : colours) {
        EXPECT_GE(contrast(legible(colour), this->colour(QPalette::Window)), kShape)
            << colour.name().toStdString();
    }
    for (const Tone mark : {Tone::good, Tone::bad})
        EXPECT_GE(contrast(tone(mark), colour(QPalette::Window)), kShape);
}

/// The largest contrast of a pixel of the widget's picture with the window.
double edge_of(QWidget& widget) {
    widget.resize(widget.sizeHint());
    QImage image(widget.size(), QImage::Format_RGB32);
    widget.render(&image);
    const QColor paper = QApplication::palette().color(QPalette::Window);
    double most = 0;
    for (int x = 0; x < image.width(); ++x) {
        for (int y = 0; y < image.height(); ++y)
            most = std::max(most, contrast(image.pixelColor(x, y), paper));
    }
    return most;
}

TEST_P(ThemeTest, WhatIsNotTickedAndWhatIsEmptyHaveAnEdge) {
    QCheckBox box;
    QRadioButton button;
    QLineEdit line;
    for (QWidget* widget : std::initializer_list<QWidget*>{&box, &button, &line})
        EXPECT_GE(edge_of(*widget), kShape) << widget->metaObject()->className();
}

TEST_P(ThemeTest, WhatIsChosenAmongButtonsIsMarked) {
    QToolButton chosen, other;
    for (QToolButton* button : {&chosen, &other}) button->setCheckable(true);
    chosen.setChecked(true);
    EXPECT_GE(edge_of(chosen), kShape);
    EXPECT_GT(edge_of(chosen), 1.2 * edge_of(other));
}

INSTANTIATE_TEST_SUITE_P(InBothThemes, ThemeTest, ::testing::Bool());

}  // namespace
}  // namespace dihaptic::gui
