// Tests textures: mistakes in files, and pictures as reliefs.
#include "scene/texture.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/image.h"
#include "scene/relief_picture.h"
#include "scene/test/read_text.h"

namespace dihaptic::scene::texture_test {
namespace {

/// A black picture of 8 x 6 pixels with a single white pixel, in the second row from the top and
/// the seventh column.
ReliefPicture one_bump() {
    std::vector<float> grey(48, 0.f);
    grey[1 * 8 + 6] = 1;
    return {8, 6, grey};
}

TEST(Texture, IsScaledWithinItsLimits) {
    Texture given;
    given.wavelength = 2e-3;
    given.height = 1e-4;
    given.friction = 0.4;
    Texture scaled = given;
    scaled.scale(given, 1.5, 2, 0.5);
    EXPECT_DOUBLE_EQ(scaled.wavelength, 3e-3);
    EXPECT_DOUBLE_EQ(scaled.height, 2e-4);
    EXPECT_DOUBLE_EQ(scaled.friction, 0.2);
    scaled.scale(given, 1, 10, 10);
    EXPECT_DOUBLE_EQ(scaled.height, Texture::kHighest);
    EXPECT_DOUBLE_EQ(scaled.friction, 1);
    scaled.scale(given, 0.1, 1, 1);  // the distance between ridges is now 0.2 mm
    EXPECT_DOUBLE_EQ(scaled.steepest(), Texture::kSteepest);
    scaled.scale(given, 1, 1, 1);
    EXPECT_EQ(scaled, given);
}

TEST(ReliefPicture, HasItsBumpWhereItsPixelIs) {
    const ReliefPicture picture = one_bump();
    // the centre of the pixel is 2.5 pixels to the right of the centre of the picture, and 1.5
    // pixels above it
    EXPECT_NEAR(picture.at(2.5, 1.5).height, 4. / 9, 1e-12);
    EXPECT_NEAR(picture.at(2.5, 1.5).rise_x, 0, 1e-12);
    EXPECT_GT(picture.at(2, 1.5).rise_x, 0.1);
    EXPECT_GT(picture.at(2.5, 1).rise_y, 0.1);
    EXPECT_NEAR(picture.at(0, -2).height, 0, 1e-12);
    EXPECT_NEAR(picture.at(2.5 - 80, 1.5 + 60).height, 4. / 9, 1e-12);
}

TEST(ReliefPicture, RisesAsItSaysAlsoOverItsEdges) {
    const ReliefPicture picture = one_bump();
    constexpr double kStep = 1e-6;
    for (double x = -5; x < 5; x += 0.37) {
        for (double y = -4; y < 4; y += 0.41) {
            const ReliefPicture::Value v = picture.at(x, y);
            const double dx = picture.at(x + kStep, y).height - picture.at(x - kStep, y).height;
            const double dy = picture.at(x, y + kStep).height - picture.at(x, y - kStep).height;
            EXPECT_NEAR(v.rise_x, dx / (2 * kStep), 1e-8) << x << " " << y;
            EXPECT_NEAR(v.rise_y, dy / (2 * kStep), 1e-8) << x << " " << y;
            EXPECT_LE(std::hypot(v.rise_x, v.rise_y), 1.03 * picture.steepest());
            EXPECT_GE(v.height, 0);
            EXPECT_LE(v.height, 1);
        }
    }
}

TEST(ReliefPicture, IsAsHighAsItsGreyWhereThatIsEven) {
    const ReliefPicture picture(5, 7, std::vector<float>(35, 0.25f));
    EXPECT_NEAR(picture.at(1.3, -2.2).height, 0.25, 1e-12);
    EXPECT_NEAR(picture.steepest(), 0, 1e-12);
}

/// Writes a picture of width x height pixels that is black except for its last column.
std::string write(const std::string& name, int width, int height) {
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            image.rgb.insert(image.rgb.end(), 3, x + 1 == width ? 255 : 0);
    }
    std::string file = ::testing::TempDir() + name;
    write_png(image, file);
    return file;
}

TEST(Texture, OfAPictureLiesOnEachFaceAsItSays) {
    const std::string file = write("last-column.png", 10, 10);
    Texture texture;
    texture.kind = TextureKind::picture;
    texture.wavelength = 0.02;
    texture.height = 1e-4;
    texture.friction = 0.5;
    texture.picture = std::make_shared<const ReliefPicture>(read_relief(file, {}));
    // the centre of the last column is 4.5 of the ten pixels to the right of the centre of the
    // picture
    const double right = 0.009;
    const double high = 1e-4 * 2 / 3;
    EXPECT_NEAR(texture.at({right, 0.3, 0}, Vec3::UnitZ()).height, high, 1e-12);
    EXPECT_NEAR(texture.at({right, 0.3, 0}, Vec3::UnitZ()).friction, 0.5 + 2. / 3, 1e-7);
    EXPECT_NEAR(texture.at({right, 0, 0.3}, -Vec3::UnitY()).height, high, 1e-12);
    EXPECT_NEAR(texture.at({-0.005, 0, 0.3}, -Vec3::UnitY()).height, 0, 1e-12);
    texture.along = {0, -2, 0};
    EXPECT_NEAR(texture.at({0.3, -right, 0}, Vec3::UnitZ()).height, high, 1e-12);
    EXPECT_NEAR(texture.at({0, 0.3, 0}, Vec3::UnitY()).slope.y(), 0, 1e-15);
}

std::string first_problem(const std::string& texture) {
    Diagnostics diagnostics;
    read_text(
        "bodies:\n  - name: b\n    shape: sphere\n    radius_mm: 4\n    mass_g: 1\n    "
        "surface: { texture: {" +
            texture + "} }\n",
        diagnostics);
    return diagnostics.problems().empty() ? "" : diagnostics.problems()[0].text();
}

TEST(Texture, OfAFileIsOneThatCanBeFelt) {
    const std::string good = write("good.png", 8, 8);
    const std::string thin = write("thin.png", 8, 2);
    EXPECT_EQ(first_problem("wavelength_mm: 4, friction: 0.5"), "");
    EXPECT_EQ(first_problem("kind: picture, file: " + good + ", wavelength_mm: 40, height_mm: 0.1"),
              "");
    for (const auto& [texture, said] : {
             std::pair<std::string, std::string>{"wavelength_mm: 4",
                                                 "is missing, and so is height"},
             {"wavelength_mm: 1, height_mm: 0.5", "height"},
             {"wavelength_mm: 0.5, height_mm: 0.3", "gives slopes of 62"},
             {"wavelength_mm: 4, friction: 0.5, along: [0, 0, 0]", "has no direction"},
             {"wavelength_mm: 4, friction: 0.5, file: " + good, "applies only to pictures"},
             {"kind: picture, wavelength_mm: 4, friction: 0.5", "file: is missing"},
             {"kind: picture, wavelength_mm: 4, friction: 0.5, file: nowhere.png",
              "the picture nowhere.png"},
             {"kind: picture, wavelength_mm: 4, friction: 0.5, file: README.md", "PNG"},
             {"kind: picture, wavelength_mm: 4, friction: 0.5, file: " + thin, "has 8 x 2 pixels"},
             {"kind: picture, wavelength_mm: 1, height_mm: 0.3, file: " + good, "gives slopes of"},
         }) {
        EXPECT_NE(first_problem(texture).find(said), std::string::npos)
            << texture << ": " << first_problem(texture);
    }
}

}  // namespace
}  // namespace dihaptic::scene::texture_test
