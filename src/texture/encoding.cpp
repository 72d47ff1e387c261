// Names, sizes and ranges of the encodings.
#include "domelight/texture/texture.h"

#include "texture/texel/half.h"
#include "texture/texel/r11g11b10f.h"
#include "texture/texel/rgb9e5.h"
#include "texture/texel/rgba8_ranges.h"
#include "texture/block/uastc_hdr.h"

#include <iterator>
#include <limits>

namespace domelight {

namespace {

struct EncodingFacts {
    const char* name;
    int block, bytes, channels;
    double max;
};

/// In the order of the enumeration.
constexpr EncodingFacts k_facts[] = {
    {"rgba16f", 1, 8, 3, k_half_max},
    {"rgba32f", 1, 16, 3, std::numeric_limits<float>::max()},
    {"rgb9e5", 1, 4, 3, k_rgb9e5_max},
    {"r11g11b10f", 1, 4, 3, k_float10_max},
    {"rg16f", 1, 4, 2, k_half_max},
    {"rg32f", 1, 8, 2, std::numeric_limits<float>::max()},
    {"r32f", 1, 4, 1, std::numeric_limits<float>::max()},
    {"bc6h", 4, 16, 3, k_half_max},
    {"rgbm", 1, 4, 3, k_rgbm_max},
    {"rgbd", 1, 4, 3, k_rgbd_max},
    {"rgbp", 1, 4, 3, k_rgbp_max},
    {"uastc-hdr", 4, 16, 3, k_uastc_hdr_max},
    {"astc4x4-hdr", 4, 16, 3, k_half_max},
    {"astc6x6-hdr", 6, 16, 3, k_half_max},
};

/// In the order of the enumeration.
constexpr const char* k_qualities[] = {"fast", "default", "high", "exhaustive"};

/// The number of `name` in a list of things with names.
template <typename List, typename NameOf>
Result<std::size_t> find_name(const std::string& name, const char* kind, const List& list, NameOf name_of) {
    std::string accepted;
    for (std::size_t i = 0; i < std::size(list); ++i) {
        if (name == name_of(list[i])) return i;
        accepted += (i ? ", " : "") + std::string(name_of(list[i]));
    }
    return Error{"\"" + name + "\" is not " + kind, "", "accepted: " + accepted};
}

const EncodingFacts& facts(Encoding encoding) {
    return k_facts[std::size_t(encoding)];
}

}  // namespace

std::string encoding_name(Encoding encoding) {
    return facts(encoding).name;
}

Result<Encoding> encoding_from_name(const std::string& name) {
    const auto found = find_name(name, "an encoding", k_facts, [](const EncodingFacts& f) { return f.name; });
    if (!found) return found.error();
    return Encoding(*found);
}

int encoding_block(Encoding encoding) {
    return facts(encoding).block;
}

int encoding_channels(Encoding encoding) {
    return facts(encoding).channels;
}

int encoding_bytes(Encoding encoding) {
    return facts(encoding).bytes;
}

double encoding_max(Encoding encoding) {
    return facts(encoding).max;
}

std::string encoding_quality_name(EncodingQuality quality) {
    return k_qualities[std::size_t(quality)];
}

Result<EncodingQuality> encoding_quality_from_name(const std::string& name) {
    const auto found = find_name(name, "a quality", k_qualities, [](const char* quality) { return quality; });
    if (!found) return found.error();
    return EncodingQuality(*found);
}

}  // namespace domelight
