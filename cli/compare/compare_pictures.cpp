#include "cli/compare/compare_pictures.h"

#include "domelight/bake/bake.h"
#include "domelight/compare/metrics.h"
#include "domelight/io/write_image.h"

#include "io/file/json.h"
#include "cli/console/field_options.h"
#include "cli/console/output_endings.h"
#include "compare/compare_sheet.h"
#include "compare/picture_reader.h"
#include "preview/tonemap.h"
#include "cli/console/print.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace domelight::cli {
namespace {

const std::vector<std::string> k_metrics = {"rmse", "relative", "tone-mapped", "largest", "psnr", "ssim",
                                            "flip", "hdr-flip", "mean",        "above-2", "chi2", "total-z"};
const std::vector<std::string> k_maps = {"auto",        "hdr-flip", "flip", "difference",
                                         "tone-mapped", "relative", "ssim", "z"};

struct ObjectRow {
    std::string name;
    Errors errors;
    std::optional<double> flip, hdr_flip;
};

/// Everything that is told of two pictures.
struct Comparison {
    std::string a, b;
    Picture test, reference;
    ImageF mask;
    std::int64_t skipped = 0;  ///< bad pixels left out
    double exposure_ev = 0;
    Errors errors;
    ImageF flip_map;
    HdrFlip hdr;
    std::optional<double> flip, hdr_flip;
    std::optional<NoiseSummary> noise;
    std::vector<ObjectRow> objects;
    std::vector<std::string> warnings;
    Mask mask_view() const { return mask.empty() ? Mask{} : Mask(mask.view()); }
};

// --- reading and checking ---

std::string size_text(const ImageF& image) {
    return fmt::format("{} x {}", image.width(), image.height());
}

Result<void> same_size(const ImageF& image, const std::string& name, const Comparison& c) {
    if (image.width() == c.reference.rgb.width() && image.height() == c.reference.rgb.height()) return {};
    return Error{fmt::format("is {}, but {} is {}", size_text(image), c.b, size_text(c.reference.rgb)), name,
                 "Pictures must be of one size to be compared pixel by pixel."};
}

/// NaN and infinity: an error, or left out of everything.
Result<void> check_bad_pixels(Comparison& c, bool skip) {
    for (const auto& [picture, name] : {std::pair(&c.test, &c.a), std::pair(&c.reference, &c.b)}) {
        const BadPixels bad = find_bad_pixels(picture->rgb.view(), c.mask_view());
        if (bad.count == 0) continue;
        if (!skip)
            return Error{fmt::format("{} pixel{} NaN or infinite, the first at ({}, {})", bad.count,
                                     bad.count == 1 ? " is" : "s are", bad.x, bad.y),
                         *name, "--skip-bad leaves such pixels out."};
        if (c.mask.empty()) c.mask = ImageF(picture->rgb.width(), picture->rgb.height(), 1, 1.0f);
        for (int y = 0; y < c.mask.height(); ++y)
            for (int x = 0; x < c.mask.width(); ++x) {
                float* p = picture->rgb.at(x, y);
                if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
                c.skipped += *c.mask.at(x, y) > 0;
                *c.mask.at(x, y) = 0;
            }
    }
    // FLIP and the sheet look at neighbours, so what is left out must be a number too: the same one in both.
    if (!c.mask.empty())
        for (int y = 0; y < c.mask.height(); ++y)
            for (int x = 0; x < c.mask.width(); ++x) {
                float *p = c.test.rgb.at(x, y), *q = c.reference.rgb.at(x, y);
                if (!std::all_of(p, p + 3, [](float v) { return std::isfinite(v); }) ||
                    !std::all_of(q, q + 3, [](float v) { return std::isfinite(v); }))
                    std::fill_n(p, 3, 0.0f), std::fill_n(q, 3, 0.0f);
            }
    if (c.skipped) c.warnings.push_back(fmt::format("{} bad pixels are left out", c.skipped));
    return {};
}

Result<void> read_mask(const PictureWords& w, Comparison& c) {
    if (w.mask.empty()) return {};
    auto mask = read_number_image(w.mask);
    if (!mask) return mask.error();
    if (auto ok = same_size(*mask, w.mask, c); !ok) return ok;
    c.mask = std::move(*mask);
    return {};
}

Result<Comparison> read_all(const std::string& a, const std::string& b, const PictureWords& w, int threads) {
    Comparison c;
    c.a = a, c.b = b;
    PictureOptions options;
    options.layer = w.layer;
    options.level = w.level.value_or(0);
    options.variance = w.variance;
    options.threads = threads;
    auto test = read_picture(a, options);
    if (!test) return test.error();
    if (!w.layer_b.empty()) options.layer = w.layer_b;
    auto reference = read_picture(b, options);
    if (!reference) return reference.error();
    c.test = std::move(*test), c.reference = std::move(*reference);
    for (const auto& [picture, name] : {std::pair(&c.test, &a), std::pair(&c.reference, &b)})
        for (const std::string& warning : picture->warnings) c.warnings.push_back(*name + ": " + warning);
    if (auto ok = same_size(c.test.rgb, a, c); !ok) return ok.error();
    if (c.test.high_dynamic_range != c.reference.high_dynamic_range)
        c.warnings.push_back(
            "one picture holds radiance, the other a screen's values decoded from sRGB: they may not be meant to be "
            "equal");
    if (auto ok = read_mask(w, c); !ok) return ok.error();
    if (auto ok = check_bad_pixels(c, w.skip_bad); !ok) return ok.error();
    if (!c.mask.empty() && std::none_of(c.mask.pixels().begin(), c.mask.pixels().end(), [](float v) { return v > 0; }))
        return Error{"leaves no pixel to compare", w.mask.empty() ? "--skip-bad" : w.mask,
                     "A mask keeps the pixels above 0."};
    if (!w.objects.empty()) {
        auto objects = read_number_image(w.objects);
        if (!objects) return objects.error();
        if (auto ok = same_size(*objects, w.objects, c); !ok) return ok.error();
        c.reference.objects = std::move(*objects);
        c.reference.object_names.clear();
    }
    return c;
}

// --- figures ---

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

void measure_objects(Comparison& c, int threads) {
    const ImageF& ids = !c.reference.objects.empty() ? c.reference.objects : c.test.objects;
    const auto& names = !c.reference.objects.empty() ? c.reference.object_names : c.test.object_names;
    if (ids.empty()) return;
    struct Sum {
        double flip = 0, hdr = 0;
    };
    std::map<int, Sum> sums;
    const Mask mask = c.mask_view();
    if (c.flip)
        for (int y = 0; y < ids.height(); ++y)
            for (int x = 0; x < ids.width(); ++x) {
                const float id = *ids.at(x, y);
                if ((mask.data && !(mask.at(x, y)[0] > 0)) || !(id >= 0 && id < 1e9f)) continue;
                Sum& sum = sums[int(std::lround(id))];
                sum.flip += *c.flip_map.at(x, y);
                if (c.hdr_flip) sum.hdr += *c.hdr.error.at(x, y);
            }
    for (const ObjectErrors& object :
         compare_objects(c.test.rgb.view(), c.reference.rgb.view(), ids.view(), mask, threads)) {
        const std::size_t place = std::size_t(object.index) - 1;  // 0 is no object
        ObjectRow row{object.index == 0                               ? "background"
                      : place < names.size() && !names[place].empty() ? names[place]
                                                                      : fmt::format("object {}", object.index),
                      object.errors,
                      {},
                      {}};
        if (c.flip) row.flip = sums[object.index].flip / double(object.errors.pixels);
        if (c.hdr_flip) row.hdr_flip = sums[object.index].hdr / double(object.errors.pixels);
        c.objects.push_back(std::move(row));
    }
}

void measure(Comparison& c, const PictureWords& w, int threads, const Progress& progress) {
    const auto test = c.test.rgb.view(), reference = c.reference.rgb.view();
    const Mask mask = c.mask_view();
    const bool hdr = c.reference.high_dynamic_range || c.test.high_dynamic_range;
    c.exposure_ev = w.view_exposure != "auto" ? *parse_number(w.view_exposure)
                    : hdr                     ? automatic_exposure(reference, mask)
                                              : 0;
    if (progress) progress("errors", 0);
    c.errors = compare_images(test, reference, mask, threads);
    if (!c.test.variance.empty() || !c.reference.variance.empty())
        c.noise = compare_noisy(test, reference, c.test.variance.view(), c.reference.variance.view(), mask, threads);
    if (!w.no_flip) {
        const FlipOptions options{w.pixels_per_degree};
        if (progress) progress("FLIP", 0.1);
        c.flip_map =
            flip(shown(c.test, c.exposure_ev).view(), shown(c.reference, c.exposure_ev).view(), options, threads);
        c.flip = mean_of(c.flip_map.view(), mask);
        if (progress) progress("HDR-FLIP", 0.2);
        if (hdr) {
            c.hdr = hdr_flip(test, reference, options, threads);
            c.hdr_flip = mean_of(c.hdr.error.view(), mask);
        }
    }
    measure_objects(c, threads);
}

std::optional<double> metric(const Comparison& c, const std::string& name) {
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
    return std::abs(c.noise->total_z);
}

// --- limits ---

struct Limit {
    std::string metric;
    double value = 0;
    bool above = true;
};

Result<std::vector<Limit>> parse_limits(const PictureWords& w) {
    std::vector<Limit> limits;
    for (const auto& [option, texts, above] :
         {std::tuple("--fail-above", &w.fail_above, true), std::tuple("--fail-below", &w.fail_below, false)})
        for (const std::string& text : *texts) {
            const auto parts = split(text, '=');
            const auto value = parts.size() == 2 ? parse_number(parts[1]) : Result<double>(Error{});
            if (!value || std::isnan(*value))
                return Error{fmt::format("\"{}\" is not METRIC=VALUE", text), option, "For example relative=0.01."};
            if (std::find(k_metrics.begin(), k_metrics.end(), parts[0]) == k_metrics.end())
                return Error{fmt::format("no metric \"{}\"", parts[0]), option,
                             "Accepted: " + join(k_metrics, ", ") + "."};
            limits.push_back({parts[0], *value, above});
        }
    return limits;
}

/// The limits that are not kept, as sentences.
Result<std::vector<std::string>> exceeded(const Comparison& c, const std::vector<Limit>& limits) {
    std::vector<std::string> found;
    for (const Limit& limit : limits) {
        const auto value = metric(c, limit.metric);
        if (!value)
            return Error{"\"" + limit.metric + "\" is not known of these pictures",
                         limit.above ? "--fail-above" : "--fail-below",
                         "chi2, above-2 and total-z need a variance layer; hdr-flip a picture of high dynamic range."};
        if (limit.above ? !(*value <= limit.value) : !(*value >= limit.value))
            found.push_back(fmt::format("{} is {:.6g}, {} {:g}", limit.metric, *value, limit.above ? "above" : "below",
                                        limit.value));
    }
    return found;
}

// --- pictures ---

ImageF map_of(const Comparison& c, const std::function<double(const float* a, const float* b, int x, int y)>& f) {
    ImageF out(c.test.rgb.width(), c.test.rgb.height(), 1);
    for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
            *out.at(x, y) = float(f(c.test.rgb.at(x, y), c.reference.rgb.at(x, y), x, y));
    return out;
}

double tone(double v) {
    return v > 0 ? v / (1 + v) : 0;
}

/// A - B in the luminance that a display would show: of L / (1 + L) at the sheet's exposure.
ImageF signed_difference(const Comparison& c) {
    const double scale = std::exp2(c.exposure_ev);
    const auto shown_luminance = [scale](const float* p) {
        return 0.2126 * tone(scale * p[0]) + 0.7152 * tone(scale * p[1]) + 0.0722 * tone(scale * p[2]);
    };
    return map_of(c, [&](const float* a, const float* b, int, int) { return shown_luminance(a) - shown_luminance(b); });
}

/// One of k_maps, drawn with its own scale unless --heat-max gives one.
struct NamedMap {
    ImageF values;
    std::string title;
    double high = 0;  ///< 0: by the values
    bool is_signed = false;
    HeatMap heat(double wanted, Mask mask) const {
        return {values.view(), title,
                wanted > 0 ? wanted
                : high > 0 ? high
                           : scale_for(values.view(), mask),
                is_signed};
    }
};

Result<NamedMap> named_map(const Comparison& c, std::string name, int threads) {
    if (name.empty() || name == "auto") name = c.hdr_flip ? "hdr-flip" : c.flip ? "flip" : "tone-mapped";
    if (name == "hdr-flip" && c.hdr_flip)
        return NamedMap{c.hdr.error, fmt::format("HDR-FLIP, mean {:.4g}", *c.hdr_flip), 1, false};
    if (name == "flip" && c.flip)
        return NamedMap{c.flip_map, fmt::format("FLIP at {:+.2f} EV, mean {:.4g}", c.exposure_ev, *c.flip), 1, false};
    if (name == "difference")
        return NamedMap{signed_difference(c),
                        fmt::format("A - B, luminance of L / (1 + L) at {:+.2f} EV", c.exposure_ev), 0, true};
    const auto largest = [](const float* a, const float* b, auto&& f) {
        double most = 0;
        for (int i = 0; i < 3; ++i) most = std::max(most, f(double(a[i]), double(b[i])));
        return most;
    };
    if (name == "tone-mapped")
        return NamedMap{map_of(c,
                               [&](const float* a, const float* b, int, int) {
                                   return largest(a, b, [](double p, double q) { return std::abs(tone(p) - tone(q)); });
                               }),
                        "|A - B| of L / (1 + L), largest channel", 0, false};
    if (name == "relative")
        return NamedMap{map_of(c,
                               [&](const float* a, const float* b, int, int) {
                                   return largest(a, b, [](double p, double q) {
                                       return p == q ? 0 : std::abs(p - q) / (std::abs(q) + 1e-6);
                                   });
                               }),
                        "|A - B| / B, largest channel", 0, false};
    if (name == "ssim") {
        NamedMap map{ssim(c.test.rgb.view(), c.reference.rgb.view(), c.mask_view(), threads), "1 - SSIM", 1, false};
        for (float& v : map.values.pixels()) v = 1 - v;
        return map;
    }
    if (name == "z" && c.noise) {
        const auto variance = [&](int x, int y) {
            double v = 0;
            for (const ImageF* image : {&c.test.variance, &c.reference.variance})
                if (!image->empty()) v += image->at(x, y)[0] + image->at(x, y)[1] + image->at(x, y)[2];
            return v;
        };
        return NamedMap{map_of(c,
                               [&](const float* a, const float* b, int x, int y) {
                                   const double v = variance(x, y), d = double(a[0]) + a[1] + a[2] - b[0] - b[1] - b[2];
                                   return v > 0 ? d / std::sqrt(v) : 0;
                               }),
                        "z = (A - B) / standard error, of the channels' sum", 4, true};
    }
    return Error{"\"" + name + "\" is not known of these pictures", "--heat-of",
                 "z needs a variance layer, hdr-flip a picture of high dynamic range, both kinds of FLIP that "
                 "--no-flip is not given."};
}

std::string file_name(const std::string& path) {
    return std::filesystem::path(path).filename().string();
}

Result<void> write_pictures(const Comparison& c, const PictureWords& w, int threads) {
    if (!w.heat.empty()) {
        const auto map = named_map(c, w.heat_of, threads);
        if (!map) return map.error();
        if (auto ok =
                write_screen_picture(w.heat, heat_picture(map->heat(w.heat_max, c.mask_view()), c.mask_view()).view());
            !ok)
            return ok.error().at(w.heat);
    }
    if (w.sheet.empty()) return {};
    const auto difference = named_map(c, "difference", threads), perceived = named_map(c, "auto", threads);
    CompareSheet sheet;
    sheet.title = fmt::format("{} against {}", file_name(c.a), file_name(c.b));
    sheet.subtitle = fmt::format(
        "relative RMSE {:.3g} %   ·   RMSE of L / (1 + L) {:.3g}   ·   SSIM {:.4f}   ·   mean A / mean B {:.5g}",
        100 * c.errors.relative_rmse, c.errors.tone_mapped_rmse, c.errors.ssim, c.errors.mean_ratio);
    sheet.test_name = c.a, sheet.reference_name = c.b;
    sheet.test = c.test.rgb.view(), sheet.reference = c.reference.rgb.view();
    sheet.exposure_ev = c.exposure_ev;
    sheet.tone_map = c.test.high_dynamic_range || c.reference.high_dynamic_range;
    sheet.difference = difference->heat(0, c.mask_view());
    sheet.perceived = perceived->heat(0, c.mask_view());
    sheet.mask = c.mask_view();
    if (auto ok = write_screen_picture(w.sheet, compare_sheet(sheet, threads).view()); !ok)
        return ok.error().at(w.sheet);
    return {};
}

// --- telling ---

Json errors_json(const Errors& e, const std::optional<double>& flip, const std::optional<double>& hdr_flip) {
    Json json{{"pixels", e.pixels},
              {"rmse", e.rmse},
              {"relative_rmse", e.relative_rmse},
              {"tone_mapped_rmse", e.tone_mapped_rmse},
              {"psnr", e.psnr},
              {"ssim", e.ssim},
              {"mean_ratio", e.mean_ratio},
              {"largest", e.largest},
              {"largest_at", {e.largest_x, e.largest_y}}};
    if (flip) json["flip"] = *flip;
    if (hdr_flip) json["hdr_flip"] = *hdr_flip;
    return json;
}

Json picture_json(const std::string& name, const Picture& picture) {
    return {
        {"file", name}, {"format", picture.format}, {"width", picture.rgb.width()}, {"height", picture.rgb.height()}};
}

void print_json(const Comparison& c, const std::vector<std::string>& failures) {
    Json json{{"version", version()},
              {"kind", "comparison"},
              {"a", picture_json(c.a, c.test)},
              {"b", picture_json(c.b, c.reference)},
              {"errors", errors_json(c.errors, c.flip, c.hdr_flip)},
              {"exposure_ev", c.exposure_ev}};
    if (c.hdr_flip)
        json["hdr_flip_exposures"] = {{"start_ev", c.hdr.start}, {"stop_ev", c.hdr.stop}, {"count", c.hdr.count}};
    if (c.noise)
        json["noise"] = {{"values", c.noise->values},
                         {"without_noise", c.noise->without_noise},
                         {"mean_z", c.noise->mean_z},
                         {"chi2", c.noise->chi2},
                         {"share_above_2", c.noise->share_above_2},
                         {"total_z", c.noise->total_z},
                         {"mean_ratio", c.noise->mean_ratio},
                         {"mean_ratio_95", {c.noise->ratio_low, c.noise->ratio_high}}};
    json["objects"] = Json::array();
    for (const ObjectRow& row : c.objects) {
        Json object{{"name", row.name}};
        object.update(errors_json(row.errors, row.flip, row.hdr_flip));
        json["objects"].push_back(object);
    }
    json["skipped_pixels"] = c.skipped;
    json["failures"] = failures;
    json["warnings"] = with_options(c.warnings);
    print_document(json);
}

void print_noise(const NoiseSummary& n) {
    print("\n  noise, as the files state it ({} channel values)\n", n.values);
    print("    mean A / mean B      {:.6g}, 95 % within [{:.6g}, {:.6g}]\n", n.mean_ratio, n.ratio_low,
          n.ratio_high);
    print("    z of the means       {:+.2f}       {}\n", n.total_z,
          std::abs(n.total_z) > 3   ? "a bias"
          : std::abs(n.total_z) > 2 ? "perhaps a bias"
                                    : "no bias seen");
    print("    chi2 / values        {:.4g}      {}\n", n.chi2,
          n.chi2 < 0.7
              ? "below 1: the pictures share samples, or stratified ones, whose stated variance is an upper bound"
          : n.chi2 < 1.3 ? "noise explains the difference"
                         : "above 1: more than noise");
    print("    share of |z| > 2     {:.2f} %     of normal noise 4.55 %\n", 100 * n.share_above_2);
    if (n.without_noise) print("    differ without noise {}\n", n.without_noise);
}

void print_objects(const Comparison& c) {
    constexpr std::size_t k_most = 60;
    std::size_t width = 12;
    for (const ObjectRow& row : c.objects) width = std::max(width, std::min<std::size_t>(row.name.size(), 32));
    print("\n  {:<{}}  {:>9}  {:>10}  {:>9}  {:>11}  {:>7}  {:>7}  {:>8}\n", "object", width, "pixels", "RMSE",
          "relative", "tone-mapped", "SSIM", "FLIP", "A / B");
    std::vector<const ObjectRow*> rows;
    for (const ObjectRow& row : c.objects) rows.push_back(&row);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const ObjectRow* a, const ObjectRow* b) { return a->errors.pixels > b->errors.pixels; });
    for (std::size_t i = 0; i < std::min(rows.size(), k_most); ++i) {
        const ObjectRow& row = *rows[i];
        const auto flip = row.hdr_flip ? row.hdr_flip : row.flip;
        print("  {:<{}}  {:>9}  {:>10.4g}  {:>7.3g} %  {:>11.4g}  {:>7.4f}  {:>7}  {:>8.5g}\n",
              printable(row.name, 32), width, row.errors.pixels, row.errors.rmse, 100 * row.errors.relative_rmse,
              row.errors.tone_mapped_rmse, row.errors.ssim, flip ? fmt::format("{:.4f}", *flip) : "-",
              row.errors.mean_ratio);
    }
    if (rows.size() > k_most) print("  ... and {} smaller ones (--json has all)\n", rows.size() - k_most);
}

