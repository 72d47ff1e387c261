// Local reflections: a bake of each probe by itself, and a list of where they are.

#include "domelight/bake/bake.h"
#include "domelight/base/version.h"
#include "domelight/io/file/atomic_file.h"

#include "capture/engine_files/engine_writers.h"

#include <fmt/core.h>

namespace domelight {
namespace {

/// The bake of one probe in its own folder. Returns the files, relative to the set's folder.
Result<std::vector<std::string>> bake_probe(EngineFilesJob& job, int probe, const std::string& name) {
    BakeOptions options;
    options.engines = {job.engine};
    options.size = job.set.specular_size();
    options.preview = options.hashes = false;
    options.threads = job.options.threads;
    auto environment = Environment::from_cube(job.set.specular(probe, 0), {}, {}, job.options.threads);
    environment.file = "probe";  // for the names of files
    const auto baked = bake(environment, options, job.folder / name);
    if (!baked) return baked.error();
    std::vector<std::string> files;
    for (const BakedMap& map : baked->engines.front().maps) {
        if (!map.file.file.empty()) files.push_back(name + "/" + map.file.file);
        for (const BakedLevel& level : map.levels) {
            job.report.clipped_texels += level.encoding.clipped_texels;
            for (const BakedFile& file : level.files) files.push_back(name + "/" + file.file);
        }
    }
    return files;
}

Json probe_json(const Probe& probe, int number, const std::vector<std::string>& files) {
    Json json{{"probe", number},
              {"files", files},
              {"position", vector_json(probe.position)},
              {"influence", influence_json(probe.influence)}};
    if (probe.proxy) json["box"] = box_json(*probe.proxy);
    return json;
}

}  // namespace

Result<void> write_reflection_probes(EngineFilesJob& job) {
    const auto probes = job.set.probes();
    Json list = Json::array();
    for (std::size_t i = 0; i < probes.size(); ++i) {
        if (!probes[i].valid) continue;
        const auto files = bake_probe(job, int(i), fmt::format("{:04}", i));
        if (!files) return files.error();
        job.report.files.insert(job.report.files.end(), files->begin(), files->end());
        list.push_back(probe_json(probes[i], int(i), *files));
        if (job.options.progress && !job.options.progress("bake", double(i + 1) / double(probes.size())))
            return Error{"cancelled", "", ""};
    }
    if (list.empty()) return Error{"no probe of the set is valid", "", ""};
    const std::string text =
        Json{{"generator", fmt::format("domelight {}", version())}, {"engine", job.engine}, {"probes", list}}.dump(1) +
        "\n";
    job.report.files.push_back(k_probes_json);
    return write_file_atomically(job.folder / k_probes_json, text);
}

}  // namespace domelight
