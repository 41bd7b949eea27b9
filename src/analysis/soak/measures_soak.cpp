// Tests the measures for ten thousand randomly spoilt reaches.
#include "analysis/test/reaches.h"

namespace dihaptic::analysis::measures_test {
namespace {

TEST(MeasuresSoak, OfTenThousandSpoiltReachesMakeSenseOrSayWhyTheyAreMissing) {
    expect_sense_of_spoilt(10000);
}

}  // namespace
}  // namespace dihaptic::analysis::measures_test
