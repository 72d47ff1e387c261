#include "cli/compare/compare_pictures.h"

#include "domelight/base/version.h"
#include "domelight/compare/difference_map.h"
#include "domelight/compare/picture_comparison.h"
#include "domelight/io/write_image.h"

#include "cli/console/field_options.h"
#include "cli/console/output_endings.h"
#include "cli/console/print.h"
#include "io/file/json.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace domelight::cli {
namespace {

/// The pictures as read, and everything that is printed of them.
struct Comparison {
    std::string a, b;
    PicturePair pair;
    std::vector<std::string> warnings;
    PictureComparison result;
};

// --- reading and checking ---

std::string size_text(const ImageF& image) {
    return fmt::format("{} x {}", image.width(), image.height());
}

Result<void> same_size(const ImageF& image, const std::string& name, const Comparison& c) {
    const ImageF& reference = c.pair.reference.rgb;
    if (image.width() == reference.width() && image.height() == reference.height()) return {};
    return Error{fmt::format("is {}, but {} is {}", size_text(image), c.b, size_text(reference)), name,
                 "Pictures must be of one size to be compared pixel by pixel."};
}

/// NaN and infinity: an error, or left out of everything.
Result<void> check_bad_pixels(Comparison& c, bool skip) {
    bool leave_out = !c.pair.mask.empty();
    for (const auto& [picture, name] : {std::pair(&c.pair.test, &c.a), std::pair(&c.pair.reference, &c.b)}) {
        const BadPixels bad = find_bad_pixels(picture->rgb.view(), c.pair.mask_view());
        if (bad.count == 0) continue;
        if (!skip)
            return Error{fmt::format("{} pixel{} NaN or infinite, the first at ({}, {})", bad.count,
                                     bad.count == 1 ? " is" : "s are", bad.x, bad.y),
                         *name, "--skip-bad leaves such pixels out."};
        leave_out = true;
    }
    if (leave_out) c.pair = without_bad_pixels(std::move(c.pair));
    if (c.pair.left_out) c.warnings.push_back(fmt::format("{} bad pixels are left out", c.pair.left_out));
    return {};
}

Result<void> read_mask(const PictureWords& w, Comparison& c) {
    if (w.mask.empty()) return {};
    auto mask = read_number_image(w.mask);
    if (!mask) return mask.error();
    if (auto ok = same_size(*mask, w.mask, c); !ok) return ok;
    c.pair.mask = std::move(*mask);
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
    PicturePair& pair = c.pair;
    pair.test = std::move(*test), pair.reference = std::move(*reference);
    for (const auto& [picture, name] : {std::pair(&pair.test, &a), std::pair(&pair.reference, &b)})
        for (const std::string& warning : picture->warnings) c.warnings.push_back(*name + ": " + warning);
    if (auto ok = same_size(pair.test.rgb, a, c); !ok) return ok.error();
    if (pair.test.high_dynamic_range != pair.reference.high_dynamic_range)
        c.warnings.push_back(
            "one picture holds radiance, the other a screen's values decoded from sRGB: they may not be meant to be "
            "equal");
    if (auto ok = read_mask(w, c); !ok) return ok.error();
    if (auto ok = check_bad_pixels(c, w.skip_bad); !ok) return ok.error();
    const auto counts = [](float v) { return v > 0; };
    if (!pair.mask.empty() && std::none_of(pair.mask.pixels().begin(), pair.mask.pixels().end(), counts))
        return Error{"leaves no pixel to compare", w.mask.empty() ? "--skip-bad" : w.mask,
                     "A mask keeps the pixels above 0."};
    if (!w.objects.empty()) {
        auto objects = read_number_image(w.objects);
        if (!objects) return objects.error();
        if (auto ok = same_size(*objects, w.objects, c); !ok) return ok.error();
        pair.reference.objects = std::move(*objects);
        pair.reference.object_names.clear();
    }
    return c;
}

PictureComparison compared(const PicturePair& pair, const PictureWords& w, int threads, const Progress& progress) {
    PictureComparisonOptions options;
    options.flip = !w.no_flip;
    options.flip_options = {w.pixels_per_degree};
    if (w.view_exposure != "auto") options.exposure_ev = *parse_number(w.view_exposure);
    options.threads = threads;
    options.progress = progress;
    return compare_pictures(pair, options);
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
            const auto& known = comparison_figures();
            if (std::find(known.begin(), known.end(), parts[0]) == known.end())
                return Error{fmt::format("no metric \"{}\"", parts[0]), option, "Accepted: " + join(known, ", ") + "."};
            limits.push_back({parts[0], *value, above});
        }
    return limits;
}

