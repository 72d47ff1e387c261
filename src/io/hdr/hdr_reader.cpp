#include "io/hdr/hdr_reader.h"

#include "domelight/base/parallel.h"

#include "image/repair.h"
#include "io/hdr/hdr_scanline_reader.h"
#include "texture/texel/rgbe_decode.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace domelight {

namespace {

/// The number of rows that a task decodes: enough to be worth a task, and few enough that its planes stay in the cache.
constexpr int k_rows_a_task = 8;

/// Reverses the order of a row's texels.
void mirror_row(float* rgb, int width) {
    for (int a = 0, b = width - 1; a < b; ++a, --b)
        for (int c = 0; c < 3; ++c) std::swap(rgb[3 * a + c], rgb[3 * b + c]);
}

}  // namespace

Result<std::unique_ptr<ImageReader>> open_hdr_reader(std::shared_ptr<const FileBytes> bytes,
                                                     const ReaderOptions& options) {
    return HdrReader::open(std::move(bytes), options);
}

Result<std::unique_ptr<ImageReader>> HdrReader::open(std::shared_ptr<const FileBytes> bytes,
                                                     const ReaderOptions& options) {
    Result<HdrHeader> header = read_hdr_header(bytes->bytes());
    if (!header) return header.error();
    std::unique_ptr<HdrReader> reader(new HdrReader);
    reader->bytes_ = std::move(bytes);
    reader->header_ = *header;
    reader->threads_ = options.threads;

    const std::size_t left = reader->bytes_->bytes().size() - header->data_offset;
    const int scanlines = header->columns ? header->width : header->height;
    if (left < std::size_t(scanlines) * least_hdr_scanline_bytes(header->columns ? header->height : header->width))
        return Error{fmt::format("file ends too early: {} bytes cannot hold {} x {} texels", left, header->width,
                                 header->height),
                     "", "The file is truncated, or its header is wrong."};
    const std::int64_t held = header->columns ? std::int64_t(4) * header->width * header->height : 0;
    if (held > options.max_bytes)
        return Error{fmt::format("decoding {} x {} texels stored by columns needs {} bytes, more than the limit of {}",
                                 header->width, header->height, held, options.max_bytes),
                     "", ""};

    ImageFacts& facts = reader->facts_;
    facts.format = "Radiance HDR";
    facts.width = header->width;
    facts.height = header->height;
    facts.largest = k_largest_radiance;
    facts.warnings = header->warnings;
    double largest_scale = 1;
    for (int c = 0; c < 3; ++c) {
        reader->scale_[c] = float(1 / header->applied[c]);
        largest_scale = std::max(largest_scale, 1 / header->applied[c]);
    }
    // 255 * 2^(e - 136) * scale < 2^100
    reader->brightest_exponent_ = std::max(0, 228 - int(std::ceil(std::log2(largest_scale))));
    if (header->applied != std::array<double, 3>{1, 1, 1})
        facts.warnings.push_back(fmt::format("EXPOSURE and COLORCORR of the header were divided out: {:g} {:g} {:g}",
                                             header->applied[0], header->applied[1], header->applied[2]));
    if (header->xyze) {
        facts.to_rec709 = xyz_to_rec709();
        facts.warnings.push_back("CIE XYZ was converted to linear Rec. 709");
    } else if (header->primaries) {
        const std::optional<Mat3> matrix = rgb_to_rec709(*header->primaries);
        if (!matrix) {
            facts.warnings.push_back("the PRIMARIES line does not describe a colour space: ignored");
        } else if (!is_nearly_identity(*matrix)) {
            facts.to_rec709 = matrix;
            facts.warnings.push_back("the header's PRIMARIES were converted to linear Rec. 709");
        }
    }
    reader->offsets_.push_back(header->data_offset);
    return std::unique_ptr<ImageReader>(std::move(reader));
}

Error HdrReader::scanline_error(int scanline, const char* what) const {
    return {fmt::format("scanline {} of {}: {}", scanline + 1, header_.columns ? header_.width : header_.height, what),
            "", "The file is truncated or damaged."};
}

/// Finds where scanlines start until `count` of them are known.
Result<void> HdrReader::index_scanlines(int count) {
    const int length = header_.columns ? header_.height : header_.width;
    while (int(offsets_.size()) <= count) {
        const ScanlineStep step = skip_hdr_scanline(bytes_->bytes().subspan(offsets_.back()), length);
        if (step.error) return scanline_error(int(offsets_.size()) - 1, step.error);
        offsets_.push_back(offsets_.back() + step.bytes);
    }
    return {};
}

