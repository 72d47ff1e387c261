// Writes OpenEXR images of several layers: channels are named LAYER.R and so on, those of the first layer without a
// prefix.
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"

#include "io/exr/exr_output_stream.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <fmt/core.h>

namespace domelight {
namespace {

std::string channel_name(const ExrLayer& layer, int channel) {
    constexpr const char* rgba[] = {"R", "G", "B", "A"};
    const std::string last = layer.pixels.channels == 1 ? (layer.channel.empty() ? "Y" : layer.channel) : rgba[channel];
    return layer.name.empty() ? last : layer.name + "." + last;
}

/// May throw.
void write_layers(ExrOutputStream& stream, std::span<const ExrLayer> layers, const ExrWriteOptions& options) {
    Imf::Header header(layers[0].pixels.width, layers[0].pixels.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::addChromaticities(header, Imf::Chromaticities());
    for (const auto& [name, value] : options.attributes) header.insert(name, Imf::StringAttribute(value));
    Imf::FrameBuffer frame;
    for (const ExrLayer& layer : layers)
        for (int c = 0; c < layer.pixels.channels; ++c) {
            const std::string name = channel_name(layer, c);
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            char* base = reinterpret_cast<char*>(const_cast<float*>(layer.pixels.data + c));
            frame.insert(name, Imf::Slice(Imf::FLOAT, base, 4 * std::size_t(layer.pixels.channels),
                                          4 * std::size_t(layer.pixels.stride)));
        }
    Imf::OutputFile file(stream, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(layers[0].pixels.height);
    stream.flush();
}

}  // namespace

Result<void> write_exr_layers(const std::filesystem::path& file, std::span<const ExrLayer> layers,
                              const ExrWriteOptions& options) {
    for (const ExrLayer& layer : layers)
        if (layer.pixels.width != layers[0].pixels.width || layer.pixels.height != layers[0].pixels.height ||
            layer.pixels.channels > 4)
            return Error{fmt::format("layer \"{}\" has another size than the first", layer.name), file.string(), ""};
    if (layers.empty()) return Error{"there is no layer to write", file.string(), ""};
    return write_file_atomically(file, [&](const std::filesystem::path& path) -> Result<void> {
        OutputFile out(path);
        ExrOutputStream stream(out);
        Result<void> written;
        try {
            write_layers(stream, layers, options);
        } catch (const std::exception& e) {
            written = Error{std::string("OpenEXR: ") + e.what(), "", ""};
        }
        Result<void> finished = out.finish();
        return finished ? written : finished;
    });
}

}  // namespace domelight
