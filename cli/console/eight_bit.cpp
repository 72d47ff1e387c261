#include "cli/console/eight_bit.h"

#include "domelight/io/write_image.h"

#include <algorithm>
#include <cmath>

namespace domelight::cli {

Result<void> write_8bit(const std::filesystem::path& file, RowSource& rows) {
    Image<std::uint8_t> pixels(rows.width(), rows.height(), 3);
    ImageF row(rows.width(), 1, 3);
    for (int y = 0; y < rows.height(); ++y) {
        if (auto ok = rows.read(row.view()); !ok) return ok;
        for (int i = 0; i < 3 * rows.width(); ++i) {
            const float c = std::clamp(row.row(0)[i], 0.0f, 1.0f);
            pixels.row(y)[i] =
                std::uint8_t(255 * (c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f) + 0.5f);
        }
    }
    return write_screen_picture(file, pixels.view());
}

}  // namespace domelight::cli
