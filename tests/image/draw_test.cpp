#include "image/draw.h"

#include "test.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace domelight;

TEST_CASE("next_code_point: UTF-8, and a replacement for what is not") {
    std::string_view text = "a°α→";
    CHECK(next_code_point(text) == 'a');
    CHECK(next_code_point(text) == 0xb0);
    CHECK(next_code_point(text) == 0x3b1);
    CHECK(next_code_point(text) == 0x2192);
    CHECK(text.empty());
    for (std::string_view bad : {"\xff", "\xc3", "\xe2\x86", "\x80z", "\xc3z"}) {
        CHECK(next_code_point(bad) == 0xfffd);
        CHECK(bad.size() <= 1);
    }
}

TEST_CASE("draw_text: every broken byte draws one replacement, also where the bytes look like a character") {
    const auto drawn = [](std::string_view text, FontSize size) {
        Image<std::uint8_t> image(200, 40, 3);
        draw_text(image.view(), 4, 30, text, size, {255, 255, 255});
        return std::vector<std::uint8_t>(image.pixels().begin(), image.pixels().end());
    };
    for (const FontSize size : {FontSize::small, FontSize::large}) {
        CHECK(drawn("a\xef\xbf\xbdz", size) != drawn("a?z", size));
        CHECK(drawn("a\xffz", size) == drawn("a\ufffdz", size));
        // A slash in three bytes, half of a surrogate pair, and a code point beyond the last.
        CHECK(drawn("\xe0\x80\xaf", size) == drawn("\ufffd\ufffd\ufffd", size));
        CHECK(drawn("\xed\xa0\x80", size) == drawn("\ufffd\ufffd\ufffd", size));
        CHECK(drawn("\xf4\x90\x80\x80", size) == drawn("\ufffd\ufffd\ufffd\ufffd", size));
        CHECK(text_width("\xed\xa0\x80", size) == 3 * text_width("\ufffd", size));
        // A character that the fonts do not have.
        CHECK(drawn("\xe4\xb8\xad", size) == drawn("?", size));
    }
}

TEST_CASE("draw_text: letters between the lines, nothing outside the image") {
    Image<std::uint8_t> image(120, 40, 3);
    draw_text(image.view(), 10, 25, "Hg", FontSize::small, {255, 255, 255});
    int top = 40, bottom = -1;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 120; ++x)
            if (image.at(x, y)[0]) {
                top = std::min(top, y);
                bottom = std::max(bottom, y);
                CHECK(x >= 10);
                CHECK(x < 10 + text_width("Hg", FontSize::small));
            }
    CHECK(top >= 25 - font_ascent(FontSize::small));
    CHECK(top < 25 - 8);
    CHECK(bottom >= 25);
    CHECK(bottom < 25 + font_descent(FontSize::small));
    // Text that extends beyond every edge.
    for (int x : {-20, 110})
        for (int y : {-3, 2, 45}) draw_text(image.view(), x, y, "clipped", FontSize::large, {255, 0, 0}, Align::centre);
    CHECK(text_width("ab", FontSize::large) == text_width("a", FontSize::large) + text_width("b", FontSize::large));
}

TEST_CASE("fit_text: fits, keeps both ends") {
    const std::string name = "a_rather_long_environment_name_αβγ_16k.exr";
    for (int width : {400, 200, 90, 40}) {
        const std::string fitted = fit_text(name, FontSize::small, width);
        CHECK(text_width(fitted, FontSize::small) <= width);
        if (width >= 90 && width < 300) {
            CHECK(fitted.front() == 'a');
            CHECK(fitted.back() == 'r');
        }
    }
    CHECK(fit_text(name, FontSize::small, 1000) == name);
    CHECK(fit_text(name, FontSize::small, 0) == "");
}

TEST_CASE("font_field: positive on a stroke, negative off it, far off for other letters") {
    CHECK(font_field('+', font_field_advance('+') / 2, 0.31f) > 0);
    CHECK(font_field('-', font_field_advance('-') / 2, 0.31f) > 0);
    CHECK(font_field('-', font_field_advance('-') / 2, 0.5f) < 0);
    CHECK(font_field('Q', 0.3f, 0.3f) < 0);
    CHECK(font_field_advance('Q') == 0);
}
