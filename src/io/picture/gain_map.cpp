#include "io/picture/gain_map.h"

#include "base/read_number.h"
#include "io/picture/exif.h"
#include "io/picture/texture_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace domelight {

namespace {

using namespace std::string_view_literals;

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint8_t k_app1 = 0xe1, k_app2 = 0xe2;

// --- ISO 21496-1, annex C, as libultrahdr writes it ---

/// Big-endian numbers one after the other.
class Numbers {
  public:
    explicit Numbers(Bytes bytes) : bytes_(bytes) {}
    std::uint32_t next(std::size_t count) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < count; ++i) value = value << 8 | (at_ < bytes_.size() ? bytes_[at_] : 0), ++at_;
        return value;
    }
    double unsigned_number() { return next(4); }
    double signed_number() { return std::int32_t(next(4)); }
    bool complete() const { return at_ <= bytes_.size(); }

  private:
    Bytes bytes_;
    std::size_t at_ = 0;
};

std::optional<GainMapFormula> iso_formula(Bytes bytes) {
    Numbers numbers(bytes);
    if (bytes.size() < 6 || numbers.next(2) != 0) return std::nullopt;  // the version that a reader must know
    numbers.next(2);
    const std::uint32_t flags = numbers.next(1);
    const bool three = flags & 0x80, one_denominator = flags & 0x08;
    const double denominator = one_denominator ? numbers.unsigned_number() : 0;
    const auto fraction = [&](bool is_signed) {
        const double n = is_signed ? numbers.signed_number() : numbers.unsigned_number();
        return n / (one_denominator ? denominator : numbers.unsigned_number());
    };
    GainMapFormula formula;
    formula.kind = "ISO 21496-1";
    formula.in_other_colours = !(flags & 0x40);
    const double base_headroom = fraction(false), other_headroom = fraction(false);
    formula.base_is_hdr = base_headroom > other_headroom;
    for (std::size_t c = 0; c < 3; ++c) {
        if (c > 0 && !three) {
            for (auto* member :
                 {&formula.least, &formula.most, &formula.gamma, &formula.offset_base, &formula.offset_hdr})
                (*member)[c] = (*member)[0];
            continue;
        }
        formula.least[c] = fraction(true);
        formula.most[c] = fraction(true);
        formula.gamma[c] = fraction(false);
        formula.offset_base[c] = fraction(true);
        formula.offset_hdr[c] = fraction(true);
    }
    if (!numbers.complete()) return std::nullopt;
    return formula;
}

// --- XMP ---

