#include "domelight/bake/bake.h"

#include "domelight/bake/brdf_file.h"
#include "domelight/base/parallel.h"
#include "domelight/base/version.h"
#include "domelight/filtering/resample/reproject.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/write_image.h"

#include "bake/chain_as_read.h"
#include "bake/filter_job.h"
#include "bake/manifest.h"
#include "bake/outputs.h"
#include "bake/panorama.h"
#include "bake/phong_gaps.h"
#include "bake/plan.h"
#include "bake/preview_sheet.h"
#include "bake/sh_report.h"
#include "bake/staging.h"
#include "io/file/output_place.h"
#include "io/file/sha256.h"
#include "projection/convention_text.h"

#include <fmt/core.h>

#include <chrono>
#include <ctime>
#include <map>
#include <memory>

namespace domelight {
namespace {

/// Adds the time from its construction to its destruction to a stage.
class StageClock {
  public:
    StageClock(std::vector<StageTime>& stages, const char* stage) : stages_(stages), index_(index_of(stages, stage)) {}
    ~StageClock() {
        StageTime& s = stages_[index_];
        s.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        s.cpu_seconds += cpu_seconds() - cpu_;
    }

  private:
    /// Where the stage stands in the list. It is added at the start, because the end may be that of a lack of memory.
    static std::size_t index_of(std::vector<StageTime>& stages, const char* stage) {
        for (std::size_t i = 0; i < stages.size(); ++i)
            if (stages[i].stage == stage) return i;
        stages.push_back({stage, 0, 0});
        return stages.size() - 1;
    }
    static double cpu_seconds() {
        timespec t;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
        return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
    }
    std::vector<StageTime>& stages_;
    std::size_t index_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double cpu_ = cpu_seconds();
};

/// One number a level, in the text of a texture's key.
template <typename Number>
std::string per_level(const std::vector<LevelPlan>& levels, Number number) {
    std::string text;
    for (const LevelPlan& level : levels) text += fmt::format("{}{}", text.empty() ? "" : " ", number(level));
    return text;
}

/// In one line, for a file's metadata.
std::string map_convention(const EnginePlan& plan, const BakedMap& map) {
    const Engine& engine = *plan.engine;
    if (!map.projection.empty()) return projection_convention(map.projection);
    return fmt::format("texture(cube, {}) is the light from world direction {}, +Y up",
                       cube_mirror_direction(engine.mirror), engine.mirror == CubeMirror::none ? "d" : "(x, y, z)");
}

/// OpenEXR's envmap attribute for a projection: samples from edge to edge are OpenEXR's own.
std::string envmap_of(const std::string& projection) {
    const auto named = projection_from_name(projection);
    return named && named->grid() == SampleGrid::both_on_edges ? named->name() : "";
}

/// The metadata of a texture file, so that it can be used without the manifest.
std::map<std::string, std::string> map_metadata(const EnginePlan& plan, const BakedMap& map,
                                                const std::vector<LevelPlan>& levels) {
    std::map<std::string, std::string> metadata{{"domelight.version", version()},
                                                {"domelight.quantity", name_of(map.quantity)}};
    metadata["domelight.convention"] = map_convention(plan, map);
    if (map.quantity != Quantity::radiance) return metadata;
    metadata["domelight.lobe"] = name_of(map.lobe);
    if (plan.texels == Texels::read) metadata["domelight.texels"] = name_of(plan.texels);
    if (map.lobe == Lobe::ggx || map.lobe == Lobe::charlie) {
        metadata["domelight.roughness"] = per_level(levels, [](const LevelPlan& l) { return l.roughness; });
        metadata["domelight.alpha"] = per_level(levels, [](const LevelPlan& l) { return l.alpha; });
    } else {
        metadata["domelight.exponent"] = per_level(levels, [](const LevelPlan& l) { return l.exponent; });
    }
    return metadata;
}

std::vector<BakedLevel> baked_levels(const std::vector<LevelPlan>& plans, Layout layout) {
    std::vector<BakedLevel> levels;
    for (const LevelPlan& plan : plans) {
        BakedLevel level;
        level.level = int(levels.size());
        level.size = plan.spec.size;
        level.width = layout == Layout::cube ? plan.spec.size : 2 * plan.spec.size;
        level.mirror = plan.spec.mirror;
        level.roughness = plan.roughness;
        level.alpha = plan.alpha;
        level.exponent = plan.exponent;
        levels.push_back(level);
    }
    return levels;
}

/// Bakes one engine's folder, after the filtering.
class EngineBake {
  public:
    EngineBake(EngineReport& report, const EnginePlan& plan, const BakeOptions& options, const std::string& stem,
               Staging staging)
        : report_(report),
          plan_(plan),
          engine_(*plan.engine),
          options_(options),
          stem_(stem),
          staging_(std::move(staging)),
          background_(resolve_threads(options.threads)) {
        report_.maps.reserve(5);  // their addresses must last
        report_.sh.files.reserve(2);
    }

