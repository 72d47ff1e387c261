#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"

#include <algorithm>

namespace domelight {

std::span<const std::string> screen_picture_extensions() {
    static const std::string all[] = {".png", ".jpg", ".jpeg"};
    return all;
}

bool is_screen_picture(const std::filesystem::path& file) {
    const auto all = screen_picture_extensions();
    return std::find(all.begin(), all.end(), lower_case_extension(file)) != all.end();
}

bool holds_opacity(const std::filesystem::path& file) {
    return lower_case_extension(file) == ".png";
}

Result<void> write_screen_picture(const std::filesystem::path& file, ImageView<const std::uint8_t> pixels) {
    return lower_case_extension(file) == ".png" ? write_png(file, pixels) : write_jpeg(file, pixels);
}

}  // namespace domelight