/// One row of RGB from planes of RGBE. Returns true if every value is within the range that needs no repair.
bool HdrReader::convert_row(const std::uint8_t* planes, std::size_t plane_stride, float* out) const {
    rgbe_to_float(planes, plane_stride, header_.width, scale_, out);
    if (header_.flip_x && !header_.columns) mirror_row(out, header_.width);
    std::uint8_t brightest = 0;
    for (int x = 0; x < header_.width; ++x) brightest = std::max(brightest, planes[3 * plane_stride + x]);
    return brightest <= brightest_exponent_;
}

Result<bool> HdrReader::read(ImageView<float> rows) {
    return header_.columns ? read_columns(rows) : read_scanlines(rows);
}

Result<bool> HdrReader::read_scanlines(ImageView<float> rows) {
    const Result<bool> in_range =
        resolve_threads(threads_) == 1 && !header_.flip_y ? read_in_order(rows) : read_by_index(rows);
    if (!in_range) return in_range;
    next_row_ += rows.height;
    if (!header_.flip_y) released_ = bytes_->release(released_, offsets_[next_row_]);
    return in_range;
}

/// One row after the other: decoding finds where the next one starts.
Result<bool> HdrReader::read_in_order(ImageView<float> rows) {
    const std::size_t stride = header_.width;
    std::vector<std::uint8_t> planes(4 * stride + k_scanline_slack);
    bool in_range = true;
    for (int y = 0; y < rows.height; ++y) {
        const auto data = bytes_->bytes().subspan(offsets_.back());
        const ScanlineStep step = decode_hdr_scanline(data, header_.width, planes.data(), stride);
        if (step.error) return scanline_error(next_row_ + y, step.error);
        offsets_.push_back(offsets_.back() + step.bytes);
        in_range &= convert_row(planes.data(), stride, rows.row(y));
    }
    return in_range;
}

/// Finds where the rows are, then decodes them on all threads.
Result<bool> HdrReader::read_by_index(ImageView<float> rows) {
    // From the bottom up, the first row lies at the end of the file: find them all.
    const int height = header_.height;
    if (const auto indexed = index_scanlines(header_.flip_y ? height : next_row_ + rows.height); !indexed)
        return indexed.error();
    std::atomic<bool> in_range{true};
    parallel_ranges(rows.height, k_rows_a_task, threads_, [&](int begin, int end) {
        const std::size_t stride = header_.width;
        std::vector<std::uint8_t> planes(4 * stride + k_scanline_slack);
        for (int y = begin; y < end; ++y) {
            const int row = next_row_ + y, scanline = header_.flip_y ? height - 1 - row : row;
            decode_hdr_scanline(bytes_->bytes().subspan(offsets_[scanline]), header_.width, planes.data(), stride);
            if (!convert_row(planes.data(), stride, rows.row(y))) in_range = false;
        }
    });
    return in_range.load();
}

/// Decodes the whole picture, transposed into rows from the top down.
Result<void> HdrReader::decode_columns() {
    if (const auto indexed = index_scanlines(header_.width); !indexed) return indexed.error();
    const std::size_t width = header_.width, height = header_.height;
    columns_.resize(4 * width * height);
    // Eight neighbouring columns a task: their bytes of a row share a cache line.
    parallel_ranges(header_.width, k_rows_a_task, threads_, [&](int begin, int end) {
        std::vector<std::uint8_t> column(4 * height + k_scanline_slack);
        for (int scanline = begin; scanline < end; ++scanline) {
            decode_hdr_scanline(bytes_->bytes().subspan(offsets_[scanline]), header_.height, column.data(), height);
            const std::size_t x = header_.flip_x ? width - 1 - scanline : scanline;
            for (std::size_t c = 0; c < 4; ++c)
                for (std::size_t i = 0; i < height; ++i) {
                    const std::size_t y = header_.flip_y ? height - 1 - i : i;
                    columns_[(c * height + y) * width + x] = column[c * height + i];
                }
        }
    });
    return {};
}

Result<bool> HdrReader::read_columns(ImageView<float> rows) {
    if (columns_.empty())
        if (const auto decoded = decode_columns(); !decoded) return decoded.error();
    const std::size_t width = header_.width, plane = width * header_.height;
    bool in_range = true;
    for (int y = 0; y < rows.height; ++y)
        in_range &= convert_row(columns_.data() + std::size_t(next_row_ + y) * width, plane, rows.row(y));
    next_row_ += rows.height;
    return in_range;
}

}  // namespace domelight
