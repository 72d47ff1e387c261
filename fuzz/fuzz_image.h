#pragma once
// What the fuzz targets of the image readers share.

#include "image/repair.h"
#include "io/image_reader.h"
#include "io/hdr/radiance_reader.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace domelight::fuzz {

using OpenReader = Result<std::unique_ptr<ImageReader>> (*)(std::shared_ptr<const FileBytes>, const ReaderOptions&);

/// Opens the bytes and reads rows, as any program would; what comes out must be radiance, whatever went in.
inline int read_image(OpenReader open, const std::uint8_t* data, std::size_t size) {
    auto image = open(FileBytes::from_memory({data, data + size}), {.max_bytes = 32 << 20, .threads = 1});
    if (!image) return 0;
    const auto report = std::make_shared<RepairReport>();
    RadianceReader reader("fuzz", std::move(*image), RepairOptions{.threads = 1}, report);
    constexpr int rows_a_read = 16, most_rows = 256;  // enough to meet every kind of block
    ImageF rows(reader.width(), rows_a_read, 3);
    for (int y = 0; y < std::min(reader.height(), most_rows); y += rows_a_read) {
        const int count = std::min(rows_a_read, reader.height() - y);
        if (!reader.read(rows.view().rows(0, count))) return 0;
        for (std::size_t i = 0; i < std::size_t(count) * std::size_t(rows.width()) * 3; ++i)
            if (!(rows.pixels()[i] >= 0 && rows.pixels()[i] <= k_largest_radiance)) std::abort();
    }
    return 0;
}

}  // namespace domelight::fuzz
