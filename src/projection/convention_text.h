#pragma once
// A projection's convention in one line, as it stands in manifests and in files, and back.

#include <optional>
#include <string>

namespace domelight {

/// The directions of a projection's centre, right and top: "lat-long, centre +X, right +Z, up +Y". `projection` is named
/// as in projections.h; any other text is returned as it is.
std::string projection_convention(const std::string& projection);

/// The projection that such a text about a lat-long image names: "latlong/usd", or "latlong/centre=-Y,right=+X,up=+Z".
/// Nothing for other texts.
std::optional<std::string> latlong_of_convention(const std::string& text);

}  // namespace domelight
