#pragma once

#include "domelight/base/result.h"

#include "image/colour_primaries.h"
#include "io/exr/exr_channels.h"
#include "io/exr/exr_header_reader.h"
#include "io/image_reader.h"

#include <optional>

namespace domelight {

/// What a reader of OpenEXR takes from the header of the part that it reads, whatever library decodes it.
struct ExrHeader {
    ExrWindow display{}, data{};
    bool half = false;  ///< the first channel of the colour holds half floats
    ImageFacts::Envmap envmap = ImageFacts::Envmap::none;
    std::optional<ColourPrimaries> primaries;
};

/// The window of the picture that is read: of an environment its data window (ImfEnvmap.h), of a picture its display
/// window. Errors: no texels, or too many; a data window outside of it; too much black around that.
Result<ExrWindow> exr_picture_window(const ExrHeader& header, const ReaderOptions& options);

/// Whether every value of the picture is in the file.
bool exr_is_filled(const ExrColour& colour, const ExrWindow& window, const ExrWindow& data);

/// The properties of a picture, with all warnings. `channels` are those of the file.
ImageFacts exr_facts(const ExrHeader& header, const ExrWindow& window, const ExrColour& colour,
                     const ExrChannels& channels);

}  // namespace domelight
