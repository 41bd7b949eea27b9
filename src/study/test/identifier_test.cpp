#include "study/identifier.h"

#include <gtest/gtest.h>

#include "base/diagnostics.h"

namespace dihaptic::study::identifier_test {
namespace {

TEST(Identifier, IdentifiesWithoutNaming) {
    for (const char* id : {"S07", "7b", "P_01", "control-12"}) {
        EXPECT_EQ(fault_of_identifier(id), IdentifierFault::none) << id;
        EXPECT_NO_THROW(check_identifier(id, "--participant")) << id;
    }
    EXPECT_EQ(fault_of_identifier(std::string(kLongestIdentifier, '7')), IdentifierFault::none);
}

TEST(Identifier, IsRefusedForOneReason) {
    const std::pair<std::string, IdentifierFault> cases[] = {
        {"", IdentifierFault::empty},
        {"S 07", IdentifierFault::sign},
        {"S07;", IdentifierFault::sign},
        {"-S07", IdentifierFault::sign},  // an option, and a formula to a spreadsheet
        {"M\u00fcller7", IdentifierFault::sign},
        {"../S07", IdentifierFault::sign},
        {std::string(kLongestIdentifier + 1, '7'), IdentifierFault::too_long},
        {"sim-007", IdentifierFault::simulated},
        {"SIM-007", IdentifierFault::simulated},
        {"anna", IdentifierFault::no_digit}};
    for (const auto& [id, fault] : cases) {
        EXPECT_EQ(fault_of_identifier(id), fault) << id;
        EXPECT_THROW(check_identifier(id, "--participant"), Error) << id;
    }
}

}  // namespace
}  // namespace dihaptic::study::identifier_test
