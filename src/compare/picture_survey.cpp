#include "compare/picture_survey.h"

#include "preview/screen_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace domelight {

PictureSurvey survey_picture(const Picture& picture) {
    PictureSurvey survey;
    float least = std::numeric_limits<float>::infinity(), largest = -least;
    double sum[3] = {}, count[3] = {};
    const auto values = picture.rgb.pixels();
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        bool not_a_number = false, infinite = false, negative = false;
        for (std::size_t c = 0; c < 3; ++c) {
            const float v = values[i + c];
            not_a_number |= std::isnan(v);
            infinite |= std::isinf(v);
            negative |= v < 0;
            if (!std::isfinite(v)) continue;
            least = std::min(least, v);
            largest = std::max(largest, v);
            sum[c] += v;
            ++count[c];
        }
        survey.not_a_number += not_a_number;
        survey.infinite += infinite;
        survey.negative += negative;
    }
    if (least <= largest) survey.least = least, survey.largest = largest;
    const auto mean = [&](int c) { return count[c] > 0 ? sum[c] / count[c] : 0; };
    survey.mean = {mean(0), mean(1), mean(2)};
    survey.cut_out = picture.cut_out();
    survey.ev = automatic_ev(picture.rgb, picture.opacity, survey.cut_out);
    if (picture.opacity.empty()) return survey;
    double covered = 0;
    for (const float o : picture.opacity.pixels()) covered += std::isfinite(o) ? o : 0;
    survey.coverage = covered / double(picture.opacity.pixels().size());
    return survey;
}

}  // namespace domelight
