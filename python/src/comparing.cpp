#include "comparing.h"

#include "domelight/compare/bake_audit.h"
#include "domelight/compare/difference_map.h"
#include "domelight/compare/picture_comparison.h"
#include "domelight/compare/picture_reader.h"

#include "array_input.h"
#include "base/field_place.h"
#include "environment.h"
#include "io/picture/png_memory.h"
#include "keywords.h"
#include "maps.h"
#include "preview/tonemap.h"
#include "work.h"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>

#include <array>
#include <filesystem>

namespace domelight::python {
namespace {

/// Two pictures and what differs.
struct Comparison {
    PicturePair pair;
    PictureComparison result;
};

/// Bytes of a picture for a screen, decoded from sRGB.
void decode_bytes(ImageF& image) {
    std::array<float, 256> decode;
    for (int i = 0; i < 256; ++i) decode[std::size_t(i)] = srgb_decode(float(i) / 255);
    for (float& value : image.pixels()) value = decode[std::size_t(value)];
}

/// A picture from an array or a file.
Picture picture_of(nb::handle source, const char* keyword, const Keywords& words) {
    if (PyUnicode_Check(source.ptr())) {
        PictureOptions options;
        words.read("layer", options.layer);
        words.read("level", options.level);
        words.read("threads", options.threads);
        return value_of(read_picture(nb::cast<std::string>(source), options));
    }
    Picture picture;
    picture.format = "array";
    const auto pixels = ArrayPixels::borrow(source, 3, keyword, true);
    picture.rgb = pixels.copy();
    picture.high_dynamic_range = !pixels.holds_bytes();
    if (pixels.holds_bytes()) decode_bytes(picture.rgb);
    return picture;
}

void check_same_size(const ImageF& image, const ImageF& reference, const char* keyword) {
    if (image.width() != reference.width() || image.height() != reference.height())
        throw Failure({fmt::format("is {} x {}, but the reference is {} x {}", image.width(), image.height(),
                                   reference.width(), reference.height()),
                       field_place(keyword), "Pictures must be of one size to be compared pixel by pixel."});
}

void check_bad_pixels(PicturePair& pair, bool skip_bad) {
    for (const auto& [picture, keyword] : {std::pair(&pair.test, "test"), std::pair(&pair.reference, "reference")}) {
        const BadPixels bad = find_bad_pixels(picture->rgb.view(), pair.mask_view());
        if (bad.count > 0 && !skip_bad)
            throw Failure({fmt::format("{} pixel{} NaN or infinite, the first at row {}, column {}", bad.count,
                                       bad.count == 1 ? " is" : "s are", bad.y, bad.x),
                           field_place(keyword), "skip_bad=True leaves such pixels out."});
    }
    if (skip_bad) pair = without_bad_pixels(std::move(pair));
}

PicturePair pair_of(nb::handle test, nb::handle reference, const Keywords& words) {
    PicturePair pair;
    pair.test = picture_of(test, "test", words);
    pair.reference = picture_of(reference, "reference", words);
    check_same_size(pair.test.rgb, pair.reference.rgb, "test");
    const auto optional = [&](const char* keyword, int channels, ImageF& image) {
        if (!words.has(keyword)) return;
        image = ArrayPixels::borrow(words.find(keyword), channels, keyword).copy();
        check_same_size(image, pair.reference.rgb, keyword);
    };
    optional("mask", 1, pair.mask);
    optional("test_variance", 3, pair.test.variance);
    optional("reference_variance", 3, pair.reference.variance);
    bool skip_bad = false;
    words.read("skip_bad", skip_bad);
    check_bad_pixels(pair, skip_bad);
    return pair;
}

Comparison compare(nb::handle test, nb::handle reference, const nb::dict& dictionary, const nb::object& progress) {
    const Keywords words(dictionary);
    Comparison made{pair_of(test, reference, words), {}};
    PictureComparisonOptions options;
    words.read("flip", options.flip);
    words.read("pixels_per_degree", options.flip_options.pixels_per_degree);
    words.read("view_exposure", options.exposure_ev);
    words.read("threads", options.threads);
    if (!(options.flip_options.pixels_per_degree > 0))
        throw Failure({"is not above 0", field_place("pixels_per_degree"), ""});
    run_work(progress, [&](const Progress& report) {
        options.progress = report;
        made.result = compare_pictures(made.pair, options);
    });
    return made;
}

nb::object map_of_difference(const Comparison& comparison, const std::string& name) {
    auto map = run_work_for(nb::none(), [&](const Progress&) {
        return difference_map(comparison.pair, comparison.result, name);
    });
    if (!map) throw Failure(unknown_name(name, "a map of these pictures", difference_maps()).at(field_place("name")));
    return numpy_of(std::move(map->values));
}

nb::bytes sheet(const Comparison& comparison) {
    const auto picture = run_work_for(nb::none(), [&](const Progress&) {
        return comparison_sheet(comparison.pair, comparison.result, "test", "reference");
    });
    const PngBytes bytes = value_of(encode_png(picture.view()));
    return nb::bytes(bytes.data(), bytes.size());
}

nb::dict figures(const Comparison& comparison) {
    nb::dict all;
    for (const std::string& name : comparison_figures())
        if (const auto value = comparison_figure(comparison.result, name)) all[name.c_str()] = *value;
    all["mean-ratio"] = comparison.result.errors.mean_ratio;
    all["pixels"] = comparison.result.errors.pixels;
    return all;
}

/// FLIP of each pixel, or HDR-FLIP of radiance.
nb::object run_flip(nb::handle test, nb::handle reference, const nb::dict& dictionary) {
    const Keywords words(dictionary);
    bool hdr = true;
    FlipOptions options;
    int threads = 0;
    words.read("hdr", hdr);
    words.read("pixels_per_degree", options.pixels_per_degree);
    words.read("threads", threads);
    if (!(options.pixels_per_degree > 0)) throw Failure({"is not above 0", field_place("pixels_per_degree"), ""});
    const PicturePair pair = pair_of(test, reference, words);
    return numpy_of(run_work_for(nb::none(), [&](const Progress&) {
        return hdr ? hdr_flip(pair.test.rgb, pair.reference.rgb, options, threads).error
                   : flip(pair.test.rgb, pair.reference.rgb, options, threads);
    }));
}

nb::object number_or_none(const std::optional<double>& value) {
    return value ? nb::object(nb::cast(*value)) : nb::none();
}

nb::dict told(const LevelAudit& level) {
    nb::dict told;
    told["size"] = level.size;
    told["roughness"] = level.roughness_known ? nb::object(nb::cast(level.roughness)) : nb::none();
    told["exponent"] = number_or_none(level.exponent);
    told["roughness_within"] = level.roughness_within;
    told["scale"] = level.scale;
    told["energy"] = level.energy;
    told["error"] = level.error;
    told["relative_rmse"] = level.relative_rmse;
    told["largest"] = level.largest;
    told["stated_roughness"] = number_or_none(level.stated_roughness);
    told["stated_error"] = level.stated_error;
    told["stated_relative_rmse"] = level.stated_relative_rmse;
    return told;
}

nb::dict told(const BakeAudit& audit) {
    nb::list levels;
    for (const LevelAudit& level : audit.levels) levels.append(told(level));
    nb::dict all;
    all["levels"] = levels;
    all["orientation"] = audit.orientation.words;
    all["orientation_certain"] = audit.orientation.certain;
    all["ours_from_theirs"] = tuple_of(audit.orientation.ours_from_theirs);
    all["of_source"] = audit.of_source;
    all["within"] = audit.within;
    all["verdict"] = audit.verdict;
    all["notes"] = nb::list();
    for (const std::string& note : audit.notes) all["notes"].attr("append")(note);
    return all;
}

nb::dict run_audit(nb::handle arrays, const Environment& environment, const nb::dict& dictionary,
                   const nb::object& progress) {
    const Keywords words(dictionary);
    std::vector<FilteredMap> maps = maps_of(arrays, "levels");
    if (maps.front().layout != Layout::cube)
        throw Failure({"lat-long levels cannot be audited", field_place("levels"),
                       "Pass cubes, of shape (6, size, size, 3)."});
    std::vector<double> roughness, exponents;
    AuditOptions options;
    words.read("roughness", roughness);
    words.read("exponents", exponents);
    words.read("lobe", options.lobe);
    words.read("texels", options.texels_hold);
    words.read("within", options.within);
    words.read("threads", options.threads);
    for (const auto& [list, keyword] : {std::pair(&roughness, "roughness"), std::pair(&exponents, "exponents")})
        if (!list->empty() && list->size() != maps.size())
            throw Failure({fmt::format("{} values for {} levels", list->size(), maps.size()), field_place(keyword), ""});
    std::vector<CubeLevel> levels(maps.size());
    for (std::size_t l = 0; l < maps.size(); ++l) {
        levels[l].cube = std::move(maps[l]).cube();
        if (!roughness.empty()) levels[l].roughness = roughness[l];
        if (!exponents.empty()) levels[l].exponent = exponents[l];
    }
    return told(run_work_for(progress, [&](const Progress& report) {
        options.progress = report;
        return value_of(audit_bake(levels, environment, options));
    }));
}

}  // namespace

void declare_comparing(nb::module_& module) {
    nb::class_<Comparison>(module, "Comparison")
        .def("figures", &figures)
        .def("map", &map_of_difference, nb::arg("name"))
        .def("sheet", &sheet);
    module.def("compare", &compare, nb::arg("test").none(), nb::arg("reference").none(), nb::arg("options"),
               nb::arg("progress") = nb::none());
    module.def("flip", &run_flip, nb::arg("test").none(), nb::arg("reference").none(), nb::arg("options"));
    module.def("audit", &run_audit, nb::arg("levels"), nb::arg("environment"), nb::arg("options"),
               nb::arg("progress") = nb::none());
}

}  // namespace domelight::python
