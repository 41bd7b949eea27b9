// Tests what the list of sessions says about a session whose program was killed.
#include "sessions_dialog.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QLabel>
#include <QTreeWidget>

#include "answer_until.h"
#include "base/text_file.h"
#include "session/record.h"
#include "testing/files.h"

namespace dihaptic::gui::sessions_dialog_test {
namespace {

/// Makes a recorded session look as if its program had been killed.
void kill_afterwards(const recording::SessionFolder& folder) {
    recording::SessionInfo info = folder.read_info();
    info.state = recording::SessionState::running;
    folder.write_info(info);
}

TEST(SessionsDialog, SaysThatAKilledSessionIsBrokenOffAndWhatToDo) {
    int count = 1;
    char name[5] = "test";
    char* names[2] = {name, nullptr};
    qputenv("QT_QPA_PLATFORM", "offscreen");
    const QApplication application(count, names);
    const testing::TemporaryFolder parent;
    session::Request request;
    request.file = "scenes/block-on-table.yaml";
    session::RunOptions options;
    options.out = parent.path();
    const std::atomic<bool> stop{false};
    const std::string session = session::record(session::make_plan(request), options, stop).folder;
    const auto folder = recording::SessionFolder::open(session);
    kill_afterwards(folder);
    const auto state = [&] {
        const SessionsDialog dialog(QString::fromStdString(parent.path()));
        const auto* list = dialog.findChild<QTreeWidget*>();
        EXPECT_TRUE(answer_until([&] { return list->topLevelItemCount() == 1; }));
        QStringList all{list->topLevelItem(0)->text(4)};
        for (const QLabel* label : dialog.findChildren<QLabel*>()) all += label->text();
        return all.join('\n');
    };
    EXPECT_TRUE(state().startsWith("broken off")) << state().toStdString();
    EXPECT_TRUE(state().contains("dihaptic recover " + QString::fromStdString(session)));
    const recording::SessionLock recording(folder);
    EXPECT_TRUE(state().startsWith("running")) << state().toStdString();
    EXPECT_FALSE(state().contains("dihaptic recover"));
}

}  // namespace
}  // namespace dihaptic::gui::sessions_dialog_test
