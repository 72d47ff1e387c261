#include "io/picture/exif_orientation.h"

#include <cstddef>

namespace domelight {

namespace {

/// Numbers of a TIFF file, in the order of bytes that its header says; 0 beyond the end.
class Tiff {
  public:
    explicit Tiff(std::span<const std::uint8_t> bytes) : bytes_(bytes), little_(bytes.size() > 1 && bytes[0] == 'I') {}
    std::size_t number(std::size_t at, std::size_t count) const {
        if (at > bytes_.size() || count > bytes_.size() - at) return 0;
        std::size_t value = 0;
        for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes_[at + (little_ ? count - 1 - i : i)];
        return value;
    }

  private:
    std::span<const std::uint8_t> bytes_;
    bool little_;
};

}  // namespace

int exif_orientation(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t k_orientation = 0x112, k_short = 3, k_entry = 12;
    const Tiff tiff(bytes);
    if (tiff.number(2, 2) != 42) return 1;
    const std::size_t directory = tiff.number(4, 4), entries = tiff.number(directory, 2);
    for (std::size_t i = 0; i < entries; ++i) {
        const std::size_t entry = directory + 2 + k_entry * i;
        if (tiff.number(entry, 2) != k_orientation || tiff.number(entry + 2, 2) != k_short) continue;
        const std::size_t value = tiff.number(entry + 8, 2);
        return value >= 1 && value <= 8 ? int(value) : 1;
    }
    return 1;
}

}  // namespace domelight
