// Tests that the window names things as the command line and the tables do.
#include <gtest/gtest.h>

#include <QApplication>
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QTemporaryDir>
#include <map>
#include <set>

#include "base/field_table.h"
#include "column_words.h"
#include "composer.h"
#include "frame/knobs.h"
#include "frame/settings.h"
#include "rows/lift_row.h"
#include "rows/trial_row.h"
#include "session_panel.h"
#include "tuning_panel.h"

namespace dihaptic::gui::names_test {
namespace {

/// The name of a column from its words in the window.
std::string name_of(QString words) {
    return words.remove('[').remove(']').replace(' ', '_').replace('/', '_').toStdString();
}

TEST(Names, OfColumnsAreThoseOfTablesInWords) {
    std::set<QString> seen;
    for (const auto& columns :
         {list_figures(rows::TrialMeasures{}).columns, list_figures(rows::LiftRow{}).columns}) {
        for (const Table::Column& column : columns) {
            const QString words = column_words(QString::fromStdString(column.name));
            EXPECT_EQ(name_of(words), column.name);
            EXPECT_FALSE(words.contains('_')) << column.name;
            EXPECT_EQ(words.contains('['), !column.unit.empty()) << column.name;
            seen.insert(words);
        }
    }
    EXPECT_GE(seen.size(), 20u);
}

TEST(Names, OfKnobsAreThoseOfTheCommandLine) {
    std::set<std::string> settings;
    for (const auto& row : list_fields(frame::Settings{}, {}).rows)
        settings.insert(std::get<std::string>(row.front()));
    int knobs = 0;
    frame::Knobs::visit([&](auto, const frame::Knob& knob) {
        if (knob.label == nullptr || knob.name == std::string("friction_scale")) return;
        ++knobs;
        EXPECT_TRUE(settings.contains(knob.key)) << knob.key << " is not accepted by --set";
        const QString word = QString(knob.label).remove('&').section(' ', -1).toLower();
        EXPECT_TRUE(QString(knob.key).contains(word)) << knob.label;
    });
    EXPECT_GE(knobs, 5);
}

TEST(Names, OfWhatMovesTheHandAreThoseOfTheTables) {
    int count = 1;
    char name[5] = "test";
    char* names[2] = {name, nullptr};
    qputenv("QT_QPA_PLATFORM", "offscreen");
    const QApplication application(count, names);
    const QTemporaryDir folder;
    std::atomic<bool> stop{false};
    SessionControl control(folder.filePath("sessions"), 0, stop);
    const SessionPanel panel(control);
    QStringList choices;
    for (const QComboBox* box : panel.findChildren<QComboBox*>()) {
        for (int i = 0; i < box->count(); ++i) choices += box->itemText(i);
    }
    for (const auto mover :
         {recording::Mover::mouse, recording::Mover::script, recording::Mover::simulated_person}) {
        const QString words =
            QString::fromStdString(std::string(enum_name(mover))).replace('_', ' ');
        EXPECT_EQ(choices.filter(words).size(), 1) << words.toStdString();
    }
}

TEST(Names, HaveALetterOfTheirOwnWithAlt) {
    int count = 1;
    char name[5] = "test";
    char* names[2] = {name, nullptr};
    qputenv("QT_QPA_PLATFORM", "offscreen");
    const QApplication application(count, names);
    const QTemporaryDir folder;
    std::atomic<bool> stop{false};
    SessionControl control(folder.filePath("sessions"), 0, stop);
    const SessionPanel panel(control);
    const TuningPanel tuning;
    const Composer composer;
    std::map<QChar, QString> seen{
        {'f', "File"}, {'e', "Edit"}, {'s', "Session"}, {'v', "View"}, {'h', "Help"}};
    const auto take = [&](const QString& text) {
        const qsizetype at = text.indexOf('&');
        if (at < 0) return;
        const auto [one, is_new] = seen.emplace(text[at + 1].toLower(), text);
        EXPECT_TRUE(is_new) << text.toStdString() << ", " << one->second.toStdString();
    };
    for (const QWidget* shown : std::initializer_list<const QWidget*>{&panel, &tuning, &composer}) {
        for (const QLabel* label : shown->findChildren<QLabel*>()) take(label->text());
        for (const auto* button : shown->findChildren<QPushButton*>()) take(button->text());
    }
    EXPECT_GE(seen.size(), 15u);
}

}  // namespace
}  // namespace dihaptic::gui::names_test
