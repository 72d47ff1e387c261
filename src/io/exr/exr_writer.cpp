// Writes OpenEXR scanline images.
#include "domelight/base/parallel.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"

#include "io/exr/exr_levels.h"
#include "io/exr/exr_stream.h"
#include "io/exr/exr_writing.h"
#include "io/file/output_file.h"
#include "texture/texel/half.h"

#include <ImfChannelList.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace domelight {

namespace {

/// The number of rows given to OpenEXR at a time: several chunks for most compressions, but little memory.
constexpr int k_block_rows = 64;

constexpr std::array<std::pair<const char*, Imf::Compression>, 10> k_compressions{{
    {"none", Imf::NO_COMPRESSION},
    {"rle", Imf::RLE_COMPRESSION},
    {"zips", Imf::ZIPS_COMPRESSION},
    {"zip", Imf::ZIP_COMPRESSION},
    {"piz", Imf::PIZ_COMPRESSION},
    {"pxr24", Imf::PXR24_COMPRESSION},
    {"b44", Imf::B44_COMPRESSION},
    {"b44a", Imf::B44A_COMPRESSION},
    {"dwaa", Imf::DWAA_COMPRESSION},
    {"dwab", Imf::DWAB_COMPRESSION},
}};

Result<Imf::Compression> compression_from_name(const std::string& name) {
    std::string accepted;
    for (const auto& [known, value] : k_compressions) {
        if (name == known) return value;
        accepted += (accepted.empty() ? "" : ", ") + std::string(known);
    }
    return Error{"\"" + name + "\" is not an OpenEXR compression", "", "accepted: " + accepted};
}

}  // namespace

std::vector<const char*> exr_channel_names(int channels) {
    if (channels == 1) return {"Y"};
    std::vector<const char*> names{"R", "G", "B", "A"};
    names.resize(std::size_t(channels));
    return names;
}

Result<bool> fits_half(RowSource& rows) {
    ImageF block(rows.width(), std::min(rows.height(), k_block_rows), 3);
    for (int y = 0; y < rows.height(); y += k_block_rows) {
        const ImageView<float> view = block.view().rows(0, std::min(k_block_rows, rows.height() - y));
        if (const auto read = rows.read(view); !read) return read.error();
        if (!fits_half(view)) return false;
    }
    return true;
}

Result<Imf::Header> exr_header(int width, int height, int channels, bool half, const ExrWriteOptions& options) {
    const auto compression = compression_from_name(options.compression);
    if (!compression) return compression.error();
    Imf::Header header(width, height);
    header.compression() = *compression;
    for (const char* name : exr_channel_names(channels))
        header.channels().insert(name, Imf::Channel(half ? Imf::HALF : Imf::FLOAT));
    Imf::addChromaticities(header, Imf::Chromaticities());  // its default is Rec. 709
    if (options.envmap == "latlong")
        Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
    else if (options.envmap == "cube")
        Imf::addEnvmap(header, Imf::ENVMAP_CUBE);
    else if (!options.envmap.empty())
        return Error{"\"" + options.envmap + "\" is not an envmap", "", "accepted: latlong, cube"};
    if (options.envmap == "cube" && height != 6 * width)
        return Error{"a cube must be a strip six times as high as wide, not " + std::to_string(width) + " x " +
                         std::to_string(height),
                     "", ""};
    for (const auto& [name, value] : options.attributes) header.insert(name, Imf::StringAttribute(value));
    return header;
}

namespace {

/// Rows in the form that OpenEXR needs: half floats in our own buffer, floats in place.
class RowWriter {
  public:
    RowWriter(Imf::OutputFile& file, int channels, bool half)
        : file_(file), names_(exr_channel_names(channels)), half_(half) {}

    void write(ImageView<const float> rows, int threads) {
        if (half_) convert(rows, threads);
        const std::size_t channel_bytes = half_ ? 2 : 4;
        const std::size_t pixel = channel_bytes * std::size_t(rows.channels);
        const std::size_t line = half_ ? pixel * std::size_t(rows.width) : channel_bytes * std::size_t(rows.stride);
        const char* data =
            half_ ? reinterpret_cast<const char*>(halves_.data()) : reinterpret_cast<const char*>(rows.data);
        // OpenEXR finds row y at base + y * line; the first of these is row next_.
        char* base = const_cast<char*>(data) - std::ptrdiff_t(line) * next_;
        Imf::FrameBuffer frame;
        for (std::size_t c = 0; c < names_.size(); ++c)
            frame.insert(names_[c], Imf::Slice(half_ ? Imf::HALF : Imf::FLOAT, base + channel_bytes * c, pixel, line));
        file_.setFrameBuffer(frame);
        file_.writePixels(rows.height);
        next_ += rows.height;
    }

