// Tests which libraries a rig may load.
#include "rig/libraries.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "base/field_writer.h"
#include "testing/files.h"

namespace dihaptic::rig::libraries_test {
namespace {

/// A rig of real devices with an outlet and a tracked head, each of which names a library.
class Libraries : public ::testing::Test {
  protected:
    testing::TemporaryFolder folder_;
    const std::string file_ = folder_.write("rig.yaml",
                                            "devices:\n"
                                            "  - finger: index\n"
                                            "    backend: openhaptics\n"
                                            "    options:\n"
                                            "      library: ./own/evil.so\n"
                                            "outlets:\n"
                                            "  - kind: lsl\n"
                                            "    options: { library: own/other.so }\n"
                                            "head: { stream: Head, library: own/third.so }\n");
    Diagnostics diagnostics_;
    Libraries() {
        setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
        std::filesystem::create_directory(folder_.file("own"));
        for (const char* name : {"own/evil.so", "own/other.so", "own/third.so"})
            folder_.write(name, "no library");
    }
    ~Libraries() override { unsetenv("XDG_CONFIG_HOME"); }

    Rig read(NamedBy named_by) { return read_rig(file_, diagnostics_, named_by); }
};

TEST_F(Libraries, ThatAFileNamesAreNotLoaded) {
    const Rig rig = read(NamedBy::a_file);
    const std::vector<Problem> strange = strange_libraries(rig);
    ASSERT_EQ(strange.size(), 3u);
    EXPECT_EQ(strange[0].place.line, 5);
    EXPECT_EQ(strange[1].place.line, 8);
    const std::string text = strange[1].text();
    EXPECT_NE(text.find("rig.yaml:8: error: library: '" + folder_.file("own/other.so") +
                        "' is not loaded"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("add the line '- " + folder_.file("own/other.so") + "' to " +
                        folder_.path() + "/dihaptic/libraries.yaml"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("--rig"), std::string::npos) << text;
    EXPECT_THROW(check_libraries(rig), Error);
    try {
        make_devices(rig, {"index"}, {});
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(std::string(e.what()).find("tried"), std::string::npos) << e.what();
    }
}

TEST_F(Libraries, ThatTheOperatorsRigNamesAreLoaded) {
    const Rig rig = read(NamedBy::the_operator);
    EXPECT_NO_THROW(check_libraries(rig));
    try {
        make_devices(rig, {"index"}, {});
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("tried " + folder_.file("own/evil.so")),
                  std::string::npos)
            << e.what();
    }
}

TEST_F(Libraries, ThatARigHadWhenItWasFrozenAreNotLoadedByThat) {
    const Rig rig = read(NamedBy::the_operator);
    const Rig frozen =
        read_rig(folder_.write("frozen.yaml", to_yaml(write_fields(rig))), diagnostics_);
    EXPECT_EQ(strange_libraries(frozen).size(), 3u);
    EXPECT_THROW(check_libraries(frozen), Error);
}

TEST_F(Libraries, ThatTheUserAllowsAndThoseOfTheSystemAreLoadedForAll) {
    const std::string mine = folder_.write("mine.so", "");
    const std::string rig = folder_.write(
        "other.yaml", "devices: [{finger: index, backend: openhaptics, options: {library: '" +
                          mine + "'}}]\noutlets: [{kind: lsl, options: {library: liblsl.so.9}}]\n");
    EXPECT_THROW(check_libraries(read_rig(rig, diagnostics_)), Error);
    std::filesystem::create_directory(folder_.path() + "/dihaptic");
    folder_.write("dihaptic/libraries.yaml", "- " + mine + "\n");
    EXPECT_NO_THROW(check_libraries(read_rig(rig, diagnostics_)));
    folder_.write("dihaptic/libraries.yaml", "mine\n");
    EXPECT_THROW(check_libraries(read_rig(rig, diagnostics_)), Error);
}

TEST_F(Libraries, MistakesInTheUsersListAreToldOnce) {
    std::filesystem::create_directory(folder_.path() + "/dihaptic");
    folder_.write("dihaptic/libraries.yaml", "- mine.so\n");
    const std::vector<Problem> told = strange_libraries(read(NamedBy::a_file));
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].text().find("libraries.yaml:1: "), std::string::npos) << told[0].text();
}

}  // namespace
}  // namespace dihaptic::rig::libraries_test