    /// Encodes and writes everything, or starts to do so.
    void start(const FilterJob::Maps& maps, const FilterResult& result, std::vector<StageTime>& stages) {
        const StageClock clock(stages, "encode");
        report_.sh = make_sh_report(result.sh, options_.sh_bands, options_.sh_window, *maps.irradiance_over_pi,
                                    options_.threads);
        report_.sh.files.reserve(2);
        write_light(maps);
        write_sh();
        write_brdf();
    }

    /// What a shader reads from the chains, where that is asked for.
    Result<void> measure(const FilterJob::Maps& maps, const Environment& environment, std::vector<StageTime>& stages) {
        if (!options_.as_read || engine_.environment_only) return {};
        const StageClock clock(stages, "as-read");
        ReadErrorOptions options;
        options.threads = options_.threads;
        for (BakedMap& map : report_.maps) {
            const bool sheen = map.role == "sheen";
            if ((map.role != "specular" && !sheen) || is_phong(map.lobe)) continue;
            const ReadChain chain = chain_as_read(plan_, map.lobe, sheen ? plan_.sheen : plan_.specular,
                                                  sheen ? maps.sheen : maps.specular, options_);
            auto errors = measure_as_read(chain, environment, options);
            if (!errors) return errors.error();
            map.as_read = *std::move(errors);
        }
        return {};
    }

    /// The picture, while the maps are being written.
    void draw(const FilterJob::Maps& maps, const std::string& title, std::vector<StageTime>& stages) {
        if (!options_.preview) return;
        const StageClock clock(stages, "preview");
        preview_ = draw_preview(plan_, maps, report_, title, brdf_, options_.threads);
        report_.preview = BakedFile{"preview.png", ""};
        const auto path = staging_.stage("preview.png");
        background_.start([this, path]() -> Result<void> {
            if (auto ok = write_png(path, preview_.view()); !ok) return ok;
            return hash_into(*report_.preview, path, options_.hashes);
        });
    }

    Result<void> finish_writing(std::vector<StageTime>& stages) {
        const StageClock clock(stages, "write");
        return background_.wait();
    }

    /// mean_radiance   of the source
    Result<void> commit(const SourceReport& source, const Vec3d& mean_radiance) {
        report_.manifest = manifest_json(report_, plan_, options_, source, mean_radiance);
        if (auto ok = write_text("manifest.json", report_.manifest); !ok) return ok;
        return staging_.commit("manifest.json");
    }