void print_text(const Comparison& c, const PictureWords& w) {
    const auto picture = [](const char* letter, const std::string& name, const Picture& p, const char* role) {
        print("{}  {}: {}, {}{}\n", letter, name, p.format, size_text(p.rgb), role);
    };
    picture("A", c.a, c.test, "");
    picture("B", c.b, c.reference, ", the reference");
    const Errors& e = c.errors;
    print("\n  RMSE                   {:<12.6g}\n", e.rmse);
    print("  relative RMSE          {:<12}\n", fmt::format("{:.4g} %", 100 * e.relative_rmse));
    print("  tone-mapped RMSE       {:<12.6g} of L / (1 + L)\n", e.tone_mapped_rmse);
    print("  PSNR                   {:<12} of L / (1 + L), peak 1\n", fmt::format("{:.2f} dB", e.psnr));
    print("  SSIM                   {:<12.6g} of the luminance of L / (1 + L)\n", e.ssim);
    if (c.flip)
        print("  FLIP                   {:<12.6g} {}{:.1f} pixels a degree\n", *c.flip,
              c.reference.high_dynamic_range ? fmt::format("at {:+.2f} EV, ", c.exposure_ev) : "",
              w.pixels_per_degree);
    if (c.hdr_flip)
        print("  HDR-FLIP               {:<12.6g} largest of {} exposures, {:+.1f} to {:+.1f} EV\n", *c.hdr_flip,
              c.hdr.count, c.hdr.start, c.hdr.stop);
    print("  mean A / mean B        {:<12.6g}\n", e.mean_ratio);
    print("  largest difference     {:<12.6g} at ({}, {})\n", e.largest, e.largest_x, e.largest_y);
    if (!c.mask.empty())
        print("  pixels that count      {} of {}\n", e.pixels,
              std::int64_t(c.test.rgb.width()) * c.test.rgb.height());
    if (c.noise) print_noise(*c.noise);
    if (!c.objects.empty()) print_objects(c);
    for (const auto& file : {w.heat, w.sheet})
        if (!file.empty()) print("\n  wrote {}", file);
    if (!w.heat.empty() || !w.sheet.empty()) print("\n");
}

