// Tests how the text of a scene is changed when one of its bodies is moved.
#include "scene/body_text.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/field_writer.h"
#include "base/text_file.h"
#include "scene/scene.h"

namespace dihaptic::scene::body_text_test {
namespace {

std::string moved(const std::string& text, const std::string& name, const Vec3& way_mm,
                  double turn = 0) {
    return changed(text, moved_body(text, name, way_mm * 1e-3, turn));
}

/// The error message that explains why a body cannot be moved.
std::string refusal(const std::string& text, const std::string& name) {
    try {
        moved_body(text, name, {0.001, 0, 0});
    } catch (const Error& e) {
        return e.what();
    }
    return "none";
}

Scene scene_of(const std::string& text) {
    Scene out;
    Diagnostics diagnostics;
    read_fields(out, parse_yaml(text, "scene.yaml"), diagnostics);
    diagnostics.throw_if_errors();
    return out;
}

/// The content of the scene without the position of one body, as text.
std::string others(Scene scene, const std::string& name) {
    for (Body& body : scene.bodies) {
        if (body.name == name) body.position.setZero();
    }
    return to_yaml(write_fields(scene));
}

/// The characters of a text that are not part of a number.
std::string without_numbers(std::string text) {
    std::erase_if(text, [](char c) {
        return std::string_view("0123456789.-").find(c) != std::string_view::npos;
    });
    return text;
}

TEST(BodyText, EveryBodyOfEveryShippedSceneMovesAndNothingElseChanges) {
    int count = 0, added = 0;
    for (const auto& entry : std::filesystem::directory_iterator("scenes")) {
        if (entry.path().extension() != ".yaml") continue;
        const std::string text = read_text_file(entry.path().string());
        const Scene before = scene_of(text);
        for (const Body& body : before.bodies) {
            SCOPED_TRACE(entry.path().string() + ": " + body.name);
            const std::string after_text = moved(text, body.name, {12.3, -7, 40.1});
            const Scene after = scene_of(after_text);
            const Vec3& position =
                after.bodies[static_cast<size_t>(after.find(body.name))].position;
            const Vec3 wanted = body.position + Vec3(0.0123, -0.007, 0.0401);
            EXPECT_LT((position - wanted).cwiseAbs().maxCoeff(), 0.5e-4 + 1e-12);
            EXPECT_EQ(others(after, body.name), others(before, body.name));
            // moves the body back again; everything outside the body must then be as before, byte
            // for byte
            if (text.size() < after_text.size() + 60 &&
                without_numbers(text) == without_numbers(after_text)) {
                EXPECT_EQ(moved(after_text, body.name, {-12.3, 7, -40.1}), text);
            } else {
                ++added;  // the body had no position before
            }
            ++count;
        }
    }
    EXPECT_GT(count, 80);
    EXPECT_GT(added, 0);
    EXPECT_LT(added, count / 10);
}

TEST(BodyText, OnlyTheNumbersThatChangeAreWritten) {
    const std::string text =
        "title: \"ä, and 東\"   # ü\n"
        "bodies:\n"
        "  - name: a\n"
        "    position_mm: [ 1.55,2.0 , 3 ]   # [9, 9, 9]\n"
        "    mass_g: 5\n";
    const std::string expected =
        "title: \"ä, and 東\"   # ü\n"
        "bodies:\n"
        "  - name: a\n"
        "    position_mm: [ 1.55,4.5 , 3 ]   # [9, 9, 9]\n"
        "    mass_g: 5\n";
    EXPECT_EQ(moved(text, "a", {0, 2.46, 0}), expected);
    EXPECT_EQ(moved("\xEF\xBB\xBF" + text, "a", {0, 2.46, 0}), "\xEF\xBB\xBF" + expected);
    EXPECT_EQ(moved(text, "a", Vec3::Zero()), text);
}

TEST(BodyText, NumbersAreInTheFilesUnitAndRounded) {
    const auto with = [](const std::string& position) {
        return "bodies:\n- {name: a, " + position + ", mass_g: 1}\n";
    };
    EXPECT_EQ(moved(with("position_m: [0.1, 0, 1e-2]"), "a", {1.26, -0.04, 5}),
              with("position_m: [0.1013, 0, 0.015]"));
    EXPECT_EQ(moved(with("position_cm: [1, -1.5, +2]"), "a", {1.26, 15, 5}),
              with("position_cm: [1.13, 0, 2.5]"));
    EXPECT_EQ(moved(with("position_um: [1000, 0, 0]"), "a", {1.26, 0, 0}),
              with("position_um: [2300, 0, 0]"));
    EXPECT_EQ(moved(with("rotation_deg: [0, 0, 170], position_mm: [0, 0, 0]"), "a", Vec3::Zero(),
                    30.04 * kDegree),
              with("rotation_deg: [0, 0, -160], position_mm: [0, 0, 0]"));
    EXPECT_EQ(moved(with("rotation_rad: [0, 0, 1.5]"), "a", Vec3::Zero(), 30 * kDegree),
              with("rotation_rad: [0, 0, 2.023]"));
}

TEST(BodyText, ListsMayGoOverLinesAndHaveComments) {
    const std::string text =
        "bodies:\n"
        "- position_mm:   # of its middle\n"
        "    - 1   # x\n"
        "\n"
        "    - 2   # y\n"
        "    - 3   # z\n"
        "  name: 'a b'\n"
        "- { position_mm: [1,\n"
        "     2,  # y\n"
        "     3], \"name\": \"c\" }\n";
    const std::string first = moved(text, "a b", {9, 0, -4});
    EXPECT_EQ(first,
              "bodies:\n"
              "- position_mm:   # of its middle\n"
              "    - 10   # x\n"
              "\n"
              "    - 2   # y\n"
              "    - -1   # z\n"
              "  name: 'a b'\n"
              "- { position_mm: [1,\n"
              "     2,  # y\n"
              "     3], \"name\": \"c\" }\n");
    EXPECT_EQ(moved(first, "c", {9, 0, -4}),
              changed(first, {{first.rfind("[1,") + 1, 1, "10"}, {first.rfind("3]"), 1, "-1"}}));
}

TEST(BodyText, AddsAPositionInTheFilesUnitAndStyle) {
    const std::string block =
        "bodies:\n"
        "    -   name: a   # the first\n"
        "        mass_g: 5\n"
        "    -   name: \"b\"\n"
        "        position_cm: [1, 2, 3]\n";
    EXPECT_EQ(moved(block, "a", {12.34, 0, 50}),
              "bodies:\n"
              "    -   name: a   # the first\n"
              "        position_cm: [1.23, 0, 5]\n"
              "        mass_g: 5\n"
              "    -   name: \"b\"\n"
              "        position_cm: [1, 2, 3]\n");
    EXPECT_EQ(moved("bodies: [{name: a, mass_g: 5}, {name: \"b\"}]", "b", {1, 0, 0}),
              "bodies: [{name: a, mass_g: 5}, {name: \"b\", position_mm: [1, 0, 0]}]");
    EXPECT_EQ(moved("bodies:\r\n- name: a\r\n  mass_g: 5\r\n", "a", {1, 0, 0}),
              "bodies:\r\n- name: a\r\n  position_mm: [1, 0, 0]\r\n  mass_g: 5\r\n");
    EXPECT_EQ(moved("bodies:\n- mass_g: 5\n  name: a", "a", {1, 0, 0}, 90 * kDegree),
              "bodies:\n- mass_g: 5\n  name: a\n  position_mm: [1, 0, 0]\n"
              "  rotation_deg: [0, 0, 90]");
}

TEST(BodyText, ANumberThatIsNotMovedMayStandInAnyWay) {
    const std::string text =
        "a: &a [0, 0, 5]\nbodies:\n- name: a\n  rotation_deg: *a\n  position_mm: [1, 2, 3]\n";
    EXPECT_EQ(moved(text, "a", {1, 0, 0}), changed(text, {{text.find("[1") + 1, 1, "2"}}));
    EXPECT_THROW(moved(text, "a", {1, 0, 0}, 0.1), Error);
}

TEST(BodyText, SaysWhyItMovesNothing) {
    const auto with = [](const std::string& position) {
        return "at: &there [0, 0, 0]\nbodies:\n  - name: a\n    " + position + "\n";
    };
    EXPECT_NE(refusal(with("position_mm: *there"), "a").find("alias"), std::string::npos);
    EXPECT_THROW(moved(with("position_mm: *there"), "a", Vec3::Zero()), Error);
    EXPECT_EQ(moved("bodies:\n- name: a\n", "a", Vec3::Zero()), "bodies:\n- name: a\n");
    EXPECT_NE(refusal(with("position_mm: &mine [0, 0, 0]"), "a").find("anchor"), std::string::npos);
    for (const char* position : {"position_mm: [0, 0, '0']", "position_mm: [0, 0, &z 0]",
                                 "position_mm: [x, 0, 0]", "position_mm: [0, 0, !!float 0]"})
        EXPECT_NE(refusal(with(position), "a").find("plain numbers"), std::string::npos)
            << position;
    for (const char* position : {"position_mm: [0, 0]", "position_mm: 0", "position_mm:"})
        EXPECT_NE(refusal(with(position), "a").find("three numbers"), std::string::npos)
            << position;
    EXPECT_NE(refusal("bodies:\n- name: \"\\x61\"\n", "a").find("plain word"), std::string::npos);
    EXPECT_NE(refusal("bodies:\n- name: &n a\n", "a").find("plain word"), std::string::npos);
    EXPECT_NE(refusal("bodies:\n- ? name\n  : a\n", "a").find("unusual"), std::string::npos);
    EXPECT_NE(refusal("title: t\nlattices:\n- name: rod\nbodies: []\n", "rod_3")
                  .find("part of the lattice rod"),
              std::string::npos);
    EXPECT_NE(refusal("scene: ../scenes/a.yaml\n", "a").find("no bodies"), std::string::npos);
    EXPECT_NE(refusal("bodies: [a, b]\n", "a").find("does not contain it"), std::string::npos);
    EXPECT_NE(refusal("bodies: [\n", "a").find("not YAML"), std::string::npos);
    EXPECT_NE(refusal("", "a").find("no bodies"), std::string::npos);
}

TEST(BodyText, KnowsInWhoseLinesAPlaceIs) {
    const std::string text =
        "title: x\n"
        "bodies:\n"
        "  # the first\n"
        "  - name: a\n"
        "    mass_g: 1  # one\n"
        "\n"
        "  - {name: b, mass_g: 1}\n"
        "  -\n"
        "    mass_g: 2\n"
        "    name: c\n"
        "joints:\n"
        "  - name: hinge\n";
    const auto at = [&](const std::string& mark) { return body_at(text, text.find(mark)); };
    EXPECT_EQ(at("title"), "");
    EXPECT_EQ(at("bodies"), "");
    EXPECT_EQ(at("- name: a"), "a");
    EXPECT_EQ(at("# one"), "a");
    EXPECT_EQ(at("- {name: b"), "b");
    EXPECT_EQ(at("mass_g: 2"), "c");
    EXPECT_EQ(at("\njoints"), "c");
    EXPECT_EQ(at("joints"), "");
    EXPECT_EQ(at("hinge"), "");
    EXPECT_EQ(body_at("bodies: [{name: a}, {name: b}]", 10), "a");
    EXPECT_EQ(body_at("bodies: [{name: a}, {name: b}]", 25), "b");
    EXPECT_EQ(body_at("bodies: [\n", 9), "");
}

}  // namespace
}  // namespace dihaptic::scene::body_text_test