std::string_view text_of(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The numbers of a property: "name=\"1\"", "<name>1</name>", or the items of a list in it.
std::vector<double> xmp_numbers(std::string_view xmp, std::string_view name) {
    std::vector<double> numbers;
    std::size_t at = xmp.find(name);
    while (at != xmp.npos && at + name.size() < xmp.size() && xmp[at + name.size()] != '=' &&
           xmp[at + name.size()] != '>')
        at = xmp.find(name, at + 1);
    if (at == xmp.npos || at + name.size() >= xmp.size()) return numbers;
    const bool attribute = xmp[at + name.size()] == '=';
    const std::string closing = "</" + std::string(name);
    std::string_view value = xmp.substr(at + name.size() + 1);
    if (attribute) value.remove_prefix(std::min<std::size_t>(1, value.size()));
    value = value.substr(0, attribute ? value.find_first_of("\"'") : value.find(closing));
    bool in_tag = false;
    for (const char *p = value.data(), *end = p + value.size(); p < end;) {
        if (*p == '<' || *p == '>') in_tag = *p == '<';
        double number = 0;
        const char* stopped = read_number(*p == '+' ? p + 1 : p, end, number);
        if (in_tag || !stopped) {
            ++p;
        } else {
            numbers.push_back(number);
            p = stopped;
        }
    }
    return numbers;
}

bool xmp_says(std::string_view xmp, std::string_view name, std::string_view value) {
    for (const std::string_view before : {"=\""sv, ">"sv, "='"sv})
        if (xmp.find(std::string(name) + std::string(before) + std::string(value)) != xmp.npos) return true;
    return false;
}

/// "Gain map metadata" of Adobe's Gain Map Specification 1.0, which Google's Ultra HDR shares.
std::optional<GainMapFormula> adobe_formula(std::string_view xmp) {
    if (xmp.find("http://ns.adobe.com/hdr-gain-map/1.0/") == xmp.npos) return std::nullopt;
    GainMapFormula formula;
    formula.kind = "Ultra HDR";
    const auto read = [&](std::string_view name, std::array<double, 3>& values, double otherwise) {
        const std::vector<double> numbers = xmp_numbers(xmp, name);
        for (std::size_t c = 0; c < 3; ++c)
            values[c] = numbers.empty() ? otherwise : numbers[numbers.size() == 3 ? c : 0];
        return !numbers.empty();
    };
    if (!read("hdrgm:GainMapMax", formula.most, 1)) return std::nullopt;
    read("hdrgm:GainMapMin", formula.least, 0);
    read("hdrgm:Gamma", formula.gamma, 1);
    read("hdrgm:OffsetSDR", formula.offset_base, 1 / 64.0);
    read("hdrgm:OffsetHDR", formula.offset_hdr, 1 / 64.0);
    formula.base_is_hdr = xmp_says(xmp, "hdrgm:BaseRenditionIsHDR", "True");
    return formula;
}

/// "Applying Apple HDR effect to your photos" (Apple's developer documentation). Newer files state the headroom, older
/// ones have it in the picture's maker note.
std::optional<GainMapFormula> apple_formula(std::string_view xmp, const std::vector<JpegSegment>& picture) {
    if (xmp.find("urn:com:apple:photo:2020:aux:hdrgainmap") == xmp.npos) return std::nullopt;
    GainMapFormula formula;
    formula.kind = "Apple";
    formula.apple = true;
    std::optional<double> headroom;
    if (const auto stated = xmp_numbers(xmp, "HDRGainMap:HDRGainMapHeadroom"); !stated.empty()) headroom = stated[0];
    for (const JpegSegment& segment : picture)
        if (const auto exif = contents_after(segment, k_app1, "Exif\0\0"sv); !exif.empty() && !headroom)
            headroom = apple_headroom(exif);
    if (!headroom) return std::nullopt;
    formula.headroom = *headroom;
    return formula;
}

bool is_usable(const GainMapFormula& f) {
    const auto within = [](double v, double low, double high) { return v >= low && v <= high; };
    bool usable = within(f.headroom, 1, 1e6);
    for (std::size_t c = 0; c < 3; ++c)
        usable = usable && within(f.least[c], -40, 40) && within(f.most[c], -40, 40) && within(f.gamma[c], 0.01, 100) &&
                 within(f.offset_base[c], -1, 1) && within(f.offset_hdr[c], -1, 1);
    return usable;
}

// --- where the gain map is ---

/// Offsets of the other pictures in the file by its Multi-Picture index (CIPA DC-007, section 5.2).
std::vector<std::size_t> pictures_of_index(Bytes file, const std::vector<JpegSegment>& segments) {
    std::vector<std::size_t> offsets;
    for (const JpegSegment& segment : segments) {
        const Bytes index = contents_after(segment, k_app2, "MPF\0"sv);
        if (index.size() < 8) continue;
        for (const std::size_t picture : multi_picture_offsets(index))
            if (picture > 0) offsets.push_back(std::size_t(index.data() - file.data()) + picture);
    }
    return offsets;
}

/// Where a JPEG may start behind the first one's header.
std::vector<std::size_t> pictures_behind(Bytes file, const std::vector<JpegSegment>& segments) {
    constexpr std::string_view start = "\xff\xd8\xff"sv;
    constexpr std::size_t k_most = 16;
    std::vector<std::size_t> offsets;
    if (segments.empty()) return offsets;
    const Bytes last = segments.back().contents;
    auto from = file.begin() + (last.data() + last.size() - file.data());
    while (offsets.size() < k_most) {
        from = std::search(from, file.end(), start.begin(), start.end(),
                           [](std::uint8_t a, char b) { return a == std::uint8_t(b); });
        if (from == file.end()) break;
        offsets.push_back(std::size_t(from - file.begin()));
        ++from;
    }
    return offsets;
}

}  // namespace

