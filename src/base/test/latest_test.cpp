#include "base/latest.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace dihaptic::latest_test {
namespace {

TEST(Latest, IsTheLastThatWasPublished) {
    Latest<int> latest(7);
    EXPECT_FALSE(latest.is_new());
    EXPECT_EQ(latest.read(), 7);
    latest.publish(1);
    latest.publish(2);
    EXPECT_TRUE(latest.is_new());
    EXPECT_EQ(latest.read(), 2);
    EXPECT_FALSE(latest.is_new());
    EXPECT_EQ(latest.read(), 2);
}

TEST(Latest, StaysWhileItIsReadAndIsNeverHalfWritten) {
    Latest<std::vector<int>> latest(std::vector<int>(100, 0));
    constexpr int kLast = 100000;
    std::thread writer([&] {
        for (int i = 1; i <= kLast; ++i) {
            for (int& x : latest.next()) x = i;
            latest.publish();
        }
    });
    int before = 0;
    while (before < kLast) {
        const std::vector<int>& now = latest.read();
        const int first = now.front();
        for (const int x : now) ASSERT_EQ(x, first);
        ASSERT_GE(first, before);
        before = first;
    }
    writer.join();
}

}  // namespace
}  // namespace dihaptic::latest_test
