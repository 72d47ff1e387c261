#include "image/font.h"

#include "base/utf8.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

namespace domelight {
namespace {

using namespace font_data;

constexpr std::uint32_t k_replacement = 0xfffd;

std::span<const Glyph> glyphs(FontSize size) {
    if (size == FontSize::small) return k_small;
    return k_large;
}

const FieldGlyph* field_glyph(char code) {
    const auto* found =
        std::find_if(std::begin(k_field), std::end(k_field), [&](const FieldGlyph& g) { return g.code == code; });
    return found == std::end(k_field) ? nullptr : found;
}

int hex(char c) {
    return c <= '9' ? c - '0' : c - 'a' + 10;
}

}  // namespace

const Glyph& font_glyph(FontSize size, std::uint32_t code) {
    const auto all = glyphs(size);
    const auto find = [&](std::uint32_t c) {
        return std::lower_bound(all.begin(), all.end(), c, [](const Glyph& g, std::uint32_t v) { return g.code < v; });
    };
    const auto found = find(code);
    return found != all.end() && found->code == code ? *found : *find('?');
}

int font_ascent(FontSize size) {
    return size == FontSize::small ? k_small_ascent : k_large_ascent;
}
int font_descent(FontSize size) {
    return size == FontSize::small ? k_small_descent : k_large_descent;
}

std::uint32_t next_code_point(std::string_view& text) {
    const Utf8Character character = first_utf8_character(text);
    text.remove_prefix(character.bytes);
    return character.valid ? character.code : k_replacement;
}

float font_field(char code, float x, float y) {
    const FieldGlyph* g = field_glyph(code);
    // Samples are at half-integers of the glyph's grid.
    const float outside = -k_field_range / k_field_size;
    if (!g) return outside;
    const float px = x * k_field_size - g->left - 0.5f, py = g->top - y * k_field_size - 0.5f;
    if (!(px >= 0 && py >= 0 && px < float(g->width - 1) && py < float(g->height - 1))) return outside;
    const int i = int(px), j = int(py);
    const float fx = px - float(i), fy = py - float(j);
    const auto at = [&](int cx, int cy) {
        const char* h = g->field + 2 * (cy * g->width + cx);
        return float(16 * hex(h[0]) + hex(h[1]));
    };
    const float v =
        (at(i, j) * (1 - fx) + at(i + 1, j) * fx) * (1 - fy) + (at(i, j + 1) * (1 - fx) + at(i + 1, j + 1) * fx) * fy;
    return (v / 127.5f - 1) * k_field_range / k_field_size;
}

float font_field_advance(char code) {
    const FieldGlyph* g = field_glyph(code);
    return g ? g->advance / k_field_size : 0;
}

}  // namespace domelight
