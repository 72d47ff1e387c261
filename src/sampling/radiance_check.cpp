#include "sampling/radiance_check.h"

#include "domelight/base/parallel.h"

#include "base/text.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace domelight {

namespace {

bool sound(float value) {
    return value >= 0 && value <= std::numeric_limits<float>::max();
}

/// The column of the row's first texel that is not sound; -1 if there is none.
int bad_column(const float* row, int width) {
    bool fine = true;
    for (int i = 0; i < 3 * width; ++i) fine &= sound(row[i]);
    return fine ? -1 : int(std::find_if_not(row, row + 3 * width, sound) - row) / 3;
}

}  // namespace

Result<void> check_radiance(ImageView<const float> image, int threads) {
    if (image.width < 1 || image.height < 1) return Error{"the environment has no texels", "", ""};
    if (image.channels != 3)
        return Error{text("the environment has ", image.channels, " channels instead of 3"), "", ""};
    std::vector<int> bad(image.height);
    parallel_ranges(image.height, 16, threads, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) bad[y] = bad_column(image.row(y), image.width);
    });
    for (int y = 0; y < image.height; ++y) {
        if (bad[y] < 0) continue;
        const float* p = image.at(bad[y], y);
        return Error{text("texel (", bad[y], ", ", y, ") is (", p[0], ", ", p[1], ", ", p[2], ")"), "",
                     "Radiance must be finite and not negative; open_environment repairs files."};
    }
    return {};
}

}  // namespace domelight
