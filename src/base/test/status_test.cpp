#include "base/status.h"

#include <gtest/gtest.h>

#include <set>

namespace dihaptic::status_test {
namespace {

TEST(Status, HasOneRowForEachFault) {
    std::multiset<FaultKind> kinds;
    for (const StatusRow& row : kStatusTable) {
        for (const FaultText& fault : row.faults) {
            if (fault.kind == FaultKind::none) continue;
            kinds.insert(fault.kind);
            EXPECT_EQ(row_of(fault.kind), &row);
            EXPECT_FALSE(fault.what.empty()) << row.what;
            EXPECT_FALSE(fault.remedy.empty() && row.remedy.empty()) << row.what;
        }
    }
    EXPECT_EQ(kinds.size(), static_cast<size_t>(FaultKind::stopped));
    EXPECT_EQ(std::set(kinds.begin(), kinds.end()).size(), kinds.size());
    EXPECT_EQ(row_of(FaultKind::none), nullptr);
}

TEST(Status, SaysEachBitOnce) {
    EXPECT_EQ(words(0), "");
    EXPECT_EQ(words(kResumed | kNoMoreData),
              "the recording ended; the session went on after a pause");
    std::set<std::string_view> all;
    for_each_status(~0u, [&](Status bit) { all.insert(describe(bit).what); });
    EXPECT_EQ(all.size(), static_cast<size_t>(kStatusBits));
}

}  // namespace
}  // namespace dihaptic::status_test
