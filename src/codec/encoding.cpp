// Names, sizes and ranges of the encodings.
#include "domelight/texture.h"

#include "codec/half.h"
#include "codec/r11g11b10f.h"
#include "codec/rgb9e5.h"

#include <array>
#include <limits>

namespace domelight {

namespace {

struct EncodingFacts {
    const char* name;
    int bytes;
    double max;
};

/// In the order of the enumeration.
constexpr std::array<EncodingFacts, 6> k_facts{{
    {"rgba16f", 8, k_half_max},
    {"rgba32f", 16, std::numeric_limits<float>::max()},
    {"rgb9e5", 4, k_rgb9e5_max},
    {"r11g11b10f", 4, k_float10_max},
    {"rg16f", 4, k_half_max},
    {"rg32f", 8, std::numeric_limits<float>::max()},
}};

const EncodingFacts& facts(Encoding encoding) {
    return k_facts[std::size_t(encoding)];
}

}  // namespace

std::string encoding_name(Encoding encoding) {
    return facts(encoding).name;
}

Result<Encoding> encoding_from_name(const std::string& name) {
    std::string accepted;
    for (std::size_t i = 0; i < k_facts.size(); ++i) {
        if (name == k_facts[i].name) return Encoding(i);
        accepted += (i ? ", " : "") + std::string(k_facts[i].name);
    }
    return Error{"\"" + name + "\" is not an encoding", "", "accepted: " + accepted};
}

int encoding_bytes(Encoding encoding) {
    return facts(encoding).bytes;
}

double encoding_max(Encoding encoding) {
    return facts(encoding).max;
}

}  // namespace domelight
