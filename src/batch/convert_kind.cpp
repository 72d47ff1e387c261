// Jobs that convert an environment to another projection, convention, size or format.
#include "domelight/io/environment/convert.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"
#include "domelight/projection/projections.h"

#include "batch/job_kind.h"
#include "batch/option_reader.h"
#include "convert/converted_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace domelight {
namespace {

struct ConvertJob {
    std::string format = "exr", to, mirror;
    std::vector<std::array<double, 4>> rotations;
    std::optional<int> size;
    bool sharp = false;
    std::optional<Tonemap> tonemap;
    std::optional<double> ev;
    ConvertOutput output;
    EnvironmentOptions environment;
};

/// "rotate": [x, y, z, degrees], or several of them.
void read_rotations(OptionReader& reader, const Json& json, ConvertJob& job) {
    std::vector<double> numbers;
    const Json* value = json.find("rotate");
    if (value && value->is_array() && !value->empty() && value->elements()[0].is_array()) {
        for (const Json& turn : value->elements())
            for (const Json& number : turn.elements())
                numbers.push_back(number.is_number() ? number.get<double>() : std::nan(""));
        reader.know("rotate");
    } else {
        reader.read("rotate", numbers);
    }
    if (numbers.size() % 4 != 0)
        return reader.fail({"is not four numbers", field_place("rotate"), "An axis and degrees: [0, 0, 1, 90]."});
    for (std::size_t i = 0; i + 3 < numbers.size(); i += 4)
        job.rotations.push_back({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]});
}

Result<ConvertJob> options_of(const Json& json) {
    OptionReader reader(json);
    ConvertJob job;
    reader.read("format", job.format);
    reader.read("to", job.to);
    reader.read("size", job.size);
    reader.read("sharp", job.sharp);
    reader.read("layout", job.output.layout);
    reader.read("encoding", job.output.encoding);
    read_rotations(reader, json, job);
    reader.read("mirror", job.mirror);
    reader.read("tonemap", job.tonemap);
    reader.read("ev", job.ev);
    read_environment_options(reader, job.environment);
    if (auto ok = reader.finish(); !ok) return ok.error();
    if (job.size && (*job.size < 1 || *job.size > 32768))
        return Error{fmt::format("{} is not from 1 to 32768", *job.size), field_place("size"), ""};
    job.output.file = "x." + job.format;
    if (job.to.empty()) job.to = has_texture_ending(job.output.file) ? "cube" : "latlong";
    const auto target = projection_from_name(job.to);
    if (!target) return target.error().at(field_place("to"));
    if (auto ok = check_converted_files(job.output, *target); !ok) {
        Error error = ok.error();
        if (error.where == "OUT") error.where = field_place("format");
        return error;
    }
    if (auto turn = light_turn(job.rotations, job.mirror); !turn) return turn.error();
    return job;
}

std::string file_name(const Json& json, const std::string& name) {
    const auto job = options_of(json);
    return with_ending(name, "." + (job ? job->format : "exr"));
}

JobEstimate estimate(const Json& json, std::span<const InputFacts> inputs) {
    const auto job = options_of(json);
    std::int64_t in = 0;
    for (const InputFacts& input : inputs) in += input.texels();
    const auto target = job ? projection_from_name(job->to) : projection_from_name("latlong");
    const double height = job && job->size ? *job->size : std::sqrt(double(in) / 2) / (target->charts() > 1 ? 2 : 1);
    const double out = height * height * target->shape().aspect() * target->charts();
    // From rows to a cube or lat-long map, the source is not in memory; otherwise it is, several times.
    const bool streams = job && !job->sharp && (target->name() == "cube" || target->name() == "latlong");
    return {0.02 + 0.04e-6 * double(in) + (streams ? 0.2e-6 : 1.5e-6) * out,
            (std::int64_t(20) << 20) + std::int64_t(double(in) * (streams ? 4 : 28) + out * 28)};
}

/// How a picture for a screen shows it: an 8-bit source as it is, radiance tone mapped.
Display display_for(const ConvertJob& job, const Environment& environment, const ProjectedImage& image) {
    const bool for_screen = environment.format == "PNG" || environment.format == "JPEG";
    const bool as_it_is = for_screen || job.environment.exposure != 0;
    const double ev = job.ev ? *job.ev : as_it_is ? 0 : automatic_ev_of_sphere(image);
    return {job.tonemap.value_or(for_screen ? Tonemap::none : Tonemap::agx), float(std::exp2(ev))};
}

Result<JobReport> run(const JobCall& call) {
    auto job = options_of(call.options);
    if (!job) return job.error();
    job->environment.threads = job->output.threads = call.threads;
    const auto environment = open_environment(call.files("environment"), job->environment);
    if (!environment) return environment.error();
    const Projection target = *projection_from_name(job->to);
    const auto size = chart_size(target, job->size.value_or(matched_height(*environment, target)));
    if (!size) return size.error();
    ConvertOptions options{*light_turn(job->rotations, job->mirror), size->first, size->second, job->sharp,
                           call.threads};
    const auto made = convert(*environment, target, options);
    if (!made) return made.error();
    job->output.file = (call.folder / call.name).string();
    if (is_screen_picture(job->output.file)) job->output.display = display_for(*job, *environment, made->image);
    const auto written = write_projected(made->image, job->output);
    if (!written) return written.error();

    JobReport report;
    note_repairs(*environment, report);
    if (written->encoding.clipped_texels > 0)
        report.warnings.push_back(fmt::format("{} clips {} texels and {:.3g} % of the power", written->encoding_name,
                                              written->encoding.clipped_texels,
                                              100 * written->encoding.clipped_energy));
    if (!target.full())
        report.warnings.push_back(fmt::format("{} shows {:.0f} % of all directions: the rest is lost", target.name(),
                                              25 * target.shape().coverage() / k_pi));
    const double before = luminance(made->power_before), after = luminance(made->power_after);
    report.error = before > 0 ? std::abs(after / before - 1) : 0;
    report.error_of = "relative change of the radiant power";
    report.preview = std::filesystem::path(written->files.front()).filename().string();
    return report;
}

}  // namespace

JobKind convert_kind() {
    return {.name = "convert",
            .does = "converts an environment to another projection, size or format, as `domelight convert` does",
            .roles = {"environment"},
            .makes_folder = false,
            .file_name = file_name,
            .check = check_options<options_of>,
            .estimate = estimate,
            .run = run};
}

}  // namespace domelight
