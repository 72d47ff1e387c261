#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"

#include "io/file/file_reader.h"
#include "io/image_reader.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// An OpenEXR file by its channels, as renderers write them: R, G, B, direct.R, variance.R, object, ...
class ExrLayers {
  public:
    virtual ~ExrLayers() = default;
    /// Size of the display window; channels of another part may have another one and are then refused by read().
    virtual int width() const = 0;
    virtual int height() const = 0;
    /// All channels that are not deep, in the file's order. In a file of several parts a channel is named PART.CHANNEL.
    virtual const std::vector<std::string>& channels() const = 0;
    /// A string attribute of the first part, if it is there.
    virtual std::optional<std::string> attribute(const std::string& name) const = 0;
    /// The named channels side by side: height() x width() x names.size(). What lies outside the data window is 0.
    /// Values are as stored, NaN too. Errors: no such channel, subsampled, of another size, damaged, over the limit on
    /// memory.
    virtual Result<ImageF> read(std::span<const std::string> names) = 0;

    /// The names before the channels' last dots, each once: "", "direct", "ViewLayer.Combined".
    std::vector<std::string> layers() const;
    bool has(const std::string& channel) const;
    /// The channels of a layer's colour: R G B (or r g b, X Y Z), else one channel for all three. `layer`: a layer's
    /// name, the end of only one layer's name after a dot, or a channel's. The error lists the layers.
    Result<std::vector<std::string>> colour_of(const std::string& layer) const;
};

/// Errors: not OpenEXR, damaged, headers that ask for more than the file can hold, no channels.
Result<std::unique_ptr<ExrLayers>> open_exr_layers(std::shared_ptr<const FileBytes> bytes,
                                                   const ReaderOptions& options = {});

}  // namespace domelight
