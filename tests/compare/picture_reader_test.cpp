#include "domelight/compare/picture_reader.h"

#include "domelight/io/write_image.h"

#include "compare/picture_survey.h"
#include "test.h"

#include <cmath>
#include <limits>

using namespace domelight;
using namespace domelight::test;

namespace {

/// Four channels: the left half is covered, half of it with opacity 0.5; the rest shows `background`.
ImageF half_covered(int width, int height, float background) {
    ImageF image(width, height, 4);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float opacity = x >= width / 2 ? 0.0f : y < height / 2 ? 1.0f : 0.5f;
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = 0.5f * opacity + background * (1 - opacity);
            image.at(x, y)[3] = opacity;
        }
    return image;
}

/// A cross of cube faces whose unused cells are black, or a photograph of that shape.
ImageF four_by_three(int n, bool cross) {
    ImageF image(4 * n, 3 * n, 3);
    for (int y = 0; y < 3 * n; ++y)
        for (int x = 0; x < 4 * n; ++x)
            for (int c = 0; c < 3; ++c)
                if (!cross || x / n == 1 || y / n == 1)
                    image.at(x, y)[c] = 0.5f + 0.4f * std::sin(0.3f * (x + 2 * y + c));
    return image;
}

}  // namespace

TEST_CASE("read_picture: opacity cuts a picture out only where nothing shines behind it") {
    const TemporaryFolder folder;
    PictureOptions options;
    options.opacity = true;
    for (const float background : {0.0f, 0.3f}) {
        REQUIRE(write_exr(folder / "a.exr", half_covered(16, 8, background)));
        const auto picture = read_picture(folder / "a.exr", options);
        REQUIRE(picture);
        REQUIRE(picture->opacity.width() == 16);
        CHECK(*picture->opacity.at(3, 7) == 0.5f);
        CHECK(picture->cut_out() == (background == 0));
        const PictureSurvey survey = survey_picture(*picture);
        CHECK(survey.coverage == doctest::Approx(0.375));
        CHECK(survey.cut_out == (background == 0));
    }
    CHECK(read_picture(folder / "a.exr")->opacity.empty());
}

TEST_CASE("read_picture: a PNG's colours come multiplied with its opacity") {
    const TemporaryFolder folder;
    Image<std::uint8_t> pixels(4, 4, 4, 255);
    pixels.at(1, 0)[3] = 51;
    pixels.at(2, 0)[3] = 0;
    REQUIRE(write_png(folder / "a.png", pixels));
    PictureOptions options;
    options.opacity = true;
    const auto picture = read_picture(folder / "a.png", options);
    REQUIRE(picture);
    CHECK(picture->rgb.at(0, 0)[0] == 1);
    CHECK(picture->rgb.at(1, 0)[0] == doctest::Approx(0.2));
    CHECK(picture->rgb.at(2, 0)[0] == 0);
    CHECK(*picture->opacity.at(1, 0) == doctest::Approx(0.2));
    CHECK(picture->cut_out());
}

TEST_CASE("is_picture_of_its_own: by shape, by layers, and by what stands in the unused cells of a cross") {
    const TemporaryFolder folder;
    const auto written = [&](const ImageF& image) {
        REQUIRE(write_exr(folder / "a.exr", image.view()));
        return is_picture_of_its_own(folder / "a.exr");
    };
    CHECK(written(ImageF(16, 9, 3)));
    CHECK(!written(ImageF(16, 8, 3)));
    CHECK(!written(ImageF(6, 1, 3)));
    CHECK(!written(four_by_three(32, true)));
    CHECK(written(four_by_three(32, false)));
    const ImageF image(16, 8, 3);
    const ExrLayer layers[] = {{"", image}, {"albedo", image}};
    REQUIRE(write_exr_layers(folder / "layers.exr", layers));
    CHECK(is_picture_of_its_own(folder / "layers.exr"));
    const auto facts = read_picture_facts(folder / "layers.exr");
    REQUIRE(facts);
    CHECK(facts->layers == std::vector<std::string>{"", "albedo"});
    CHECK(!is_picture_of_its_own(folder / "missing.exr"));
}

TEST_CASE("survey_picture: bad pixels are counted, and left out of range and mean") {
    Picture picture;
    picture.rgb = ImageF(4, 1, 3, 1.0f);
    picture.rgb.at(0, 0)[0] = std::numeric_limits<float>::quiet_NaN();
    picture.rgb.at(1, 0)[1] = std::numeric_limits<float>::infinity();
    picture.rgb.at(2, 0)[2] = -3;
    const PictureSurvey survey = survey_picture(picture);
    CHECK(survey.not_a_number == 1);
    CHECK(survey.infinite == 1);
    CHECK(survey.negative == 1);
    CHECK(survey.least == -3);
    CHECK(survey.largest == 1);
    CHECK(survey.mean == Vec3d{1, 1, 0});
}
