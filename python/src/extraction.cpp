#include "extraction.h"

#include "domelight/filtering/resample/area_resample.h"
#include "domelight/sampling/light_extraction.h"

#include "environment.h"
#include "keywords.h"
#include "work.h"

namespace domelight::python {
namespace {

LightExtractionOptions options_of(const Keywords& words) {
    LightExtractionOptions options;
    words.read("max_lights", options.max_lights);
    words.read("least_share", options.least_share);
    words.read("least_contrast", options.least_contrast);
    words.read("largest_diameter_deg", options.largest_diameter_deg);
    words.read("merge_deg", options.merge_deg);
    words.read("threads", options.threads);
    value_of(check_light_extraction_options(options));
    return options;
}

struct Found {
    LightExtraction lights;
    Mat3 world_to_source;
};

/// A cube has no lat-long convention to keep: it becomes a lat-long map in the default one.
Found extract(const Environment& environment, const LightExtractionOptions& options) {
    if (const Cubemap* cube = environment.cube()) {
        const ImageF image =
            area_resample_cube_to_latlong(*cube, 2 * cube->size(), environment.world_to_source, options.threads);
        return {value_of(extract_lights(image.view(), options)), {}};
    }
    const auto image = value_of(environment.latlong());
    return {value_of(extract_lights(image->view(), options, environment.world_to_source)), environment.world_to_source};
}

nb::dict told(const ExtractedLight& light) {
    nb::dict told;
    told["direction"] = tuple_of(light.direction);
    told["angular_diameter_deg"] = light.angular_diameter_deg;
    told["resolved"] = light.resolved;
    told["irradiance"] = tuple_of(light.irradiance);
    told["mean_radiance"] = tuple_of(light.mean_radiance);
    told["colour"] = tuple_of(light.colour);
    told["share"] = light.share;
    told["contrast"] = light.contrast;
    told["texels"] = light.texels;
    return told;
}

nb::dict run(const Environment& environment, const nb::dict& dictionary) {
    const LightExtractionOptions options = options_of(Keywords(dictionary));
    Found found = run_work_for(nb::none(), [&](const Progress&) { return extract(environment, options); });
    nb::list lights;
    for (const ExtractedLight& light : found.lights.lights) lights.append(told(light));
    nb::dict all;
    all["lights"] = lights;
    all["unaccounted"] = found.lights.report.unaccounted;
    all["left_out"] = found.lights.report.left_out;
    all["texel_deg"] = found.lights.report.texel_deg;
    all["remainder"] = Environment::from_latlong(std::move(found.lights.remainder), found.world_to_source);
    return all;
}

}  // namespace

void declare_extraction(nb::module_& module) {
    module.def("lights", &run, nb::arg("environment"), nb::arg("options"));
}

}  // namespace domelight::python
