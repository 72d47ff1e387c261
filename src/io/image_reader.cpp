#include "io/image_reader.h"

#include "base/field_place.h"
#include "io/picture/foreign_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace domelight {

Result<void> check_image_size(std::int64_t width, std::int64_t height) {
    if (width < 1 || height < 1) return Error{fmt::format("image is {} x {}: it has no texels", width, height), "", ""};
    if (width > k_max_image_side || height > k_max_image_side)
        return Error{
            fmt::format("image is {} x {}, but no side may be longer than {}", width, height, k_max_image_side), "",
            ""};
    return {};
}

Error no_layers() {
    return {"only OpenEXR files have layers", "", "Leave out `layer`."};
}

Result<std::unique_ptr<ImageReader>> open_image_reader(std::shared_ptr<const FileBytes> bytes,
                                                       const ReaderOptions& options) {
    if (options.decode >= Decode::rgbm)
        return Error{"a picture is not decoded as " + name_of(options.decode), field_place("decode"),
                     "That is for textures of eight bits a channel (KTX2, KTX, DDS)."};
    using namespace std::string_view_literals;
    const auto all = bytes->bytes();
    const auto starts_with = [&](std::string_view magic) {
        return all.size() >= magic.size() && std::equal(magic.begin(), magic.end(), all.begin(),
                                                        [](char a, std::uint8_t b) { return std::uint8_t(a) == b; });
    };
    if (!options.layer.empty() && !starts_with("\x76\x2f\x31\x01"sv)) return no_layers();
    if (starts_with("#?"sv)) return open_hdr_reader(std::move(bytes), options);
    if (starts_with("\x76\x2f\x31\x01"sv)) return open_exr_reader(std::move(bytes), options);
    if (starts_with("\x89PNG\r\n\x1a\n"sv)) return open_png_reader(std::move(bytes), options);
    if (starts_with("\xff\xd8\xff"sv)) return open_jpeg_reader(std::move(bytes), options);
    if (const auto foreign = foreign_format(all); foreign && !foreign->hint.empty())
        return Error{foreign->name + " is not read", "", foreign->hint};
    return Error{"not an image of a known format", "",
                 "Known: Radiance .hdr, OpenEXR, PNG, JPEG; as cubes also KTX2, KTX, DDS and .env."};
}

}  // namespace domelight
