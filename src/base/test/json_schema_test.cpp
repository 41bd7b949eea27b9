// Tests that schemas follow from visit(): types, units, bounds, defaults and kinds.
#include "base/json_schema.h"

#include <gtest/gtest.h>

#include "base/field_reader.h"

namespace dihaptic::json_schema_test {
namespace {

enum class Form { ball, brick, other };
constexpr auto enum_names(Form) {
    return std::array{"ball", "brick", ""};
}

struct Thing {
    Form form = Form::ball;
    std::string name;
    double radius = 0.006;
    Vec3 size = Vec3::Zero();
    Node options;

    template <class Visitor>
    void visit(Visitor& v) {
        std::string word(enum_name(form));
        v("form", word, Field::text().required().says("What it is."));
        v("name", name, says("Its name."));
        v("options", options);
        if (form == Form::ball)
            v("radius", radius, Field::length().within(1e-4, 0.1).says("Its radius."));
        if (form == Form::brick) v("size", size, Field::length().positive().required());
    }
};
Kinds<Thing> kinds_of(const Thing& value) {
    return each_kind<Form>("form", value, [](Thing& thing, Form form) { thing.form = form; });
}

struct Options {
    double bounce = 0.5;

    template <class Visitor>
    void visit(Visitor& v) {
        v("bounce", bounce);
    }
};

struct Shelf {
    std::vector<Thing> things;
    std::optional<Formula> height;
    bool open = true;
    int boards = 3;
    Texts owners;
    Node colours;

    template <class Visitor>
    void visit(Visitor& v) {
        v("things", things);
        v("height", height, Field::length());
        v("open", open);
        v("boards", boards, Field::number().within(1, 12));
        if (v.is_list("owners"))
            v("owners", owners);
        else
            v("owners", boards);
        v("colours", colours);
    }
};

Json schema() {
    JsonSchema made;
    made.part("colours", {{"type", "object"}});
    made.part_of_kind("options", "ball", "Options.ball", Options{});
    return made.of(Shelf{}, "Shelf");
}

TEST(JsonSchema, OfAMappingRefusesOtherKeys) {
    EXPECT_EQ(schema()["title"], "Shelf");
    EXPECT_EQ(schema()["additionalProperties"], false);
    EXPECT_FALSE(schema().contains("required"));
    EXPECT_EQ(schema()["properties"]["things"]["items"]["$ref"], "#/definitions/Shelf.things");
    EXPECT_EQ(schema()["properties"]["colours"]["type"], "object");
}

TEST(JsonSchema, HasAKeyForEachUnitWithItsBounds) {
    const Json kind = schema()["definitions"]["Shelf.things"]["allOf"][0]["then"];
    EXPECT_EQ(kind["properties"]["radius_m"]["maximum"], 0.1);
    EXPECT_EQ(kind["properties"]["radius_mm"]["maximum"], 100);
    EXPECT_EQ(kind["properties"]["radius_mm"]["minimum"], 0.1);
    EXPECT_FALSE(kind["properties"].contains("radius"));
}

TEST(JsonSchema, HasADefaultInOneUnitAndSaysItInAll) {
    const Json keys = schema()["definitions"]["Shelf.things"]["allOf"][0]["then"]["properties"];
    EXPECT_EQ(keys["radius_mm"]["default"], 6);
    EXPECT_FALSE(keys["radius_m"].contains("default"));
    EXPECT_EQ(keys["radius_m"]["description"], "Its radius. Default: 0.006.");
    EXPECT_EQ(schema()["properties"]["open"]["default"], "yes");
    EXPECT_EQ(schema()["properties"]["boards"]["default"], 3);
}

TEST(JsonSchema, HasTheKeysOfEachKind) {
    const Json thing = schema()["definitions"]["Shelf.things"];
    EXPECT_EQ(thing["required"], Json({"form"}));
    EXPECT_EQ(thing["properties"]["name"]["description"], "Its name.");
    EXPECT_EQ(thing["properties"]["form"]["examples"], Json({"ball", "brick"}));
    const Json brick = thing["allOf"][1];
    EXPECT_EQ(brick["if"]["properties"]["form"]["const"], "brick");
    EXPECT_EQ(brick["then"]["properties"]["name"], true);
    EXPECT_FALSE(brick["then"]["properties"].contains("radius_m"));
    EXPECT_EQ(brick["then"]["properties"]["size_m"]["items"]["exclusiveMinimum"], 0);
    EXPECT_EQ(brick["then"]["allOf"][0]["anyOf"].size(), units(Quantity::length).size());
    const Json other = thing["allOf"][2];
    EXPECT_EQ(other["if"]["properties"]["form"]["enum"], Json({"ball", "brick"}));
    EXPECT_EQ(other["else"]["properties"].size(), 3);
}

TEST(JsonSchema, HasTheOptionsOfTheKind) {
    const Json kinds = schema()["definitions"]["Shelf.things"]["allOf"];
    EXPECT_EQ(kinds[0]["then"]["properties"]["options"]["$ref"], "#/definitions/Options.ball");
    EXPECT_EQ(kinds[1]["then"]["properties"]["options"]["type"], Json({"object", "null"}));
    EXPECT_EQ(schema()["definitions"]["Options.ball"]["properties"]["bounce"]["default"], 0.5);
}

TEST(JsonSchema, LetsBothThroughWhatMayBeAListOrNot) {
    EXPECT_EQ(schema()["properties"]["owners"]["anyOf"].size(), 2);
}

}  // namespace
}  // namespace dihaptic::json_schema_test