  private:
    void write_light(const FilterJob::Maps& maps) {
        if (engine_.environment_only) {
            write_panorama(engine_.specular_file, *maps.panorama);
        } else {
            write("specular", engine_.specular_file, plan_.lobe, Quantity::radiance, plan_.specular, maps.specular,
                  plan_.encoding, maps.irradiance_over_pi);
            report_.maps.front().gaps = phong_gaps(plan_.gap_probes, maps.gap_probes);
        }
        if (!plan_.sheen.empty())
            write("sheen", engine_.sheen_file, Lobe::charlie, Quantity::radiance, plan_.sheen, maps.sheen,
                  plan_.encoding);
        if (!engine_.skybox_file.empty() && plan_.specular.front().spec.mirror)
            write("skybox", engine_.skybox_file, plan_.lobe, Quantity::radiance, {plan_.specular.front()},
                  maps.specular.first(1), plan_.encoding);
        if (!engine_.irradiance_file.empty()) write_irradiance(*maps.irradiance_over_pi);
        if (!engine_.panorama_file.empty()) write_panorama(engine_.panorama_file, *maps.panorama);
    }

    void write_irradiance(const FilteredMap& over_pi) {
        FilteredMap map = over_pi;
        if (plan_.irradiance_quantity == Quantity::irradiance)
            for (float& value : map.pixels()) value = float(value * k_pi);
        LevelPlan level;
        level.spec.size = plan_.irradiance_size;
        const bool own_encoding = !options_.encoding && plan_.container == engine_.container;
        write("irradiance", engine_.irradiance_file, Lobe::ggx, plan_.irradiance_quantity, {level}, {&map, 1},
              own_encoding ? engine_.irradiance_encoding : plan_.encoding);
    }

    void write(const char* role, const std::string& name, Lobe lobe, Quantity quantity,
               const std::vector<LevelPlan>& levels, std::span<const FilteredMap> maps, Encoding encoding,
               const FilteredMap* irradiance_over_pi = nullptr) {
        BakedMap& map = report_.maps.emplace_back();
        map.role = role;
        map.lobe = lobe;
        map.quantity = quantity;
        map.layout = plan_.layout;
        if (map.layout == Layout::latlong) map.projection = plan_.projection;
        map.levels = baked_levels(levels, plan_.layout);
        if (quantity == Quantity::radiance && levels.size() > 1 && plan_.level_of && !is_phong(lobe))
            map.level_text = engine_.level_text;
        MapFormat format = map_format(name, encoding);
        format.order = plan_.order;
        format.envmap = envmap_of(plan_.projection);
        format.irradiance_over_pi = irradiance_over_pi;
        format.radiance_sh = report_.sh.radiance;
        format.metadata = map_metadata(plan_, map, levels);
        if (engine_.sh_metadata && map.role == "specular") format.metadata["sh"] = filament_sh_metadata(report_.sh);
        if (!plan_.reprojected) return write_map(map, maps, format, options_, staging_, background_);
        write_map(map, reprojected(maps), format, options_, staging_, background_);
    }

    /// The maps in the projection of the files.
    std::vector<FilteredMap> reprojected(std::span<const FilteredMap> maps) const {
        const Projection projection = *projection_from_name(plan_.projection);
        std::vector<FilteredMap> levels;
        for (const FilteredMap& map : maps) {
            const ProjectedImage source{*projection_from_name(name_of(map.layout)), map.image};
            levels.emplace_back(map.layout,
                                reproject(source, projection, map.width(), map.height(), options_.threads).pixels);
        }
        return levels;
    }

    /// The environment as one image, in the engine's projection.
    void write_panorama(const std::string& name, const FilteredMap& panorama) {
        BakedMap& map = report_.maps.emplace_back();
        map.role = "environment";
        map.layout = Layout::latlong;
        map.projection = plan_.panorama->projection;
        const std::vector<LevelPlan> level{LevelPlan{LevelSpec{plan_.panorama->height, true, {}}}};
        map.levels = baked_levels(level, Layout::latlong);
        map.levels.front().width = plan_.panorama->width;
        MapFormat format = map_format(name, engine_.environment_only ? plan_.encoding : Encoding::rgba16f);
        if (!engine_.environment_only) format.container = Container::exr;
        format.envmap = envmap_of(map.projection);
        format.metadata = map_metadata(plan_, map, level);
        write_map(map, {&panorama, 1}, format, options_, staging_, background_);
    }

