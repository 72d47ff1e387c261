#include "io/hdr/radiance_reader.h"

#include "domelight/base/parallel.h"

#include <algorithm>
#include <vector>

namespace domelight {

RadianceReader::RadianceReader(std::filesystem::path file, std::unique_ptr<ImageReader> image, float scale, bool wraps,
                               int threads, std::shared_ptr<RepairReport> report)
    : file_(std::move(file)), image_(std::move(image)), threads_(threads), report_(std::move(report)) {
    const ImageFacts& facts = image_->facts();
    repair_ = {std::min(facts.largest, k_largest_radiance), facts.to_rec709, scale, wraps};
    report_->warnings.insert(report_->warnings.end(), facts.warnings.begin(), facts.warnings.end());
}

Result<void> RadianceReader::read(ImageView<float> rows) {
    const Result<bool> in_range = image_->read(rows);
    if (!in_range) return in_range.error().at(file_.string());
    if (*in_range && !repair_.to_rec709 && repair_.scale == 1) return {};

    constexpr int rows_a_task = 8;
    std::vector<RepairReport> parts((rows.height + rows_a_task - 1) / rows_a_task);
    parallel_ranges(rows.height, rows_a_task, threads_, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            repair_row({rows.row(y), std::size_t(rows.width) * 3}, repair_, parts[std::size_t(begin / rows_a_task)]);
    });
    for (const RepairReport& part : parts) add_repairs(*report_, part);
    return {};
}

}  // namespace domelight
