#include "io/picture/exif.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace domelight {

namespace {

constexpr std::size_t k_short = 3, k_long = 4, k_undefined = 7, k_signed_rational = 10;

/// Numbers and directories of a TIFF file, in its order of bytes; 0 beyond the end.
class Tiff {
  public:
    Tiff(std::span<const std::uint8_t> bytes, bool little) : bytes_(bytes), little_(little) {}
    explicit Tiff(std::span<const std::uint8_t> bytes) : Tiff(bytes, !bytes.empty() && bytes[0] == 'I') {}
    std::span<const std::uint8_t> bytes() const { return bytes_; }
    std::size_t number(std::size_t at, std::size_t count) const {
        if (at > bytes_.size() || count > bytes_.size() - at) return 0;
        std::size_t value = 0;
        for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes_[at + (little_ ? count - 1 - i : i)];
        return value;
    }
    /// Where the entry of that tag and type lies in the directory at `directory`.
    std::optional<std::size_t> entry(std::size_t directory, std::size_t tag, std::size_t type) const {
        const std::size_t entries = number(directory, 2);
        for (std::size_t i = 0; i < entries; ++i) {
            const std::size_t at = directory + 2 + 12 * i;
            if (number(at, 2) == tag && number(at + 2, 2) == type) return at;
        }
        return std::nullopt;
    }
    /// The directory at the start of a whole file; 0 if it is none.
    std::size_t first_directory() const { return number(2, 2) == 42 ? number(4, 4) : 0; }

  private:
    std::span<const std::uint8_t> bytes_;
    bool little_;
};

/// A value of two 32-bit numbers in a directory.
std::optional<double> signed_rational(const Tiff& tiff, std::size_t directory, std::size_t tag) {
    const auto entry = tiff.entry(directory, tag, k_signed_rational);
    if (!entry) return std::nullopt;
    const std::size_t at = tiff.number(*entry + 8, 4);
    const auto part = [&](std::size_t offset) { return double(std::int32_t(tiff.number(at + offset, 4))); };
    if (part(4) == 0) return std::nullopt;
    return part(0) / part(4);
}

/// Apple's maker note: twelve bytes of a mark and a version, then a directory whose offsets count from the mark.
std::optional<Tiff> apple_note(const Tiff& exif) {
    using namespace std::string_view_literals;
    constexpr std::string_view mark = "Apple iOS\0"sv;
    const auto pointer = exif.entry(exif.first_directory(), 0x8769, k_long);
    if (!pointer) return std::nullopt;
    const auto note = exif.entry(exif.number(*pointer + 8, 4), 0x927c, k_undefined);
    if (!note) return std::nullopt;
    const std::size_t at = exif.number(*note + 8, 4), length = exif.number(*note + 4, 4);
    if (at > exif.bytes().size() || length > exif.bytes().size() - at || length < mark.size()) return std::nullopt;
    const auto bytes = exif.bytes().subspan(at, length);
    if (!std::equal(mark.begin(), mark.end(), bytes.begin())) return std::nullopt;
    return Tiff(bytes, false);
}

}  // namespace

int exif_orientation(std::span<const std::uint8_t> bytes) {
    const Tiff tiff(bytes);
    const auto entry = tiff.entry(tiff.first_directory(), 0x112, k_short);
    const std::size_t value = entry ? tiff.number(*entry + 8, 2) : 1;
    return value >= 1 && value <= 8 ? int(value) : 1;
}

std::vector<std::size_t> multi_picture_offsets(std::span<const std::uint8_t> index) {
    constexpr std::size_t k_entry = 16, k_most = 64;
    const Tiff tiff(index);
    std::vector<std::size_t> offsets;
    const auto entries = tiff.entry(tiff.first_directory(), 0xb002, k_undefined);
    if (!entries) return offsets;
    const std::size_t count = tiff.number(*entries + 4, 4) / k_entry, at = tiff.number(*entries + 8, 4);
    for (std::size_t i = 0; i < std::min(count, k_most); ++i) offsets.push_back(tiff.number(at + k_entry * i + 8, 4));
    return offsets;
}

std::optional<double> apple_headroom(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t k_directory = 14;
    const auto note = apple_note(Tiff(bytes));
    if (!note) return std::nullopt;
    const auto kind = signed_rational(*note, k_directory, 33), gain = signed_rational(*note, k_directory, 48);
    if (!kind || !gain) return std::nullopt;
    const double stops = *kind < 1 ? (*gain <= 0.01 ? -20 * *gain + 1.8 : -0.101 * *gain + 1.601)
                                   : (*gain <= 0.01 ? -70 * *gain + 3 : -0.303 * *gain + 2.303);
    return std::exp2(std::max(stops, 0.0));
}

}  // namespace domelight
