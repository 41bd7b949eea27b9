// Tests the messages that are given when a manufacturer's library cannot be used.
#include "base/library.h"

#include <gtest/gtest.h>

#include "base/temporary_folder.h"
#include "base/text_file.h"

namespace dihaptic::library_test {
namespace {

Library::Spec spec() {
    return {"Acme's SDK",
            {"libacme.so.2", "libacme.so"},
            false,
            "Install the package acme.",
            {{"libacmeusb", "Install the package acme-usb."}}};
}

std::string failure(const Library::Spec& wanted, const std::string& path = "") {
    try {
        const Library library(wanted, path, {"rig.yaml", 3});
    } catch (const Error& e) {
        return e.what();
    }
    return "none";
}

TEST(Library, ThatIsMissingIsToldWithAllNamesAndWhatToInstall) {
    const std::string told = failure(spec());
    EXPECT_NE(told.find("rig.yaml:3: error: library: Acme's SDK cannot be loaded; tried "
                        "libacme.so.2 (cannot open shared object file"),
              std::string::npos)
        << told;
    EXPECT_NE(told.find(", libacme.so (cannot"), std::string::npos) << told;
    EXPECT_NE(told.find("Install the package acme."), std::string::npos) << told;
}

TEST(Library, ThatNeedsAnotherIsToldWithThatOnesRemedy) {
    Library::Spec wanted = spec();
    wanted.files = {"libacmeusb-1.so"};  // dlopen() states the name of the file that it cannot find
    EXPECT_NE(failure(wanted).find("Install the package acme-usb."), std::string::npos);
}

TEST(Library, OfAnotherKindIsToldAsTheLoaderSaysIt) {
    const TemporaryFolder folder;
    const std::string file = folder.path() + "/libacme.so";
    write_file("no library at all", file);
    const std::string told = failure(spec(), file);
    EXPECT_NE(told.find("tried " + file + " (file too short"), std::string::npos) << told;
}

TEST(Library, OfAnotherVersionIsToldWithTheSymbolThatItLacks) {
    const Library library(spec(), "libm.so.6", {});
    EXPECT_TRUE(library.file().ends_with("/libm.so.6")) << library.file();
    double (*cosine)(double) = nullptr;
    library.find("cos", cosine);
    ASSERT_NE(cosine, nullptr);
    EXPECT_EQ(cosine(0), 1);
    try {
        library.find("acmeGetDeviceCount", cosine);
        FAIL();
    } catch (const Error& e) {
        const std::string told = e.what();
        EXPECT_NE(told.find("has no acmeGetDeviceCount. This program does not support its version"),
                  std::string::npos)
            << told;
    }
}

}  // namespace
}  // namespace dihaptic::library_test
