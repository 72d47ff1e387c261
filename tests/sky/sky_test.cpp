#include "domelight/sky.h"

#include "domelight/projection.h"

#include "test.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace domelight;

namespace {

ImageF whole(const SkyOptions& options) {
    auto sky = make_sky(options);
    ImageF image(sky->width(), sky->height(), 3);
    REQUIRE(bool(sky->read(image.view())));
    return image;
}

}  // namespace

TEST_CASE("make_sky: the same bytes on any number of threads and in any pieces") {
    SkyOptions options;
    options.height = 65;
    options.threads = 1;
    const ImageF one = whole(options);
    options.threads = 3;
    auto sky = make_sky(options);
    ImageF pieces(sky->width(), sky->height(), 3);
    for (int y = 0, n = 1; y < pieces.height(); y += n, n = n % 7 + 1) {
        n = std::min(n, pieces.height() - y);
        REQUIRE(bool(sky->read(pieces.view().rows(y, n))));
    }
    CHECK(std::equal(one.pixels().begin(), one.pixels().end(), pieces.pixels().begin()));
}
