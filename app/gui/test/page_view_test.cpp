#include "page_view.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <QFile>
#include <QTemporaryDir>

#include "answer_until.h"

namespace dihaptic::gui {
namespace {

/// An endless animation of two pictures of one pixel, black and white, each shown for 20 ms.
QByteArray moving_gif() {
    const QByteArray frame(
        "\x21\xf9\x04\x00\x02\x00\x00\x00\x2c\x00\x00\x00\x00\x01\x00\x01\x00\x00\x02", 19);
    const QByteArray loop("\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00", 19);
    return QByteArray("GIF89a\x01\x00\x01\x00\x80\x00\x00\x00\x00\x00\xff\xff\xff", 19) + loop +
           frame + QByteArray("\x02\x44\x01\x00", 4) + frame +
           QByteArray("\x02\x4c\x01\x00\x3b", 5);
}

TEST(PageView, ShowsAPictureThatMoves) {
    int count = 1;
    char name_of_program[] = "test";
    char* names[] = {name_of_program, nullptr};
    qputenv("QT_QPA_PLATFORM", "offscreen");
    const QApplication application(count, names);
    const QTemporaryDir folder;
    const QString name = folder.filePath("moves.gif");
    QFile file(name);
    ASSERT_TRUE(file.open(QIODevice::WriteOnly));
    file.write(moving_gif());
    file.close();
    PageView page(nullptr);
    int moves = 0;
    page.on_move([&] { ++moves; });
    EXPECT_TRUE(page.set_page("Watch", name));
    EXPECT_FALSE(page.set_page("Watch", name));
    EXPECT_TRUE(answer_until([&] { return moves > 3; }));
    // the next page has no animation
    EXPECT_TRUE(page.set_page("Go", ""));
    moves = 0;
    for (int i = 0; i < 10; ++i) {
        QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
        QThread::msleep(10);
    }
    EXPECT_EQ(moves, 0);
}

}  // namespace
}  // namespace dihaptic::gui
