#include "cli/probes/probes_engines.h"

#include "domelight/base/version.h"
#include "domelight/capture/engine_files.h"

#include "cli/console/field_options.h"
#include "cli/console/print.h"
#include "probe/probe_record.h"

#include <fmt/core.h>

namespace domelight::cli {
namespace {

namespace fs = std::filesystem;

void print_report(const ProbesWords& w, const std::string& engine, const fs::path& folder,
                  const EngineFilesReport& report) {
    if (report.clipped_texels > 0)
        print_warnings({fmt::format("{} texels are brighter than the files for {} can hold and were clipped",
                                    report.clipped_texels, engine)},
                       w.common, folder.string());
    if (w.common.json || w.common.quiet) return;
    print("{}: {} files for {}\n", folder.string(), report.files.size(), engine);
}

Json report_json(const std::string& engine, const fs::path& folder, const EngineFilesReport& report) {
    return {{"engine", engine},
            {"folder", folder.string()},
            {"files", report.files},
            {"clipped_texels", report.clipped_texels}};
}

}  // namespace

bool names_a_set(const ProbesWords& w) {
    std::error_code ignored;
    return w.scenes.size() == 1 && fs::exists(fs::path(w.scenes.front()) / k_probes_json, ignored);
}

Result<void> check_engine_words(const ProbesWords& w, const Arguments& a) {
    if (w.engines.empty())
        return Error{"is missing", "--for",
                     fmt::format("{} is a set of probes: say which engine to write it for.", w.scenes.front())};
    if (w.output.empty()) return Error{"is missing", "--output", "Say where the files go: -o three."};
    for (const char* option :
         {"--env", "--grid", "--density", "--at", "--region", "--size", "--spp", "--bounces", "--encoding", "--levels"})
        if (a.given(option)) return Error{"is for capturing a scene, and a set of probes was given", option, ""};
    return {};
}

int write_for_engines(const ProbesWords& w, const fs::path& set_folder, const fs::path& folder) {
    const auto set = ProbeSet::load(set_folder);
    if (!set) return print_error(set.error());
    const bool folder_each = w.engines.size() > 1 || folder == set_folder;
    EngineFilesOptions options;
    options.threads = w.threads();
    const auto record = read_probe_record(set_folder);
    if (!record) return print_error(record.error());
    for (const std::string& file : files_of(*record)) options.inputs.push_back(set_folder / file);
    Json document = Json::array();
    for (const std::string& engine : w.engines) {
        const fs::path place = folder_each ? folder / engine : folder;
        Result<EngineFilesReport> report = Error{};
        {
            ProgressBar bar(place.string(), w.common);
            options.progress = bar.callback();
            report = write_engine_files(*set, engine, place, options);
        }
        if (!report) return print_error(with_options(report.error()));
        print_report(w, engine, place, *report);
        document.push_back(report_json(engine, place, *report));
    }
    if (w.common.json && set_folder != folder) print_document({{"version", version()}, {"engines", document}});
    return exit_done;
}

}  // namespace domelight::cli
