#include "recording/showings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "testing/files.h"

namespace dihaptic::recording::showings_test {
namespace {

TEST(Showings, AChangeWasSeenFromTheFirstPictureOnThatIsOfItsTickOrALaterOne) {
    const testing::TemporaryFolder parent;
    const SessionFolder folder = SessionFolder::create(parent.path(), "lift");
    EXPECT_TRUE(Showings(folder).empty());
    {
        ShowingsWriter writer(folder);
        writer.add({100, 0.104});
        writer.add({116, 0.1225});
        writer.add({3000, 3.01});
        writer.flush();
    }
    const Showings showings(folder);
    EXPECT_EQ(showings.onset(0, 0), 0.104);
    EXPECT_EQ(showings.onset(100, 0.1), 0.104);
    EXPECT_EQ(showings.onset(101, 0.101), 0.1225);
    // the change is undone before or at the next picture
    EXPECT_TRUE(std::isnan(showings.onset(101, 0.101, 110)));
    EXPECT_EQ(showings.onset(101, 0.101, 117), 0.1225);
    EXPECT_TRUE(std::isnan(showings.onset(117, 0.117)));  // the window showed nothing for seconds
    EXPECT_EQ(showings.onset(3000, 3), 3.01);
    EXPECT_TRUE(std::isnan(showings.onset(3001, 3.001)));
}

TEST(Showings, ALineThatAKillCutIsLeftOut) {
    const testing::TemporaryFolder parent;
    const SessionFolder folder = SessionFolder::create(parent.path(), "lift");
    std::ofstream(folder.file("shown.csv")) << "tick,shown_s\n100,0.104\n11";
    const Showings showings(folder);
    EXPECT_EQ(showings.onset(100, 0.1), 0.104);
    EXPECT_TRUE(std::isnan(showings.onset(101, 0.101)));
}

}  // namespace
}  // namespace dihaptic::recording::showings_test
