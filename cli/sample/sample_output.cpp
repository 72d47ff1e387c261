#include "cli/sample/sample_output.h"

#include "domelight/base/version.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/write_image.h"
#include "domelight/texture/texture.h"

#include "bake/staging.h"
#include "cli/console/environment_options.h"
#include "io/file/json.h"
#include "io/file/printable.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <functional>
#include <iterator>
#include <system_error>

namespace domelight::cli {
namespace {

/// Takes pieces of text; returns false if one could not be written.
using Sink = std::function<bool(const std::string&)>;

// {} prints a float as the shortest text that is read back as the same float.
void add_csv(std::string& out, const LightSample& s) {
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{},{},{}\n", s.u, s.v, s.direction.x, s.direction.y,
                   s.direction.z, s.radiance.x, s.radiance.y, s.radiance.z, s.pdf_solid_angle);
}
void add_json(std::string& out, const LightSample& s) {
    fmt::format_to(std::back_inserter(out),
                   "    {{\"u\": {}, \"v\": {}, \"direction\": [{}, {}, {}], \"radiance\": [{}, {}, {}], "
                   "\"pdf_solid_angle\": {}}}",
                   s.u, s.v, s.direction.x, s.direction.y, s.direction.z, s.radiance.x, s.radiance.y, s.radiance.z,
                   s.pdf_solid_angle);
}

std::string json_head(const SampleWords& w, const EnvironmentSampler& sampler, int count) {
    const Json head{{"version", version()},
                    {"environment", w.environment_name()},
                    {"width", sampler.image().width},
                    {"height", sampler.image().height},
                    {"method", name_of(w.sampler.method)},
                    {"weight", name_of(w.sampler.weight)},
                    {"compensate", w.sampler.compensate},
                    {"uniform_share", w.sampler.uniform_share},
                    {"sequence", name_of(w.sequence)},
                    {"seed", w.seed_number},
                    {"count", count}};
    std::string text = escaped_json(head.dump(2));
    text.erase(text.rfind("\n}"));
    return text + ",\n  \"samples\": [\n";
}

/// Returns false if a write failed or the work was cancelled.
bool put_samples(const SampleWords& w, const EnvironmentSampler& sampler, bool json, const Sink& sink,
                 const Progress& progress) {
    const int count = w.count.value_or(1024);
    constexpr int block = 4096;
    std::string text = json ? json_head(w, sampler, count) : "u,v,x,y,z,r,g,b,pdf_solid_angle\n";
    for (int i = 0; i < count; ++i) {
        const LightSample s =
            sampler.sample(unit_point(w.sequence, w.seed_number, std::uint32_t(i), std::uint32_t(count)));
        if (json) {
            add_json(text, s);
            text += i + 1 < count ? ",\n" : "\n  ]\n}\n";
        } else {
            add_csv(text, s);
        }
        if ((i + 1) % block && i + 1 < count) continue;
        if (!sink(text) || (progress && !progress("draw", double(i + 1) / count))) return false;
        text.clear();
    }
    return true;
}

using Metadata = std::map<std::string, std::string>;

Result<void> write_table_exr(const std::filesystem::path& file, const ImageF& table, Metadata metadata, int threads) {
    ExrWriteOptions options;
    options.half = false;
    options.attributes = std::move(metadata);
    options.threads = threads;
    return write_exr(file, table.view(), options);
}

Result<void> write_table_ktx2(const std::filesystem::path& file, const ImageF& table, Encoding encoding,
                              Metadata metadata) {
    Texture texture = encode_table(table, encoding);
    texture.metadata = std::move(metadata);
    return write_ktx2(file, texture);
}

}  // namespace

Result<void> write_samples(const SampleWords& w, const EnvironmentSampler& sampler, const Progress& progress) {
    if (w.output.empty()) {
        const Sink sink = [](const std::string& text) {
            return std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
        };
        if (!put_samples(w, sampler, w.common.json, sink, progress))
            return Error{"results cannot be written", "stdout", ""};
        return {};
    }
    const bool json = lower_case_extension(w.output) == ".json";
    return write_file_atomically(w.output, [&](const std::filesystem::path& path) -> Result<void> {
        std::FILE* file = std::fopen(path.c_str(), "wb");
        bool fine = file != nullptr;
        int code = errno;
        if (file) {
            fine = put_samples(
                w, sampler, json,
                [&](const std::string& text) { return std::fwrite(text.data(), 1, text.size(), file) == text.size(); },
                progress);
            code = errno;
            if (std::fclose(file) != 0 && fine) {
                fine = false;
                code = errno;
            }
        }
        if (!fine) return Error{"cannot write it: " + std::generic_category().message(code), "", ""};
        return {};
    });
}

Result<SamplingTables> write_tables(const SampleWords& w, const EnvironmentSampler& sampler) {
    const SamplingTextures textures = sampling_textures(sampler);
    auto staging = Staging::open(w.tables, environment_files(w.inputs, w.environment));
    if (!staging) return staging.error();
    const std::map<std::string, std::string> notes{
        {"domelight.weight", name_of(w.sampler.weight)},
        {"domelight.compensation", fmt::format("{:.9g}", sampler.compensation())},
        {"domelight.total_average", fmt::format("{:.9g}", textures.total_average)},
        {"domelight.source", w.environment_name()}};
    const struct {
        std::string name;
        const char* quantity;
        const ImageF& table;
        Encoding encoding;
    } tables[] = {{"rows", "cumulative_share, pdf_uv", textures.rows, Encoding::rg32f},
                  {"columns", "cumulative_share, pdf_uv", textures.columns, Encoding::rg32f},
                  {"row_averages", "average_weight", textures.row_averages, Encoding::r32f}};
    SamplingTables written{.total_average = textures.total_average};
    for (const auto& [name, quantity, table, encoding] : tables) {
        auto metadata = notes;
        metadata["domelight.quantity"] = quantity;
        written.files.push_back(name + "." + name_of(w.tables_format));
        const auto path = staging->stage(written.files.back());
        const auto ok = w.tables_format == Container::exr
                            ? write_table_exr(path, table, std::move(metadata), w.threads())
                            : write_table_ktx2(path, table, encoding, std::move(metadata));
        if (!ok) return ok.error().at(w.tables);
    }
    if (auto ok = staging->commit(written.files.back()); !ok) return ok.error();
    return written;
}

}  // namespace domelight::cli
