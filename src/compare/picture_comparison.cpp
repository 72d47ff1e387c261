#include "domelight/compare/picture_comparison.h"

#include "domelight/image/colour.h"

#include "preview/tonemap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace domelight {
namespace {

bool is_finite(const float* p) {
    return std::all_of(p, p + 3, [](float v) { return std::isfinite(v); });
}

/// Stops that bring the log-average luminance of a picture to 0.18.
double automatic_exposure(ImageView<const float> image, Mask mask) {
    double mean = 0, sum = 0;
    std::int64_t pixels = 0;
    const auto each = [&](auto&& use) {
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                if (!mask.data || mask.at(x, y)[0] > 0) {
                    const float* p = image.at(x, y);
                    use(std::max(double(luminance(Vec3f{p[0], p[1], p[2]})), 0.0));
                }
    };
    each([&](double l) { mean += l, ++pixels; });
    if (!(mean > 0)) return 0;
    mean /= double(pixels);
    each([&](double l) { sum += std::log(std::max(l, 1e-3 * mean)); });
    return std::log2(0.18) - sum / double(pixels) / std::log(2.0);
}

/// A picture as a display shows it: sRGB values, 0 to 1.
ImageF shown(const Picture& picture, double exposure_ev) {
    const Display display{picture.high_dynamic_range ? Tonemap::neutral : Tonemap::none, float(std::exp2(exposure_ev))};
    ImageF out(picture.rgb.width(), picture.rgb.height(), 3);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x) {
            const float* p = picture.rgb.at(x, y);
            float* q = out.at(x, y);
            const Vec3f v = display.encoded({p[0], p[1], p[2]});
            q[0] = v.x, q[1] = v.y, q[2] = v.z;
        }
    return out;
}

/// Sums over the pixels of one object.
struct FlipSums {
    double flip = 0, hdr_flip = 0;
};

std::map<int, FlipSums> flip_sums(const PictureComparison& c, const ImageF& objects, Mask mask) {
    std::map<int, FlipSums> sums;
    if (!c.flip) return sums;
    for (int y = 0; y < objects.height(); ++y)
        for (int x = 0; x < objects.width(); ++x) {
            const float index = *objects.at(x, y);
            if ((mask.data && !(mask.at(x, y)[0] > 0)) || !(index >= 0 && index < 1e9F)) continue;
            FlipSums& sum = sums[int(std::lround(index))];
            sum.flip += *c.flip_map.at(x, y);
            if (c.hdr_flip) sum.hdr_flip += *c.hdr.error.at(x, y);
        }
    return sums;
}

std::string object_name(const std::vector<std::string>& names, int index) {
    if (index == 0) return "background";
    const std::size_t place = std::size_t(index) - 1;
    return place < names.size() && !names[place].empty() ? names[place] : fmt::format("object {}", index);
}

std::vector<ObjectComparison> compared_objects(const PicturePair& pair, const PictureComparison& c, int threads) {
    const Picture& named = pair.reference.objects.empty() ? pair.test : pair.reference;
    std::vector<ObjectComparison> rows;
    if (named.objects.empty()) return rows;
    const Mask mask = pair.mask_view();
    const std::map<int, FlipSums> sums = flip_sums(c, named.objects, mask);
    for (const ObjectErrors& object :
         compare_objects(pair.test.rgb.view(), pair.reference.rgb.view(), named.objects.view(), mask, threads)) {
        ObjectComparison row{object_name(named.object_names, object.index), object.errors, {}, {}};
        const auto sum = sums.find(object.index);
        const FlipSums of_object = sum == sums.end() ? FlipSums{} : sum->second;
        if (c.flip) row.flip = of_object.flip / double(object.errors.pixels);
        if (c.hdr_flip) row.hdr_flip = of_object.hdr_flip / double(object.errors.pixels);
        rows.push_back(std::move(row));
    }
    return rows;
}

}  // namespace

PicturePair without_bad_pixels(PicturePair pair) {
    ImageF &test = pair.test.rgb, &reference = pair.reference.rgb;
    if (pair.mask.empty()) pair.mask = ImageF(test.width(), test.height(), 1, 1.0F);
    for (int y = 0; y < test.height(); ++y)
        for (int x = 0; x < test.width(); ++x) {
            float *p = test.at(x, y), *q = reference.at(x, y);
            if (is_finite(p) && is_finite(q)) continue;
            pair.left_out += *pair.mask.at(x, y) > 0;
            *pair.mask.at(x, y) = 0;
            std::fill_n(p, 3, 0.0F);
            std::fill_n(q, 3, 0.0F);
        }
    return pair;
}

PictureComparison compare_pictures(const PicturePair& pair, const PictureComparisonOptions& options) {
    const auto test = pair.test.rgb.view(), reference = pair.reference.rgb.view();
    const Mask mask = pair.mask_view();
    const auto begin = [&](std::string_view stage, double done) {
        if (options.progress) options.progress(stage, done);
    };
    PictureComparison c;
    if (options.exposure_ev)
        c.exposure_ev = *options.exposure_ev;
    else if (pair.high_dynamic_range())
        c.exposure_ev = automatic_exposure(reference, mask);
    begin("errors", 0);
    c.errors = compare_images(test, reference, mask, options.threads);
    if (!pair.test.variance.empty() || !pair.reference.variance.empty())
        c.noise = compare_noisy(test, reference, pair.test.variance.view(), pair.reference.variance.view(), mask,
                                options.threads);
    if (options.flip) {
        begin("FLIP", 0.1);
        c.flip_map = flip(shown(pair.test, c.exposure_ev).view(), shown(pair.reference, c.exposure_ev).view(),
                          options.flip_options, options.threads);
        c.flip = mean_of(c.flip_map.view(), mask);
        begin("HDR-FLIP", 0.2);
        if (pair.high_dynamic_range()) {
            c.hdr = hdr_flip(test, reference, options.flip_options, options.threads);
            c.hdr_flip = mean_of(c.hdr.error.view(), mask);
        }
    }
    c.objects = compared_objects(pair, c, options.threads);
    return c;
}

const std::vector<std::string>& comparison_figures() {
    static const std::vector<std::string> names = {"rmse", "relative", "tone-mapped", "largest", "psnr", "ssim",
                                                   "flip", "hdr-flip", "mean",        "above-2", "chi2", "total-z"};
    return names;
}

std::optional<double> comparison_figure(const PictureComparison& c, std::string_view name) {
    const Errors& e = c.errors;
    if (name == "rmse") return e.rmse;
    if (name == "relative") return e.relative_rmse;
    if (name == "tone-mapped") return e.tone_mapped_rmse;
    if (name == "largest") return e.largest;
    if (name == "psnr") return e.psnr;
    if (name == "ssim") return e.ssim;
    if (name == "flip") return c.flip;
    if (name == "hdr-flip") return c.hdr_flip;
    if (name == "mean") return std::abs(e.mean_ratio - 1);
    if (!c.noise) return std::nullopt;
    if (name == "chi2") return c.noise->chi2;
    if (name == "above-2") return c.noise->share_above_2;
    if (name == "total-z") return std::abs(c.noise->total_z);
    return std::nullopt;
}

}  // namespace domelight