std::optional<GainMapFormula> gain_map_formula(const std::vector<JpegSegment>& map,
                                               const std::vector<JpegSegment>& picture) {
    for (const JpegSegment& segment : map)
        if (const Bytes iso = contents_after(segment, k_app2, "urn:iso:std:iso:ts:21496:-1\0"sv); !iso.empty())
            if (auto formula = iso_formula(iso); formula && is_usable(*formula)) return formula;
    for (const JpegSegment& segment : map) {
        const std::string_view xmp = text_of(contents_after(segment, k_app1, "http://ns.adobe.com/xap/1.0/\0"sv));
        for (const auto& formula : {adobe_formula(xmp), apple_formula(xmp, picture)})
            if (formula && is_usable(*formula)) return formula;
    }
    return std::nullopt;
}

std::optional<GainMap> find_gain_map(Bytes file, const std::vector<JpegSegment>& segments, std::string& note) {
    std::vector<std::size_t> offsets = pictures_of_index(file, segments);
    const std::vector<std::size_t> behind = pictures_behind(file, segments);
    offsets.insert(offsets.end(), behind.begin(), behind.end());
    for (const std::size_t offset : offsets) {
        if (offset >= file.size()) continue;
        const Bytes map = file.subspan(offset);
        const auto formula = gain_map_formula(jpeg_segments(map), segments);
        if (!formula) continue;
        if (formula->base_is_hdr) return std::nullopt;
        auto codes = decode_jpeg_texture(map);
        if (codes) return GainMap(*formula, *std::move(codes));
        note =
            "the gain map (" + formula->kind + ") cannot be read, only the picture for a screen: " + codes.error().what;
        return std::nullopt;
    }
    for (const JpegSegment& segment : segments)
        if (text_of(segment.contents).find("http://ns.adobe.com/hdr-gain-map/") != std::string_view::npos)
            note =
                "there is no gain map (Ultra HDR) where the file says that there is one: the picture for a screen is "
                "read";
    return std::nullopt;
}

GainMap::GainMap(GainMapFormula formula, Rgba8Image codes) : formula_(std::move(formula)), codes_(std::move(codes)) {}

double GainMap::applied(double light, int c, double code) const {
    const auto i = std::size_t(c);
    if (formula_.apple) {
        // The map has the transfer function of ITU-R BT.709.
        const double gain = code < 0.081 ? code / 4.5 : std::pow((code + 0.099) / 1.099, 1 / 0.45);
        return light * (1 + (formula_.headroom - 1) * gain);
    }
    const double map = formula_.gamma[i] == 1 ? code : std::pow(code, 1 / formula_.gamma[i]);
    const double gain = std::exp2(formula_.least[i] + (formula_.most[i] - formula_.least[i]) * map);
    return (light + formula_.offset_base[i]) * gain - formula_.offset_hdr[i];
}

double GainMap::largest() const {
    double largest = 0;
    for (int c = 0; c < 3; ++c) largest = std::max({largest, applied(1, c, 0), applied(1, c, 1)});
    return largest;
}

void GainMap::apply(float* rgb, int width, int y, int height) const {
    const auto clamped = [](double at, int size) { return std::clamp(at, 0.0, double(size - 1)); };
    const double v = clamped((y + 0.5) * codes_.height / height - 0.5, codes_.height);
    const int top = int(v), bottom = std::min(top + 1, codes_.height - 1);
    const auto code = [&](int column, int row, int c) {
        return codes_.rgba[4 * (std::size_t(row) * std::size_t(codes_.width) + std::size_t(column)) + std::size_t(c)];
    };
    for (int x = 0; x < width; ++x) {
        const double u = clamped((x + 0.5) * codes_.width / width - 0.5, codes_.width);
        const int left = int(u), right = std::min(left + 1, codes_.width - 1);
        const double s = u - left, t = v - top;
        for (int c = 0; c < 3; ++c) {
            const double above = code(left, top, c) * (1 - s) + code(right, top, c) * s;
            const double below = code(left, bottom, c) * (1 - s) + code(right, bottom, c) * s;
            float& light = rgb[3 * x + c];
            light = float(std::max(applied(light, c, (above * (1 - t) + below * t) / 255), 0.0));
        }
    }
}

}  // namespace domelight
