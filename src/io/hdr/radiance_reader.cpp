#include "io/hdr/radiance_reader.h"

#include "domelight/base/parallel.h"
#include "domelight/projection/projection.h"

#include <algorithm>

namespace domelight {

RadianceReader::RadianceReader(std::filesystem::path file, std::unique_ptr<ImageReader> image, RepairOptions options,
                               std::shared_ptr<RepairReport> report)
    : file_(std::move(file)), image_(std::move(image)), report_(std::move(report)) {
    const ImageFacts& facts = image_->facts();
    report_->warnings.insert(report_->warnings.end(), facts.warnings.begin(), facts.warnings.end());
    options.largest = std::min(facts.largest, k_largest_radiance);
    options.to_rec709 = facts.to_rec709;
    if (options.wraps)
        options.weight = [width = facts.width, height = facts.height](int y) {
            return latlong_solid_angle(y, width, height);
        };
    options_ = options;
    if (!facts.always_light || facts.to_rec709)
        repair_.emplace(facts.width, facts.height, options, [this](ImageView<float> rows) -> Result<void> {
            const Result<bool> read = image_->read(rows);
            if (!read) return read.error();
            return {};
        });
}

Result<void> RadianceReader::read(ImageView<float> rows) {
    if (repair_) {
        if (const auto read = repair_->next(rows, *report_); !read) return read.error().at(file_.string());
        return {};
    }
    const Result<bool> in_range = image_->read(rows);
    if (!in_range) return in_range.error().at(file_.string());
    if (!*in_range || options_.scale != 1) scale_rows(rows);
    return {};
}

/// Every value is finite and not negative; none may pass the largest radiance.
void RadianceReader::scale_rows(ImageView<float> rows) {
    std::vector<std::int64_t> clipped(std::size_t(rows.height));
    parallel_for(rows.height, options_.threads, [&](int y) {
        for (int x = 0; x < rows.width; ++x) {
            float* texel = rows.at(x, y);
            bool over = false;
            for (int c = 0; c < 3; ++c) {
                const float value = texel[c] * options_.scale;
                over |= value > k_largest_radiance;
                texel[c] = std::min(value, k_largest_radiance);
            }
            clipped[std::size_t(y)] += over;
        }
    });
    for (const std::int64_t count : clipped) report_->infinite += count;
}

}  // namespace domelight
