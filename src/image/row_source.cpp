#include "domelight/image/row_source.h"

#include "base/text.h"

#include <algorithm>
#include <cassert>

namespace domelight {

Result<void> ImageRowSource::read(ImageView<float> rows) {
    assert(rows.width == image_.width && rows.channels == 3 && image_.channels == 3);
    assert(next_row_ + rows.height <= image_.height);
    for (int y = 0; y < rows.height; ++y) {
        const float* from = image_.row(next_row_++);
        std::copy(from, from + std::size_t(rows.width) * 3, rows.row(y));
    }
    return {};
}

Result<ImageF> read_latlong(RowSource& source, std::int64_t max_bytes) {
    const std::int64_t bytes = std::int64_t(source.width()) * source.height() * 3 * std::int64_t(sizeof(float));
    if (bytes > max_bytes)
        return Error{text("the lat-long image has ", source.width(), " x ", source.height(), " texels and needs ",
                          bytes, " bytes of memory, more than the limit of ", max_bytes),
                     "", "Reduce its size first."};
    ImageF image(source.width(), source.height(), 3);
    constexpr int rows_a_read = 64;
    for (int y = 0; y < image.height(); y += rows_a_read) {
        const int count = std::min(rows_a_read, image.height() - y);
        if (const auto read = source.read(image.view().rows(y, count)); !read) return read.error();
    }
    return image;
}

}  // namespace domelight
