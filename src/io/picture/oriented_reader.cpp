#include "io/picture/oriented_reader.h"

#include <fmt/format.h>

#include <algorithm>

namespace domelight {

namespace {

const char* const k_words[] = {"",
                               "",
                               "mirrored from left to right",
                               "turned by 180 degrees",
                               "mirrored from top to bottom",
                               "with rows and columns exchanged",
                               "turned clockwise by 90 degrees",
                               "turned by 180 degrees, with rows and columns exchanged",
                               "turned counterclockwise by 90 degrees"};

class OrientedReader : public ImageReader {
  public:
    OrientedReader(std::unique_ptr<ImageReader> reader, int orientation)
        : reader_(std::move(reader)), orientation_(orientation) {
        facts_ = reader_->facts();
        if (orientation_ >= 5) std::swap(facts_.width, facts_.height);
        facts_.warnings.push_back(fmt::format("Exif's orientation {} is heeded: the picture is {}", orientation_,
                                              k_words[std::size_t(orientation_)]));
    }
    Result<bool> read(ImageView<float> rows) override;

  private:
    std::unique_ptr<ImageReader> reader_;
    int orientation_;
    bool in_range_ = true;
    ImageF image_;  // as stored
    int next_row_ = 0;
};

Result<bool> OrientedReader::read(ImageView<float> rows) {
    if (image_.width() == 0) {
        image_ = ImageF(reader_->facts().width, reader_->facts().height, 3);
        const Result<bool> read = reader_->read(image_.view());
        if (!read) return read;
        in_range_ = *read;
    }
    for (int y = 0; y < rows.height; ++y)
        for (int x = 0; x < rows.width; ++x)
            std::copy_n(seen_texel(image_, orientation_, x, next_row_ + y), 3, rows.at(x, y));
    next_row_ += rows.height;
    return in_range_;
}

}  // namespace

/// The orientation says on which side the stored rows and columns begin: 6 has row 0 on the right and column 0 at the
/// top.
const float* seen_texel(const ImageF& stored, int orientation, int x, int y) {
    const bool exchanged = orientation >= 5;
    const int right = (exchanged ? stored.height() : stored.width()) - 1 - x;
    const int up = (exchanged ? stored.width() : stored.height()) - 1 - y;
    switch (orientation) {
        case 2:
            return stored.at(right, y);
        case 3:
            return stored.at(right, up);
        case 4:
            return stored.at(x, up);
        case 5:
            return stored.at(y, x);
        case 6:
            return stored.at(y, right);
        case 7:
            return stored.at(up, right);
        case 8:
            return stored.at(up, x);
        default:
            return stored.at(x, y);
    }
}

Result<std::unique_ptr<ImageReader>> oriented_reader(std::unique_ptr<ImageReader> reader, int orientation,
                                                     std::int64_t max_bytes) {
    if (orientation == 1) return reader;
    const ImageFacts& facts = reader->facts();
    const std::int64_t bytes = std::int64_t(facts.width) * facts.height * 3 * std::int64_t(sizeof(float));
    if (bytes > max_bytes)
        return Error{
            fmt::format("turning {} x {} texels as Exif's orientation says needs {} bytes, more than the limit "
                        "of {}",
                        facts.width, facts.height, bytes, max_bytes),
            "", "Turn the picture before, and store it as it is seen."};
    return std::unique_ptr<ImageReader>(std::make_unique<OrientedReader>(std::move(reader), orientation));
}

}  // namespace domelight
