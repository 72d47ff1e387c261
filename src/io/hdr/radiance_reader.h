#pragma once

#include "domelight/image/repair_report.h"
#include "domelight/image/row_source.h"

#include "image/repair.h"
#include "io/image_reader.h"

#include <filesystem>
#include <memory>

namespace domelight {

/// The rows of an image file as radiance: decoded, repaired (counted in `report`), in linear Rec. 709, times `scale`.
class RadianceReader : public RowSource {
  public:
    /// `options`: scale, wraps, negatives and threads; the rest comes from the image. Rows that wrap are those of a
    /// lat-long image, whose solid angles count.
    RadianceReader(std::filesystem::path file, std::unique_ptr<ImageReader> image, RepairOptions options,
                   std::shared_ptr<RepairReport> report);
    int width() const override { return image_->facts().width; }
    int height() const override { return image_->facts().height; }
    /// Errors name the file.
    Result<void> read(ImageView<float> rows) override;

  private:
    std::filesystem::path file_;
    std::unique_ptr<ImageReader> image_;
    void scale_rows(ImageView<float> rows);

    RepairOptions options_;
    std::optional<RowRepair> repair_;  ///< where the file may hold what is no light
    std::shared_ptr<RepairReport> report_;
};

}  // namespace domelight
