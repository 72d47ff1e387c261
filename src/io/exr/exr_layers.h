#pragma once

#include "domelight/base/result.h"
#include "domelight/image/image.h"

#include "io/exr/exr_channels.h"
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
    virtual const ExrChannels& table() const = 0;
    /// A string attribute of the first part, if it is there.
    virtual std::optional<std::string> attribute(const std::string& name) const = 0;
    /// The named channels side by side: height() x width() x names.size(). What lies outside the data window is 0.
    /// Values are as stored, NaN too. Errors: no such channel, subsampled, of another size, damaged, over the limit on
    /// memory.
    virtual Result<ImageF> read(std::span<const std::string> names) = 0;

    /// All channels that are not deep by their full names, in the file's order.
    std::vector<std::string> channels() const;
    std::vector<std::string> layers() const { return table().layers(); }
    bool has(const std::string& channel) const;
    /// The full names of the three channels of a layer's colour (ExrChannels::colour), or one channel three times.
    Result<std::vector<std::string>> colour_of(const std::string& layer) const;
};

/// Errors: not OpenEXR, damaged, headers that ask for more than the file can hold, no channels.
Result<std::unique_ptr<ExrLayers>> open_exr_layers(std::shared_ptr<const FileBytes> bytes,
                                                   const ReaderOptions& options = {});

}  // namespace domelight
