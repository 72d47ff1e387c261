#include "image/draw.h"

#include <algorithm>
#include <vector>

namespace domelight {

void fill(ImageView<std::uint8_t> image, Rect where, Colour8 colour) {
    const int x0 = std::max(where.x, 0), x1 = std::min(where.x + where.width, image.width);
    const int y0 = std::max(where.y, 0), y1 = std::min(where.y + where.height, image.height);
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            std::uint8_t* p = image.at(x, y);
            p[0] = colour.r;
            p[1] = colour.g;
            p[2] = colour.b;
        }
}

void frame(ImageView<std::uint8_t> image, Rect r, Colour8 colour) {
    fill(image, {r.x, r.y, r.width, 1}, colour);
    fill(image, {r.x, r.y + r.height - 1, r.width, 1}, colour);
    fill(image, {r.x, r.y, 1, r.height}, colour);
    fill(image, {r.x + r.width - 1, r.y, 1, r.height}, colour);
}

void blend(ImageView<std::uint8_t> image, int x, int y, Colour8 colour, float opacity) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
    std::uint8_t* p = image.at(x, y);
    const std::uint8_t to[3] = {colour.r, colour.g, colour.b};
    for (int c = 0; c < 3; ++c) p[c] = std::uint8_t(float(p[c]) + (float(to[c]) - float(p[c])) * opacity + 0.5f);
}

int text_width(std::string_view text, FontSize size) {
    int width = 0;
    while (!text.empty()) width += font_glyph(size, next_code_point(text)).advance;
    return width;
}

void draw_text(ImageView<std::uint8_t> image, int x, int baseline, std::string_view text, FontSize size, Colour8 colour,
               Align align) {
    if (align == Align::centre) x -= text_width(text, size) / 2;
    if (align == Align::right) x -= text_width(text, size);
    while (!text.empty()) {
        const font_data::Glyph& g = font_glyph(size, next_code_point(text));
        for (int j = 0; j < g.height; ++j)
            for (int i = 0; i < g.width; ++i) {
                const char digit = g.bits[j * g.width + i];
                const int level = digit <= '9' ? digit - '0' : digit - 'a' + 10;
                if (level) blend(image, x + g.left + i, baseline - g.top + j, colour, float(level) / 15);
            }
        x += g.advance;
    }
}

std::string fit_text(std::string_view text, FontSize size, int width) {
    if (text_width(text, size) <= width) return std::string(text);
    std::vector<std::string_view> characters;
    for (std::string_view rest = text; !rest.empty();) {
        const std::string_view before = rest;
        next_code_point(rest);
        characters.push_back(before.substr(0, before.size() - rest.size()));
    }
    // Keep more and more from both ends, because file names often differ at the end.
    const auto shortened = [&](std::size_t keep) {
        std::string out;
        for (std::size_t i = 0; i < (keep + 1) / 2; ++i) out += characters[i];
        out += "…";
        for (std::size_t i = characters.size() - keep / 2; i < characters.size(); ++i) out += characters[i];
        return out;
    };
    std::string best;
    for (std::size_t keep = 0; keep < characters.size(); ++keep) {
        std::string candidate = shortened(keep);
        if (text_width(candidate, size) > width) break;
        best = std::move(candidate);
    }
    return best;
}

}  // namespace domelight