  private:
    void convert(ImageView<const float> rows, int threads) {
        const int row_values = rows.width * rows.channels;
        halves_.resize(std::size_t(row_values) * std::size_t(rows.height));
        parallel_for(rows.height, threads, [&](int y) {
            const float* in = rows.row(y);
            std::uint16_t* out = halves_.data() + std::size_t(y) * std::size_t(row_values);
            for (int i = 0; i < row_values; ++i) {
                const float v = in[i];
                out[i] = half_from_float(v > k_half_max ? k_half_max : v < -k_half_max ? -k_half_max : v);
            }
        });
    }

    Imf::OutputFile& file_;
    std::vector<const char*> names_;
    bool half_;
    int next_ = 0;
    std::vector<std::uint16_t> halves_;
};

/// The source of the rows: called with the first row and their number; the view must stay valid until the next call.
using NextRows = std::function<Result<ImageView<const float>>(int first, int count)>;

/// May throw.
Result<void> write_image(ExrOutputStream& stream, int width, int height, int channels, bool half,
                         const ExrWriteOptions& options, const NextRows& next) {
    auto header = exr_header(width, height, channels, half, options);
    if (!header) return header.error();
    // The pool belongs to the process and only grows. With one thread everything runs on this thread.
    const int threads = resolve_threads(options.threads);
    provide_exr_threads(threads);
    Imf::OutputFile file(stream, *header, threads > 1 ? threads : 0);
    RowWriter rows(file, channels, half);
    for (int y = 0; y < height; y += k_block_rows) {
        const auto block = next(y, std::min(k_block_rows, height - y));
        if (!block) return block.error();
        rows.write(*block, threads);
    }
    return {};
}

Result<void> write_exr_rows(const std::filesystem::path& file, int width, int height, int channels, bool half,
                            const ExrWriteOptions& options, const NextRows& next) {
    return write_exr_file(file, [&](ExrOutputStream& stream) {
        return write_image(stream, width, height, channels, half, options, next);
    });
}

}  // namespace

Result<void> write_exr_file(const std::filesystem::path& file,
                            const std::function<Result<void>(ExrOutputStream& stream)>& write) {
    return write_file_atomically(file, [&](const std::filesystem::path& path) -> Result<void> {
        OutputFile out(path);
        ExrOutputStream stream(out);
        Result<void> written;
        try {
            written = write(stream);
            stream.flush();
        } catch (const std::exception& e) {
            written = Error{std::string("OpenEXR: ") + e.what(), "", ""};
        }
        // A full disk also causes an exception, but the error of the file is more informative.
        Result<void> finished = out.finish();
        return finished ? written : finished;
    });
}

Result<void> write_exr(const std::filesystem::path& file, ImageView<const float> pixels,
                       const ExrWriteOptions& options) {
    ImageF cube;
    if (options.envmap == "cube" && pixels.height == 6 * pixels.width) {
        cube = exr_cube_strip(pixels);
        pixels = cube;
    }
    const bool half = options.half ? *options.half : fits_half(pixels);
    return write_exr_rows(
        file, pixels.width, pixels.height, pixels.channels, half, options,
        [&](int first, int count) -> Result<ImageView<const float>> { return pixels.rows(first, count); });
}

Result<void> write_exr(const std::filesystem::path& file, RowSource& rows, const ExrWriteOptions& options) {
    if (options.envmap == "cube") return Error{"a cube cannot be written row by row", file.string(), ""};
    ImageF block(rows.width(), std::min(rows.height(), k_block_rows), 3);
    return write_exr_rows(file, rows.width(), rows.height(), 3, options.half.value_or(false), options,
                          [&](int, int count) -> Result<ImageView<const float>> {
                              const ImageView<float> view = block.view().rows(0, count);
                              Result<void> read = rows.read(view);
                              if (!read) return read.error();
                              return ImageView<const float>(view);
                          });
}

}  // namespace domelight
