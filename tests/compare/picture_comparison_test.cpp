#include "domelight/compare/picture_comparison.h"

#include "domelight/compare/difference_map.h"

#include "test.h"

#include <cmath>
#include <limits>

using namespace domelight;

namespace {

constexpr int k_size = 16;

Picture grey(float value) {
    Picture picture;
    picture.rgb = ImageF(k_size, k_size, 3, value);
    return picture;
}

/// The left half shows object 1, the right half no object.
ImageF left_half_is_an_object() {
    ImageF objects(k_size, k_size, 1, 0.0F);
    for (int y = 0; y < k_size; ++y) std::fill_n(objects.row(y), k_size / 2, 1.0F);
    return objects;
}

}  // namespace

TEST_SUITE("compare") {
    TEST_CASE("compare_pictures: equal pictures have no difference, and HDR-FLIP only where they hold radiance") {
        PicturePair pair{grey(0.5F), grey(0.5F), {}};
        const PictureComparison radiance = compare_pictures(pair);
        CHECK(radiance.errors.rmse == 0);
        CHECK(radiance.flip == 0.0);
        CHECK(radiance.hdr_flip == 0.0);
        CHECK_FALSE(radiance.noise);
        CHECK(radiance.objects.empty());
        // Middle grey, 0.18, of a picture of 0.5.
        CHECK(radiance.exposure_ev == doctest::Approx(std::log2(0.18 / 0.5)));
        pair.test.high_dynamic_range = pair.reference.high_dynamic_range = false;
        const PictureComparison screen = compare_pictures(pair);
        CHECK(screen.flip == 0.0);
        CHECK_FALSE(screen.hdr_flip);
        CHECK(screen.exposure_ev == 0);
    }

    TEST_CASE("without_bad_pixels: what is bad in one picture counts in neither") {
        PicturePair pair{grey(1), grey(1), {}};
        pair.test.rgb.at(3, 4)[1] = std::numeric_limits<float>::quiet_NaN();
        pair.reference.rgb.at(5, 6)[2] = std::numeric_limits<float>::infinity();
        pair.mask = ImageF(k_size, k_size, 1, 1.0F);
        *pair.mask.at(0, 0) = 0;
        pair.test.rgb.at(0, 0)[0] = std::numeric_limits<float>::infinity();
        const PicturePair clean = without_bad_pixels(std::move(pair));
        CHECK(clean.left_out == 2);  // the third was masked already
        const PictureComparison c = compare_pictures(clean, {.flip = false});
        CHECK(c.errors.pixels == k_size * k_size - 3);
        CHECK(c.errors.rmse == 0);
        CHECK(clean.test.rgb.at(0, 0)[0] == 0);
    }

    TEST_CASE("compare_pictures: objects are named, and their figures are those of their own pixels") {
        PicturePair pair{grey(0.5F), grey(0.5F), {}};
        pair.reference.objects = left_half_is_an_object();
        for (int y = 0; y < k_size; ++y)
            for (int x = 0; x < k_size / 2; ++x) pair.test.rgb.at(x, y)[0] = 2;
        const auto objects = compare_pictures(pair).objects;
        REQUIRE(objects.size() == 2);
        CHECK(objects[0].name == "background");
        CHECK(objects[0].errors.rmse == 0);
        CHECK(objects[1].name == "object 1");
        CHECK(objects[1].errors.pixels == k_size * k_size / 2);
        CHECK(objects[1].flip.value() > 2 * objects[0].flip.value());
        CHECK(objects[1].hdr_flip.value() > 0.1);
        pair.reference.object_names = {"ball"};
        CHECK(compare_pictures(pair, {.flip = false}).objects[1].name == "ball");
    }

    TEST_CASE("comparison_figure: every name has its figure where the pictures have a variance") {
        PicturePair pair{grey(1.1F), grey(1), {}};
        pair.test.variance = ImageF(k_size, k_size, 3, 0.01F);
        const PictureComparison c = compare_pictures(pair);
        for (const std::string& name : comparison_figures()) {
            CAPTURE(name);
            CHECK(comparison_figure(c, name).has_value());
        }
        CHECK(comparison_figure(c, "mean").value() == doctest::Approx(0.1));
        CHECK(comparison_figure(c, "chi2").value() == doctest::Approx(1).epsilon(1e-4));
        CHECK_FALSE(comparison_figure(c, "likeness"));
        CHECK_FALSE(comparison_figure(compare_pictures({grey(1), grey(1), {}}), "chi2"));
    }

    TEST_CASE("difference_map: every map has the pictures' size, and z is in standard errors") {
        PicturePair pair{grey(1.1F), grey(1), {}};
        pair.test.variance = ImageF(k_size, k_size, 3, 0.01F);
        const PictureComparison c = compare_pictures(pair);
        for (const std::string& name : difference_maps()) {
            CAPTURE(name);
            const auto map = difference_map(pair, c, name);
            REQUIRE(map);
            CHECK(map->values.width() == k_size);
            CHECK_FALSE(map->title.empty());
        }
        const auto z = difference_map(pair, c, "z");
        CHECK(*z->values.at(2, 2) == doctest::Approx(0.3 / std::sqrt(0.03)).epsilon(1e-4));
        CHECK(z->is_signed);
        CHECK_FALSE(difference_map(pair, compare_pictures(pair, {.flip = false}), "flip"));
        CHECK_FALSE(difference_map(pair, c, "heat"));
        const auto sheet = comparison_sheet(pair, c, "a.exr", "b.exr");
        CHECK(sheet.width() > 4 * k_size);
    }
}
