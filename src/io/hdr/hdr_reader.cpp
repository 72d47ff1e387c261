#include "io/hdr/hdr_reader.h"

#include "domelight/base/parallel.h"

#include "image/repair.h"
#include "image/srgb_curve.h"
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

/// Radiance's luminous efficacy of white light (lm/W): the Y of its XYZE pictures is in cd/m², and its RGBE in
/// W/(m² sr). "RADIANCE Reference, Picture File Format"; WHTEFFICACY in its color.h.
constexpr double k_radiance_efficacy = 179;

/// ImageMagick writes this GAMMA for pixels of its sRGB, whose curve is not quite that power.
constexpr double k_gamma_of_srgb = 1 / 2.2;

/// The light of RGBE's every mantissa and exponent, 256 mantissas for each exponent, where the header has a GAMMA.
std::vector<float> light_by_gamma(double gamma) {
    const bool srgb = std::abs(gamma - k_gamma_of_srgb) < 1e-3;
    std::vector<float> curve(256 * 256);
    for (int exponent = 2; exponent < 256; ++exponent)
        for (int mantissa = 0; mantissa < 256; ++mantissa) {
            const double v = std::ldexp(double(mantissa), exponent - 136);
            curve[std::size_t(256 * exponent + mantissa)] =
                float(std::min(srgb ? srgb_to_linear(v) : std::pow(v, 1 / gamma), double(k_largest_radiance)));
        }
    return curve;
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
    facts.always_light = true;
    facts.warnings = header->warnings;
    reader->set_scale();
    reader->set_primaries();
    reader->offsets_.push_back(header->data_offset);
    return std::unique_ptr<ImageReader>(std::move(reader));
}

/// The factor of each channel, and the curve before it.
void HdrReader::set_scale() {
    const std::array<double, 3>& applied = header_.applied;
    const bool photometric = header_.xyze && header_.by_radiance;
    double largest_scale = 1;
    for (int c = 0; c < 3; ++c) {
        const double scale = 1 / applied[c] / (photometric ? k_radiance_efficacy : 1);
        scale_[c] = float(scale);
        largest_scale = std::max(largest_scale, scale);
    }
    // 255 * 2^(e - 136) * scale < 2^100
    brightest_exponent_ = std::max(0, 228 - int(std::ceil(std::log2(largest_scale))));
    if (applied != std::array<double, 3>{1, 1, 1})
        facts_.warnings.push_back(fmt::format("EXPOSURE and COLORCORR of the header were divided out: {:g} {:g} {:g}",
                                              applied[0], applied[1], applied[2]));
    if (photometric)
        facts_.warnings.push_back(
            fmt::format("Radiance's XYZE is in cd/m²: it was divided by {:g} lm/W", k_radiance_efficacy));
    if (std::abs(header_.gamma - 1) < 1e-6) return;
    curve_ = light_by_gamma(header_.gamma);
    brightest_exponent_ = 0;
    facts_.warnings.push_back(fmt::format("GAMMA={:g} of the header was undone{}", header_.gamma,
                                          std::abs(header_.gamma - k_gamma_of_srgb) < 1e-3 ? ", as sRGB" : ""));
}

/// The matrix from the file's colours to linear Rec. 709.
void HdrReader::set_primaries() {
    if (header_.xyze) {
        constexpr ColourPrimaries::Xy equal_energy{1 / 3.0, 1 / 3.0};
        facts_.to_rec709 = header_.by_radiance ? *xyz_to_rec709(equal_energy) : xyz_to_rec709();
        facts_.warnings.push_back(header_.by_radiance
                                      ? "CIE XYZ was converted to linear Rec. 709, with Radiance's grey (equal energy)"
                                      : "CIE XYZ was converted to linear Rec. 709");
        return;
    }
    if (!header_.primaries) return;
    const std::optional<Mat3> matrix = rgb_to_rec709(*header_.primaries);
    if (!matrix) {
        facts_.warnings.push_back("the PRIMARIES line does not describe a colour space: ignored");
    } else if (!is_nearly_identity(*matrix)) {
        facts_.to_rec709 = matrix;
        facts_.warnings.push_back("the header's PRIMARIES were converted to linear Rec. 709");
    }
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
    if (curve_.empty()) {
        rgbe_to_float(planes, plane_stride, header_.width, scale_, out);
    } else {
        for (std::size_t x = 0; x < std::size_t(header_.width); ++x)
            for (std::size_t c = 0; c < 3; ++c)
                out[3 * x + c] =
                    curve_[256 * std::size_t(planes[3 * plane_stride + x]) + planes[c * plane_stride + x]] * scale_[c];
    }
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
