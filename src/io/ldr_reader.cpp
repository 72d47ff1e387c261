#include "io/image_reader.h"

namespace domelight {

Result<std::unique_ptr<ImageReader>> open_png_reader(std::shared_ptr<const FileBytes>, const ReaderOptions&) {
    return Error{"PNG is not read yet", "", ""};
}
Result<std::unique_ptr<ImageReader>> open_jpeg_reader(std::shared_ptr<const FileBytes>, const ReaderOptions&) {
    return Error{"JPEG is not read yet", "", ""};
}

}  // namespace domelight
