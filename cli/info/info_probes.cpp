#include "cli/info/info_probes.h"

#include "domelight/base/version.h"
#include "domelight/probe/probe_check.h"

#include "cli/console/print.h"
#include "probe/probe_record.h"

#include <fmt/core.h>

#include <algorithm>

namespace domelight::cli {
namespace {

struct Counts {
    std::ptrdiff_t moved, invalid, with_walls;
};

Counts counts_of(const std::vector<Probe>& probes) {
    return {std::ranges::count_if(probes, [](const Probe& p) { return p.moved; }),
            std::ranges::count_if(probes, [](const Probe& p) { return !p.valid; }),
            std::ranges::count_if(probes, [](const Probe& p) { return p.proxy.has_value(); })};
}

/// The name of a source, which is empty where none was read.
std::string name_of_source(const ProbeSource& source, const char* otherwise) {
    return source.file.empty() ? otherwise : source.file;
}

Json document(const std::filesystem::path& folder, const ProbeSetRecord& r, const std::vector<std::string>& changes) {
    const Counts counts = counts_of(r.probes);
    Json json{{"version", version()},
              {"kind", "probes"},
              {"folder", folder.string()},
              {"probes", r.probes.size()},
              {"moved", counts.moved},
              {"invalid", counts.invalid},
              {"with_proxy", counts.with_walls},
              {"scene", r.scene.file},
              {"environment", r.environment.file},
              {"options", r.options},
              {"changes", changes}};
    json["grid"] = r.grid ? Json::array({r.grid->nx, r.grid->ny, r.grid->nz}) : Json(nullptr);
    return json;
}

void print_set(const std::filesystem::path& folder, const ProbeSetRecord& r) {
    const Counts counts = counts_of(r.probes);
    print("{}: {} probes of {} under {}, captured by domelight {}\n", folder.string(), r.probes.size(),
          name_of_source(r.scene, "a scene"), name_of_source(r.environment, "the built-in sky"), r.version);
    if (r.grid) print("  grid             {} x {} x {}\n", r.grid->nx, r.grid->ny, r.grid->nz);
    if (!r.tetrahedra.empty()) print("  tetrahedra       {}\n", r.tetrahedra.size());
    print("  moved            {}\n", counts.moved);
    print("  not valid        {}\n", counts.invalid);
    print("  with walls       {}\n", counts.with_walls);
    print("  specular         {}, {} x {} texels a face, {} levels of roughness 0 to {:.3g}\n", r.specular.encoding,
          r.specular.size, r.specular.size, r.roughness.size(), r.roughness.empty() ? 0 : r.roughness.back());
    print("  irradiance       {}, {} x {}\n", r.irradiance.encoding, r.irradiance.size, r.irradiance.size);
    if (r.distance)
        print("  distance         {}, {} x {}, up to {:.4g} m\n", r.distance->encoding, r.distance->size,
              r.distance->size, r.farthest);
}

}  // namespace

int info_probes(const std::filesystem::path& folder, const CommonOptions& options) {
    const auto record = read_probe_record(folder);
    if (!record) return print_error(record.error());
    const auto changes = check_probe_set(folder, {});
    if (!changes) return print_error(changes.error());
    if (options.json)
        print_document(document(folder, *record, *changes));
    else
        print_set(folder, *record);
    for (const std::string& change : *changes) print_error({change, folder.string(), "Capture it again."});
    return changes->empty() ? exit_done : exit_failed;
}

}  // namespace domelight::cli