/// The limits that are not kept, as sentences.
Result<std::vector<std::string>> exceeded(const PictureComparison& c, const std::vector<Limit>& limits) {
    std::vector<std::string> found;
    for (const Limit& limit : limits) {
        const auto value = comparison_figure(c, limit.metric);
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

Result<void> write_pictures(const Comparison& c, const PictureWords& w, int threads) {
    if (!w.heat.empty()) {
        const std::string name = w.heat_of.empty() ? "auto" : w.heat_of;
        const auto map = difference_map(c.pair, c.result, name, threads);
        if (!map)
            return Error{"\"" + name + "\" is not known of these pictures", "--heat-of",
                         "z needs a variance layer, hdr-flip a picture of high dynamic range, both kinds of FLIP that "
                         "--no-flip is not given."};
        const auto picture = heat_picture(*map, c.pair.mask_view(), w.heat_max);
        if (auto ok = write_screen_picture(w.heat, picture.view()); !ok) return ok.error().at(w.heat);
    }
    if (w.sheet.empty()) return {};
    const auto sheet = comparison_sheet(c.pair, c.result, c.a, c.b, threads);
    if (auto ok = write_screen_picture(w.sheet, sheet.view()); !ok) return ok.error().at(w.sheet);
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

Json noise_json(const NoiseSummary& n) {
    return {{"values", n.values},
            {"without_noise", n.without_noise},
            {"mean_z", n.mean_z},
            {"chi2", n.chi2},
            {"share_above_2", n.share_above_2},
            {"total_z", n.total_z},
            {"mean_ratio", n.mean_ratio},
            {"mean_ratio_95", {n.ratio_low, n.ratio_high}}};
}

void print_json(const Comparison& c, const std::vector<std::string>& failures) {
    const PictureComparison& r = c.result;
    Json json{{"version", version()},
              {"kind", "comparison"},
              {"a", picture_json(c.a, c.pair.test)},
              {"b", picture_json(c.b, c.pair.reference)},
              {"errors", errors_json(r.errors, r.flip, r.hdr_flip)},
              {"exposure_ev", r.exposure_ev}};
    if (r.hdr_flip)
        json["hdr_flip_exposures"] = {{"start_ev", r.hdr.start}, {"stop_ev", r.hdr.stop}, {"count", r.hdr.count}};
    if (r.noise) json["noise"] = noise_json(*r.noise);
    json["objects"] = Json::array();
    for (const ObjectComparison& row : r.objects) {
        Json object{{"name", row.name}};
        object.update(errors_json(row.errors, row.flip, row.hdr_flip));
        json["objects"].push_back(object);
    }
    json["skipped_pixels"] = c.pair.left_out;
    json["failures"] = failures;
    json["warnings"] = with_options(c.warnings);
    print_document(json);
}

void print_noise(const NoiseSummary& n) {
    print("\n  noise, as the files state it ({} channel values)\n", n.values);
    print("    mean A / mean B      {:.6g}, 95 % within [{:.6g}, {:.6g}]\n", n.mean_ratio, n.ratio_low, n.ratio_high);
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

void print_objects(const std::vector<ObjectComparison>& objects) {
    constexpr std::size_t k_most = 60;
    std::size_t width = 12;
    for (const ObjectComparison& row : objects) width = std::max(width, std::min<std::size_t>(row.name.size(), 32));
    print("\n  {:<{}}  {:>9}  {:>10}  {:>9}  {:>11}  {:>7}  {:>7}  {:>8}\n", "object", width, "pixels", "RMSE",
          "relative", "tone-mapped", "SSIM", "FLIP", "A / B");
    std::vector<const ObjectComparison*> rows;
    for (const ObjectComparison& row : objects) rows.push_back(&row);
    std::stable_sort(rows.begin(), rows.end(), [](const ObjectComparison* a, const ObjectComparison* b) {
        return a->errors.pixels > b->errors.pixels;
    });
    for (std::size_t i = 0; i < std::min(rows.size(), k_most); ++i) {
        const ObjectComparison& row = *rows[i];
        const auto flip = row.hdr_flip ? row.hdr_flip : row.flip;
        print("  {:<{}}  {:>9}  {:>10.4g}  {:>7.3g} %  {:>11.4g}  {:>7.4f}  {:>7}  {:>8.5g}\n", printable(row.name, 32),
              width, row.errors.pixels, row.errors.rmse, 100 * row.errors.relative_rmse, row.errors.tone_mapped_rmse,
              row.errors.ssim, flip ? fmt::format("{:.4f}", *flip) : "-", row.errors.mean_ratio);
    }
    if (rows.size() > k_most) print("  ... and {} smaller ones (--json has all)\n", rows.size() - k_most);
}

void print_text(const Comparison& c, const PictureWords& w) {
    const auto picture = [](const char* letter, const std::string& name, const Picture& p, const char* role) {
        print("{}  {}: {}, {}{}\n", letter, name, p.format, size_text(p.rgb), role);
    };
    picture("A", c.a, c.pair.test, "");
    picture("B", c.b, c.pair.reference, ", the reference");
    const PictureComparison& r = c.result;
    const Errors& e = r.errors;
    print("\n  RMSE                   {:<12.6g}\n", e.rmse);
    print("  relative RMSE          {:<12}\n", e.relative_rmse <= 10
                                                   ? fmt::format("{:.4g} %", 100 * e.relative_rmse)
                                                   : fmt::format("{:.4g} times the RMS of B", e.relative_rmse));
    print("  tone-mapped RMSE       {:<12.6g} of L / (1 + L)\n", e.tone_mapped_rmse);
    print("  PSNR                   {:<12} of L / (1 + L), peak 1\n", fmt::format("{:.2f} dB", e.psnr));
    print("  SSIM                   {:<12.6g} of the luminance of L / (1 + L)\n", e.ssim);
    if (r.flip)
        print("  FLIP                   {:<12.6g} {}{:.1f} pixels a degree\n", *r.flip,
              c.pair.reference.high_dynamic_range ? fmt::format("at {:+.2f} EV, ", r.exposure_ev) : "",
              w.pixels_per_degree);
    if (r.hdr_flip)
        print("  HDR-FLIP               {:<12.6g} largest of {} exposures, {:+.1f} to {:+.1f} EV\n", *r.hdr_flip,
              r.hdr.count, r.hdr.start, r.hdr.stop);
    print("  mean A / mean B        {:<12.6g}\n", e.mean_ratio);
    print("  largest difference     {:<12.6g} at ({}, {})\n", e.largest, e.largest_x, e.largest_y);
    if (!c.pair.mask.empty())
        print("  pixels that count      {} of {}\n", e.pixels,
              std::int64_t(c.pair.test.rgb.width()) * c.pair.test.rgb.height());
    if (r.noise) print_noise(*r.noise);
    if (!r.objects.empty()) print_objects(r.objects);
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
    a.text("--layer-b", "NAME", w.layer_b, "OpenEXR: the layer of B (that of --layer)");
    a.integer("--level", "N", w.level, "textures: the level to compare (0)");
    a.text("--mask", "FILE", w.mask, "an image of the same size: only pixels above 0 count");
    a.text(
        "--objects", "FILE", w.objects,
        "an image of object indices, 0 for the background: PNG values 0 to 255, or an OpenEXR channel; the errors of "
        "each object are also printed (the channel \"object\" of B, otherwise that of A)");
    a.choice(
        "--variance", w.variance, {"pixel", "sample"},
        "whose variance the layer \"variance\" holds: that of the pixel's value, or that of one sample, which is then "
        "divided by the channel \"samples\" (pixel)");
    a.flag("--skip-bad", w.skip_bad, "ignore NaN and infinite pixels, which are otherwise an error");
    a.number("--pixels-per-degree", "P", w.pixels_per_degree,
             "viewing distance for FLIP, as pixels per degree, 1 to 1000 (67.02: 0.7 m from a 0.7 m wide display of "
             "3840 pixels)");
    a.flag("--no-flip", w.no_flip, "leave out FLIP and HDR-FLIP, which take most of the time");
    a.group("Two pictures: what is written");
    a.text("--heat", "FILE", w.heat, "a heat map with its scale, .png or .jpg");
    a.choice("--heat-of", w.heat_of, difference_maps(),
             "the metric of the heat map (auto: hdr-flip; flip for screen pictures; tone-mapped with --no-flip)");
    a.number("--heat-max", "X", w.heat_max,
             "the value at the upper end of the colour scale (both kinds of FLIP and 1 - SSIM: 1; z: 4; otherwise from "
             "the values)");
    a.text("--sheet", "FILE", w.sheet,
           "A, B, their signed difference and the map of --heat-of auto side by side, .png or .jpg");
    a.text("--view-exposure", "EV", w.view_exposure,
           "exposure in stops of both pictures in the sheet and for FLIP, -60 to 60; auto brings B's log-average "
           "luminance to 0.18, and is 0 for two screen pictures (auto)");
    a.texts("--fail-above", "METRIC=VALUE", w.fail_above,
            "exit with status 1 if a metric is above the value: " + join(comparison_figures(), ", ") +
                "; mean is |mean A / mean B - 1|; with z the difference over its standard error, above-2 is the share "
                "of |z| > 2 (0 to 1), chi2 the mean of z^2 and total-z |z| of the sums: these three need a layer "
                "\"variance\"");
    a.texts("--fail-below", "METRIC=VALUE", w.fail_below, "the same if psnr or ssim is below the value");
}

int compare_pictures(const std::string& a, const std::string& b, const PictureWords& w, const CommonOptions& common) {
    if (auto ok = check_words(w); !ok) return print_error(ok.error(), exit_usage);
    const auto limits = parse_limits(w);
    if (!limits) return print_error(limits.error(), exit_usage);
    std::vector<std::filesystem::path> inputs;
    for (const std::string& input : {a, b, w.mask, w.objects})
        if (!input.empty()) inputs.emplace_back(input);
    if (auto ok = check_output_places({w.heat, w.sheet}, inputs); !ok) return print_error(ok.error());
    const int threads = common.threads.value_or(0);
    auto read = read_all(a, b, w, threads);
    if (!read) return print_error(read.error(), exit_failed);
    Comparison& c = *read;
    {
        ProgressBar bar(b, common);
        c.result = compared(c.pair, w, threads, bar.callback());
    }
    const auto failures = exceeded(c.result, *limits);
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