    MapFormat map_format(const std::string& name, Encoding encoding) const {
        MapFormat format;
        format.encoding = encoding;
        format.widen_for_range = !options_.encoding;
        format.container = plan_.container;
        format.zstd = plan_.zstd;
        format.cube_picture = options_.cube_picture;
        format.name = expand_stem(name, stem_);
        return format;
    }

    void write_sh() {
        write_small(report_.sh.files, "sh.json", sh_json(report_.sh));
        if (!engine_.sh_text_file.empty())
            write_small(report_.sh.files, engine_.sh_text_file, filament_sh_text(report_.sh));
    }

    void write_small(std::vector<BakedFile>& files, const std::string& name, const std::string& text) {
        BakedFile& file = files.emplace_back();
        file.file = name;
        if (options_.hashes) file.sha256 = sha256({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
        background_.done(write_text(name, text));
    }

    Result<void> write_text(const std::string& name, const std::string& text) {
        return write_file_atomically(staging_.stage(name), text);
    }

    void write_brdf() {
        const BrdfFileOptions options = brdf_options();
        const ImageF table = brdf_table(options);
        brdf_ = options.form == BrdfForm::multiscatter ? brdf_table_multiscatter(table) : table;
        if (plan_.brdf_form == BrdfForm::none) return;
        BrdfReport& brdf = report_.brdf;
        brdf.form = plan_.brdf_form;
        brdf.g = options_.brdf_g;
        brdf.size = plan_.brdf_size;
        const Texture texture = brdf_texture(table, options);
        brdf.encoding = name_of(texture.encoding);
        brdf.file.file = fmt::format("{}.ktx2", engine_.brdf_file.empty() ? "brdf" : engine_.brdf_file);
        const auto path = staging_.stage(brdf.file.file);
        background_.done([&]() -> Result<void> {
            if (auto ok = write_ktx2(path, texture); !ok) return ok;
            return hash_into(brdf.file, path, options_.hashes);
        }());
    }

    BrdfFileOptions brdf_options() const {
        BrdfFileOptions o;
        o.form = plan_.brdf_form;
        o.size = plan_.brdf_size;
        o.g = options_.brdf_g;
        o.single_precision = options_.brdf_float;
        if (options_.method == BakeMethod::montecarlo) o.points = options_.points;
        o.threads = options_.threads;
        return o;
    }

    EngineReport& report_;
    const EnginePlan& plan_;
    const Engine& engine_;
    const BakeOptions& options_;
    const std::string& stem_;
    Staging staging_;
    ImageF brdf_;  ///< as it is stored, with a third channel in any case
    Image<std::uint8_t> preview_;
    Background background_;  // the last member: it waits for its tasks before the other members are destroyed
};

std::vector<std::filesystem::path> source_files(const Environment& environment, const BakeOptions& options) {
    if (!options.source_files.empty()) return options.source_files;
    if (environment.file.empty()) return {};
    return {environment.file};
}

SourceReport describe_source(const Environment& environment, const std::vector<std::filesystem::path>& files) {
    SourceReport source;
    for (const auto& file : files) {
        if (!source.file.empty()) source.file += ' ';
        source.file += file.filename().string();
    }
    if (files.empty()) source.file = fmt::format("built-in {}", environment.format);
    source.format = environment.format;
    source.layer = environment.layer;
    source.projection = environment.projection;
    source.width = environment.width;
    source.height = environment.height;
    return source;
}

/// The environment's name in file names: the name of its file without the extension.
std::string stem_of(const std::vector<std::filesystem::path>& files) {
    return files.empty() ? "sky" : files.front().stem().string();
}

std::filesystem::path engine_folder(const std::filesystem::path& folder, const BakeOptions& options,
                                    const Engine& engine) {
    return options.engines.size() > 1 ? folder / engine.name : folder;
}

void add_warnings(BakeReport& report, const Environment& environment, const BakeOptions& options) {
    report.warnings = report.repaired.lines();
    if (options.method != BakeMethod::exact && environment.cube())
        report.warnings.push_back(fmt::format(
            "`method` {} works on lat-long images: the cube was resampled to one first", name_of(options.method)));
    for (const EngineReport& engine : report.engines)
        for (const BakedMap& map : engine.maps)
            for (const BakedLevel& level : map.levels)
                if (level.encoding.clipped_texels)
                    report.warnings.push_back(fmt::format(
                        "{}: {} level {}: {} texels exceed what {} holds; {:.3g} % of the level's energy is lost",
                        engine.name, map.role, level.level, level.encoding.clipped_texels, map.encoding,
                        100 * level.encoding.clipped_energy));
}

}  // namespace

Result<BakeReport> bake(const Environment& environment, const BakeOptions& options,
                        const std::filesystem::path& folder) {
    auto plans = plan_bake(options, &environment);
    if (!plans) return plans.error();
    BakeReport report;
    for (const EnginePlan& plan : *plans)
        if (auto ok = check_output_folder(engine_folder(folder, options, *plan.engine)); !ok) return ok.error();
    const auto files = source_files(environment, options);
    SourceReport source = describe_source(environment, files);
    const std::string stem = stem_of(files);

    BackgroundTask<Result<std::string>> hashing;
    if (options.hashes && !files.empty())
        hashing = in_background<Result<std::string>>(
            [&] { return files == environment.files ? environment_sha256(environment) : sha256_files(files); });

    FilterJob job(*plans, environment, options);
    {
        const StageClock clock(report.stages, "filter");
        if (auto ok = job.run(environment, options); !ok) return ok.error().at(environment.file.string());
    }
    report.repaired = source.repaired = environment.report();
    report.mean_radiance = job.result(0).mean;
    report.clamped = job.clamped();
    report.band_limit = job.band_limit();

    report.engines.resize(plans->size());
    std::vector<std::unique_ptr<EngineBake>> bakes;
    for (std::size_t e = 0; e < plans->size(); ++e) {
        const EnginePlan& plan = (*plans)[e];
        report.engines[e].name = plan.engine->name;
        report.engines[e].folder = engine_folder(folder, options, *plan.engine);
        auto staging = Staging::open(report.engines[e].folder, environment.files);
        if (!staging) return staging.error();
        bakes.push_back(std::make_unique<EngineBake>(report.engines[e], plan, options, stem, *std::move(staging)));
        const FilterJob::Maps maps = job.maps(e);
        bakes[e]->start(maps, job.result(e), report.stages);
        bakes[e]->draw(maps, source.file, report.stages);
        if (auto ok = bakes[e]->measure(maps, environment, report.stages); !ok) return ok.error();
        if (auto ok = bakes[e]->finish_writing(report.stages); !ok) return ok.error();
    }
    {
        const StageClock clock(report.stages, "hash");
        auto hash = hashing.valid() ? hashing.get() : Result<std::string>(files.empty() ? job.rows_sha256() : "");
        if (!hash) return hash.error();
        source.sha256 = report.source_sha256 = *std::move(hash);
    }
    for (std::size_t e = 0; e < bakes.size(); ++e)
        if (auto ok = bakes[e]->commit(source, job.result(e).mean); !ok) return ok.error();
    add_warnings(report, environment, options);
    return report;
}

bool bake_is_up_to_date(const std::vector<std::filesystem::path>& files, const BakeOptions& options,
                        const std::filesystem::path& folder) {
    const auto plans = plan_bake(options, nullptr);
    if (!plans) return false;
    for (const EnginePlan& plan : *plans)
        if (!std::filesystem::exists(engine_folder(folder, options, *plan.engine) / "manifest.json")) return false;
    const auto hash = sha256_files(files);
    if (!hash) return false;
    for (const EnginePlan& plan : *plans)
        if (!manifest_matches(engine_folder(folder, options, *plan.engine), plan, options, *hash)) return false;
    return true;
}

}  // namespace domelight
