#include <gtest/gtest.h>
#include <unistd.h>

#include <numbers>
#include <thread>
#include <vector>

#include "base/clock.h"
#include "base/diagnostics.h"
#include "base/geometry.h"
#include "base/image.h"
#include "base/json.h"
#include "base/random.h"
#include "base/ring.h"
#include "base/table.h"
#include "base/text_file.h"
#include "testing/allocation_guard.h"
#include "testing/files.h"

namespace dihaptic::base_test {
namespace {

TEST(Pose, ProductsAndInverses) {
    const Pose X_AB{rotation_xyz({0.3, -0.2, 1.1}), {1, 2, 3}};
    const Pose X_BC{rotation_xyz({-1, 0.4, 0.2}), {0.1, -5, 2}};
    const Vec3 p_CQ(0.7, 0.8, -0.9);
    EXPECT_LT(((X_AB * X_BC) * p_CQ - X_AB * (X_BC * p_CQ)).norm(), 1e-14);
    EXPECT_LT((X_AB.inverse() * (X_AB * p_CQ) - p_CQ).norm(), 1e-14);
}

TEST(Pose, RotationsAreAboutFixedAxesXThenYThenZ) {
    const double quarter = std::numbers::pi / 2;
    EXPECT_LT((rotation_xyz({quarter, 0, quarter}) * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm(), 1e-15);
    EXPECT_LT((rotation_xyz({quarter, 0, quarter}) * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm(), 1e-15);
    EXPECT_NEAR(angle_between(rotation_xyz({0, 0, 0.1}), rotation_xyz({0, 0, 0.4})), 0.3, 1e-15);
}

TEST(Clock, SumsOfTicksStayExact) {
    Time t{0};
    for (int i = 0; i < 3'600'000; ++i) t += from_seconds(1e-3);
    EXPECT_EQ(seconds(t), 3600.0);
}

TEST(Random, StreamsAreRepeatableAndIndependent) {
    Random a(7, "tremor"), b(7, "tremor"), other(7, "noise"), seeded(8, "tremor");
    const double first = a.uniform(0, 1);
    EXPECT_EQ(first, b.uniform(0, 1));
    EXPECT_NE(first, other.uniform(0, 1));
    EXPECT_NE(first, seeded.uniform(0, 1));
}

TEST(Random, NormalHasMeanZeroAndUnitVariance) {
    Random random(1, "normal");
    double sum = 0, square = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double x = random.normal();
        sum += x;
        square += x * x;
    }
    EXPECT_NEAR(sum / n, 0, 0.01);
    EXPECT_NEAR(square / n, 1, 0.02);
}

TEST(Ring, RefusesWhatDoesNotFitAndKeepsTheRest) {
    Ring ring(64);
    const std::vector<std::byte> record(20, std::byte{5});
    EXPECT_TRUE(ring.push(record));
    EXPECT_TRUE(ring.push(record));
    EXPECT_FALSE(ring.push(record));
    std::vector<std::byte> out;
    EXPECT_TRUE(ring.pop(out));
    EXPECT_EQ(out, record);
    EXPECT_TRUE(ring.push(record));
    EXPECT_TRUE(ring.pop(out));
    EXPECT_TRUE(ring.pop(out));
    EXPECT_FALSE(ring.pop(out));
}

/// After a ring has been full, e.g. of key presses, and has been emptied, it works as before.
TEST(ValueRing, RefusesWhatDoesNotFitAndGoesOn) {
    ValueRing<char> ring(64);
    int held = 0;
    while (ring.push('a')) ++held;
    EXPECT_GE(held, 64);
    for (int i = 0; i < held; ++i) EXPECT_EQ(ring.pop(), 'a') << i;
    EXPECT_EQ(ring.pop(), std::nullopt);
    EXPECT_TRUE(ring.push('b'));
    EXPECT_EQ(ring.pop(), 'b');
}

TEST(ValueRing, AllocatesNothingOnceItIsMade) {
    DIHAPTIC_NEEDS_ALLOCATION_GUARD();
    ValueRing<char> ring(64);
    const testing::AllocationGuard guard;
    for (int i = 0; i < 1000; ++i) {
        ring.push('a');
        ring.pop();
    }
    EXPECT_EQ(guard.count(), 0u);
}

TEST(Ring, CarriesRecordsOfAllSizesBetweenThreadsInOrder) {
    Ring ring(4096);
    constexpr uint32_t kCount = 200000;
    std::thread consumer([&] {
        std::vector<std::byte> out;
        for (uint32_t i = 0; i < kCount;) {
            if (!ring.pop(out)) continue;
            uint32_t number = 0;
            std::memcpy(&number, out.data(), sizeof(number));
            ASSERT_EQ(number, i);
            ASSERT_EQ(out.size(), sizeof(number) + i % 97);
            ++i;
        }
    });
    std::vector<std::byte> record;
    for (uint32_t i = 0; i < kCount; ++i) {
        record.assign(sizeof(i) + i % 97, std::byte{1});
        std::memcpy(record.data(), &i, sizeof(i));
        while (!ring.push(record)) std::this_thread::yield();
    }
    consumer.join();
}

TEST(Table, ACsvFileIsReadByTheNamesOfItsColumns) {
    testing::TemporaryFolder folder;
    const CsvFile csv(folder.write("t.csv", "a,b\n1,x\n2\n"));
    ASSERT_EQ(csv.rows(), 2u);
    EXPECT_EQ(csv.number(0, "a"), 1);
    EXPECT_EQ(csv.text(0, "b"), "x");
    EXPECT_TRUE(std::isnan(csv.number(0, "b")));
    EXPECT_EQ(csv.text(1, "b"), "");
    EXPECT_EQ(csv.text(1, "c"), "");
    EXPECT_TRUE(csv.has("b"));
    EXPECT_FALSE(csv.has("c"));
    EXPECT_THROW(CsvFile(folder.write("none.csv", "")), Error);  // there is not even a header
    EXPECT_THROW(CsvFile(folder.file("nowhere.csv")), Error);
}

TEST(Table, OfCommasAloneIsRefusedWithItsLine) {
    const testing::TemporaryFolder folder;
    for (const auto& [text, says] :
         {std::pair{"a,b\n1,2\n" + std::string(100'000, ','), "t.csv:3: error: this line has more"},
          std::pair{"a\n" + std::string(7'000'000, '\n'),
                    ": error: from here on the table has more"}}) {
        try {
            read_csv(folder.write("t.csv", text));
            ADD_FAILURE() << says;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(says), std::string::npos) << e.what();
        }
    }
}

TEST(Diagnostics, TellsSoManyMistakesAndThatThereAreMore) {
    Diagnostics diagnostics;
    for (int i = 0; i < 5000; ++i) diagnostics.warning({"a.yaml", i}, "k", "is odd", "");
    for (int i = 0; i < 5000; ++i) diagnostics.error({"a.yaml", i}, "k", "is wrong", "");
    const auto errors =
        std::count_if(diagnostics.problems().begin(), diagnostics.problems().end(),
                      [](const Problem& p) { return p.severity == Severity::error; });
    EXPECT_EQ(errors, 201);
    EXPECT_LT(diagnostics.problems().size(), 1300u);
    EXPECT_EQ(
        diagnostics.problems().back().text(),
        "a.yaml:199: error: there are more problems than those above. Correct these first, and "
        "check again.");
}

TEST(Image, ThatWasCutShortIsRefused) {
    const testing::TemporaryFolder folder;
    Image image;
    image.width = image.height = 64;
    image.rgb.resize(3 * 64 * 64);
    for (size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = static_cast<uint8_t>(i * i);
    write_png(image, folder.file("whole.png"));
    EXPECT_EQ(read_png(folder.file("whole.png")).rgb, image.rgb);
    const std::string whole = testing::read_file(folder.file("whole.png"));
    for (const size_t missing : {size_t{8}, size_t{20}, whole.size() / 2}) {
        try {
            read_png(folder.write("cut.png", whole.substr(0, whole.size() - missing)));
            ADD_FAILURE() << missing;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find("was cut short"), std::string::npos) << e.what();
        }
    }
}

TEST(Json, ThatIsNestedTooDeeplyIsNone) {
    EXPECT_EQ(parse_json("{\"a\": [1, {\"b\": null}]}").dump(), "{\"a\":[1,{\"b\":null}]}");
    EXPECT_TRUE(parse_json("{").is_discarded());
    EXPECT_FALSE(parse_json(std::string(20, '[') + std::string(20, ']')).is_discarded());
    for (const size_t deep : {40, 32'000})
        EXPECT_TRUE(
            parse_json("{\"every_ms\": " + std::string(deep, '[') + std::string(deep, ']') + "}")
                .is_discarded());
}

TEST(Table, CsvQuotesWhatItMustAndReadsBack) {
    Table table;
    table.columns = {{"a", ""}, {"b", ""}};
    table.rows = {{std::string("x, \"y\"\nz"), 0.5},
                  {std::string("plain"), std::numeric_limits<double>::quiet_NaN()}};
    const testing::TemporaryFolder folder;
    write_csv(table, folder.file("t.csv"));
    EXPECT_EQ(testing::read_file(folder.file("t.csv")), "a,b\n\"x, \"\"y\"\"\nz\",0.5\nplain,\n");
    const auto rows = read_csv(folder.file("t.csv"));
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[1][0], "x, \"y\"\nz");
    EXPECT_EQ(rows[2][1], "");
}

TEST(Table, WritingWhereItCannotSaysSo) {
    EXPECT_THROW(write_file("x", "/nowhere/file.csv"), Error);
}

TEST(Problem, EndsItsSentencesOnceAndShowsNoControlCharacters) {
    EXPECT_EQ((Problem{Severity::error, {"f", 2}, "k", "is wrong", "Did you mean x?"}).text(),
              "f:2: error: k: is wrong. Did you mean x?");
    EXPECT_EQ((Problem{Severity::warning, {}, "", "is \x1b[31m red.", ""}).text(),
              "warning: is \xef\xbf\xbd[31m red.");
}

std::string refusal_of(const std::string& file) {
    try {
        read_text_file(file);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(TextFile, IsReadWithoutItsByteOrderMark) {
    const testing::TemporaryFolder folder;
    EXPECT_EQ(read_text_file(folder.write("a", "\xef\xbb\xbfgr\xc3\xbc\xc3\x9f\x65\r\n")),
              "gr\xc3\xbc\xc3\x9f\x65\r\n");
    EXPECT_EQ(read_text_file(folder.write("empty", "")), "");
}

TEST(TextFile, SaysWhatIsWrongWithWhatIsNoText) {
    const testing::TemporaryFolder folder;
    EXPECT_NE(refusal_of(folder.path()).find("is a folder. Name a file in it."), std::string::npos);
    EXPECT_NE(refusal_of(folder.file("gone")).find("No such file"), std::string::npos);
    EXPECT_NE(
        refusal_of(folder.write("utf16", std::string("\xff\xfet\0i\0", 6))).find("is UTF-16 text"),
        std::string::npos);
    EXPECT_NE(
        refusal_of(folder.write("binary", std::string("PK\3\4\0\0", 6))).find("is not a text file"),
        std::string::npos);
    EXPECT_NE(refusal_of(folder.write("escape", "a\nb\x1b[31m\n"))
                  .find("escape:2: error: this line has a control character (ESC"),
              std::string::npos);
    EXPECT_NE(refusal_of(folder.write("latin", "a\nGr\xfc\xdf\x65\n"))
                  .find("latin:2: error: this line is not UTF-8 text"),
              std::string::npos);
}

TEST(TextFile, SaysThatThePermissionIsMissing) {
    if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
    const testing::TemporaryFolder folder;
    const std::string file = folder.write("secret", "x");
    std::filesystem::permissions(file, std::filesystem::perms::none);
    EXPECT_NE(refusal_of(file).find("you do not have permission"), std::string::npos);
}

}  // namespace
}  // namespace dihaptic::base_test
