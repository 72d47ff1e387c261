#include "io/exr/exr_facts.h"

#include "image/repair.h"
#include "io/file/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

namespace domelight {

namespace {

bool contains(const ExrWindow& outer, const ExrWindow& inner) {
    return outer[0] <= inner[0] && outer[1] <= inner[1] && outer[2] >= inner[2] && outer[3] >= inner[3];
}

bool intersect(const ExrWindow& a, const ExrWindow& b) {
    return a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];
}

/// Takes over the primaries of the file, where they are others than Rec. 709's.
void set_primaries(ImageFacts& facts, const ColourPrimaries& primaries) {
    const auto matrix = rgb_to_rec709(primaries);
    if (!matrix) {
        facts.warnings.push_back("the chromaticities do not describe a colour space: ignored");
    } else if (!is_nearly_identity(*matrix)) {
        facts.to_rec709 = matrix;
        facts.warnings.push_back(are_xyz(primaries) ? "CIE XYZ was converted to linear Rec. 709"
                                                    : "the file's chromaticities were converted to linear Rec. 709");
    }
}

}  // namespace

Result<ExrWindow> exr_picture_window(const ExrHeader& header, const ReaderOptions& options) {
    const ExrWindow window = header.envmap != ImageFacts::Envmap::none ? header.data : header.display;
    const std::int64_t width = std::int64_t(window[2]) - window[0] + 1, height = std::int64_t(window[3]) - window[1] + 1;
    if (const auto sized = check_image_size(width, height); !sized) return sized.error();
    if (!intersect(window, header.data))
        return Error{"the data window lies outside the display window: no texel would be seen", "", ""};
    if (const auto checked = check_exr_black(window, header.data, options); !checked) return checked.error();
    return window;
}

bool exr_is_filled(const ExrColour& colour, const ExrWindow& window, const ExrWindow& data) {
    const bool named =
        colour.kind != ExrColour::Kind::rgb ||
        std::none_of(std::begin(colour.names), std::end(colour.names), [](const auto& n) { return n.empty(); });
    return named && contains(data, window);
}

ImageFacts exr_facts(const ExrHeader& header, const ExrWindow& window, const ExrColour& colour,
                     const ExrChannels& channels) {
    ImageFacts facts;
    facts.format = "OpenEXR";
    facts.width = window[2] - window[0] + 1;
    facts.height = window[3] - window[1] + 1;
    facts.layer = colour.layer;
    facts.largest = header.half ? 65504 : k_largest_radiance;
    facts.envmap = header.envmap;
    if (colour.chosen_by_us)
        facts.warnings.push_back(fmt::format("the layer {} is read, of: {} (`layer` names another)",
                                             printable(colour.layer), channels.layer_list()));
    if (colour.kind == ExrColour::Kind::rgb)
        for (int c = 0; c < 3; ++c)
            if (colour.names[c].empty())
                facts.warnings.push_back(fmt::format("channel {} is missing: read as 0", "RGB"[c]));
    if (!contains(header.data, window))
        facts.warnings.push_back("the data window does not fill the display window: the rest is black");
    if (header.primaries && colour.kind != ExrColour::Kind::vector) set_primaries(facts, *header.primaries);
    return facts;
}

}  // namespace domelight