Result<void> check_words(const PictureWords& w) {
    if (!(w.pixels_per_degree >= 1 && w.pixels_per_degree <= 1000))
        return Error{"is not from 1 to 1000", "--pixels-per-degree", ""};
    if (!(w.heat_max >= 0) || std::isinf(w.heat_max)) return Error{"is not a positive number", "--heat-max", ""};
    if (w.view_exposure != "auto") {
        const auto ev = parse_number(w.view_exposure);
        if (!ev || !(std::abs(*ev) <= 60))
            return Error{"is neither auto nor a number from -60 to 60", "--view-exposure", ""};
    }
    if (w.level.value_or(0) < 0) return Error{"is below 0", "--level", ""};
    for (const auto& [option, file] : {std::pair("--heat", &w.heat), std::pair("--sheet", &w.sheet)})
        if (auto ok = check_ending(option, *file, screen_picture_extensions()); !ok) return ok;
    return {};
}

}  // namespace

void add_picture_options(Arguments& a, PictureWords& w) {
    a.group("Two pictures: what is compared");
    a.text("--layer", "NAME", w.layer,
           "OpenEXR: the layer or channel to compare (the unnamed one, else the first with colour)");
    a.text("--layer-b", "NAME", w.layer_b, "the layer of B, if it differs");
    a.integer("--level", "N", w.level, "textures: the level to compare (0)");
    a.text("--mask", "FILE", w.mask, "an image of the same size: only pixels above 0 count");
    a.text("--objects", "FILE", w.objects,
           "an image of object indices, 0 for none (PNG codes, or an EXR channel): a table by object; else B's channel "
           "\"object\"");
    a.choice("--variance", w.variance, {"pixel", "sample"},
             "the meaning of the layer \"variance\": that of the pixel's value, or that of a sample, to be divided by the "
             "channel \"samples\" (pixel)");
    a.flag("--skip-bad", w.skip_bad, "ignore NaN and infinite pixels, which are otherwise an error");
    a.number("--pixels-per-degree", "P", w.pixels_per_degree,
             "viewing distance for FLIP, as pixels per degree (67.02: 0.7 m from a 0.7 m wide display of 3840 pixels)");
    a.flag("--no-flip", w.no_flip, "leave out FLIP and HDR-FLIP, which take most of the time");
    a.group("Two pictures: what is written");
    a.text("--heat", "FILE", w.heat, "a heat map with its scale, .png or .jpg");
    a.choice("--heat-of", w.heat_of, k_maps, "the metric of the heat map (auto: hdr-flip, or flip for screen "
                                             "pictures)");
    a.number("--heat-max", "X", w.heat_max, "the value of the last colour (FLIP: 1; otherwise from the values)");
    a.text("--sheet", "FILE", w.sheet,
           "A, B, their signed difference and the perceived one side by side, .png or .jpg");
    a.text("--view-exposure", "EV", w.view_exposure,
           "stops for the sheet and for FLIP; auto brings B's log-average luminance to 0.18 (auto)");
    a.texts("--fail-above", "METRIC=VALUE", w.fail_above,
            "exit with status 1 if a metric is above the value: " + join(k_metrics, ", ") + " (mean: |A / B - 1|)");
    a.texts("--fail-below", "METRIC=VALUE", w.fail_below, "the same if psnr or ssim is below the value");
}

int compare_pictures(const std::string& a, const std::string& b, const PictureWords& w, const CommonOptions& common) {
    if (auto ok = check_words(w); !ok) return print_error(ok.error(), exit_usage);
    const auto limits = parse_limits(w);
    if (!limits) return print_error(limits.error(), exit_usage);
    const int threads = common.threads.value_or(0);
    auto read = read_all(a, b, w, threads);
    if (!read) return print_error(read.error(), exit_failed);
    Comparison& c = *read;
    {
        ProgressBar bar(b, common);
        measure(c, w, threads, bar.callback());
    }
    const auto failures = exceeded(c, *limits);
    if (!failures) return print_error(failures.error(), exit_usage);
    if (auto ok = write_pictures(c, w, threads); !ok) return print_error(ok.error());
    print_warnings(c.warnings, common);
    if (common.json)
        print_json(c, *failures);
    else if (!common.quiet)
        print_text(c, w);
    for (const std::string& failure : *failures) print_error({failure, b, ""});
    return failures->empty() ? exit_done : exit_failed;
}

}  // namespace domelight::cli
