#include "compare/stored_bake.h"

#include "domelight/engines/engine.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/projection/projections.h"
#include "domelight/texture/texture.h"

#include "base/field_place.h"
#include "compare/latlong_level.h"
#include "compare/manifest_entry.h"
#include "io/environment/cube_texture_reader.h"
#include "io/environment/environment_files.h"
#include "io/file/file_reader.h"
#include "projection/convention_text.h"
#include "projection/latlong_convention.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <sstream>

namespace domelight {
namespace {

/// "0 0.25 0.5" or "0,0.25,0.5": one number from 0 to `most` a level, else nothing.
std::vector<double> numbers_in(std::string text, std::size_t count, double most) {
    std::replace(text.begin(), text.end(), ',', ' ');
    std::vector<double> values;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        double value = 0;
        const char* const end = word.data() + word.size();
        const auto [stop, code] = std::from_chars(word.data(), end, value);
        if (code != std::errc() || stop != end || !(value >= 0 && value <= most)) return {};
        values.push_back(value);
    }
    return values.size() == count ? values : std::vector<double>{};
}

/// Which lobe the levels were filtered with, and how wide it is in each, where the keys say so.
/// by   who wrote the keys, for the report
void read_keys(const std::map<std::string, std::string>& keys, const char* by, StoredBake& bake) {
    const auto value = [&](const char* name) {
        const auto key = keys.find(name);
        return key == keys.end() ? std::string() : key->second;
    };
    bake.lobe = from_name<Lobe>(value("domelight.lobe")).value_or(Lobe::ggx);
    bake.texels = from_name<Texels>(value("domelight.texels")).value_or(Texels::centre);
    const auto roughness = numbers_in(value("domelight.roughness"), bake.levels.size(), 1);
    const auto exponents =
        numbers_in(value("domelight.exponent"), bake.levels.size(), std::numeric_limits<double>::infinity());
    for (std::size_t l = 0; l < roughness.size(); ++l) bake.levels[l].roughness = roughness[l];
    for (std::size_t l = 0; l < exponents.size(); ++l) bake.levels[l].exponent = exponents[l];
    if (!roughness.empty() || !exponents.empty()) bake.stated_by = by;
}

bool states_filter(const std::map<std::string, std::string>& keys) {
    return keys.contains("domelight.roughness") || keys.contains("domelight.exponent");
}

std::optional<std::string> stated_projection(const std::optional<ManifestEntry>& entry) {
    return entry ? entry->projection() : std::nullopt;
}

/// The projection of a bake's lat-long file: by the manifest beside it, by its own key, or the default.
Projection latlong_of(const std::optional<ManifestEntry>& entry, const std::string& convention) {
    const auto stated = stated_projection(entry);
    return *projection_from_name(stated ? *stated : latlong_of_convention(convention).value_or("latlong"));
}

/// The levels of a lat-long texture, each as a cube.
Result<std::vector<Cubemap>> decode_latlongs(const Texture& texture, const std::optional<ManifestEntry>& entry,
                                             int threads) {
    if (texture.width != 2 * texture.height)
        return Error{fmt::format("{} x {} texels are not a cube, nor a lat-long map", texture.width, texture.height),
                     "", "Wanted is a specular cube or lat-long map, as a bake has it."};
    if (encoding_channels(texture.encoding) != 3)
        return Error{"texture has fewer than three channels: no colour", "", ""};
    const auto key = texture.metadata.find("domelight.convention");
    const Projection projection = latlong_of(entry, key == texture.metadata.end() ? "" : key->second);
    std::vector<Cubemap> cubes;
    for (int l = 0; l < int(texture.levels.size()); ++l)
        cubes.push_back(cube_of_latlong_level({projection, decode_texture(texture, l, 0)}, threads));
    return cubes;
}

Result<StoredBake> read_chain(const std::string& file, int threads) {
    const auto texture = read_texture(file);
    if (!texture) return texture.error().at(file);
    const auto entry = ManifestEntry::of(file);
    auto cubes = texture->faces == 1 ? decode_latlongs(*texture, entry, threads) : decode_cubes(*texture);
    if (!cubes) return cubes.error().at(file);
    const auto info = read_texture_info(file);
    StoredBake bake;
    bake.is_cube = texture->faces == 6;
    if (bake.is_cube && entry)
        if (const auto engine = find_engine(entry->engine()); engine && *engine != &engines().front())
            bake.engine = *engine;  // `generic` reads nothing
    bake.format = info ? fmt::format("{}, {}", info->container, info->format) : "texture";
    for (Cubemap& cube : *cubes) bake.levels.emplace_back().cube = std::move(cube);
    // DDS and .env have no place for keys.
    if (states_filter(texture->metadata))
        read_keys(texture->metadata, "the file", bake);
    else if (entry)
        read_keys(entry->filter(), "the manifest beside it", bake);
    return bake;
}

/// Whether a file begins as a texture does.
bool is_texture_file(const std::string& name) {
    const auto bytes = FileBytes::open(name, std::int64_t(1) << 31);
    return bytes && !texture_container((*bytes)->bytes()).empty();
}

/// A level that is a picture, as a cube.
Result<Cubemap> cube_of(const Environment& picture, const std::string& word, int threads) {
    if (picture.cube()) return *picture.cube();
    const auto image = picture.latlong();
    if (!image) return image.error().at(word);
    return cube_of_latlong_level({projection_from_name("latlong")->turned(picture.world_to_source), **image}, threads);
}

/// One level a word: a picture of a cube or in any other projection, or a folder of six faces.
Result<StoredBake> read_pictures(const std::vector<std::string>& words, int threads) {
    StoredBake bake;
    EnvironmentOptions options;
    options.threads = threads;
    for (const std::string& word : words) {
        const auto entry = ManifestEntry::of(word);
        if (entry && entry->is_atlas())
            return Error{"PlayCanvas's atlas cannot be audited: all its levels lie in one picture", word,
                         "Audit the bake of the same environment for another engine."};
        options.projection = stated_projection(entry).value_or("auto");
        const auto picture = open_environment(environment_files({word}), options);
        if (!picture) return picture.error();
        auto cube = cube_of(*picture, word, threads);
        if (!cube) return cube.error();
        bake.format = picture->format;
        bake.levels.emplace_back().cube = *std::move(cube);
    }
    return bake;
}

/// The level that an engine's shader reads for a roughness.
std::function<double(double)> curve_of(const Engine& engine, const StoredBake& bake) {
    return [&engine, count = int(bake.levels.size()), size = bake.levels[0].cube.size()](double roughness) {
        return level_of_roughness(engine, roughness, count, size);
    };
}

/// The same for the engine whose curve has the roughnesses that the file states.
std::function<double(double)> curve_of_stated(const StoredBake& bake) {
    std::vector<double> roughness;
    for (const CubeLevel& level : bake.levels) roughness.push_back(level.roughness.value_or(-1));
    const Engine* engine = engine_with_curve(roughness, bake.levels[0].cube.size());
    return engine ? curve_of(*engine, bake) : nullptr;
}

}  // namespace

Result<StoredBake> read_stored_bake(const std::vector<std::string>& files, const StoredBakeOptions& w) {
    const int threads = w.threads;
    auto bake =
        files.size() == 1 && is_texture_file(files[0]) ? read_chain(files[0], threads) : read_pictures(files, threads);
    if (bake) {
        bake->lobe = w.lobe.value_or(bake->lobe);
        bake->level_of = curve_of_stated(*bake);
    }
    if (!bake || w.engine.empty()) return bake;
    const auto engine = find_engine(w.engine);
    if (!engine) return engine.error();
    if (!(*engine)->roughness)
        return Error{w.engine + " filters by itself: it has no roughness curve", field_place("for"), ""};
    const int count = int(bake->levels.size());
    for (int l = 0; l < count; ++l)
        bake->levels[std::size_t(l)].roughness = (*engine)->roughness(l, count, bake->levels[0].cube.size());
    bake->stated_by = w.engine + "'s curve";
    if (bake->is_cube) bake->engine = *engine;
    bake->level_of = curve_of(**engine, *bake);
    return bake;
}

std::optional<bool> lies_as_read(const StoredBake& bake, const BakeAudit& audit) {
    if (!bake.engine || !audit.of_source || !audit.orientation.certain) return std::nullopt;
    // The engine looks up the light from d in the direction M d, where the bake holds ours of ours_from_theirs M d.
    const Mat3 seen = audit.orientation.ours_from_theirs * cube_mirror_matrix(bake.engine->mirror);
    if (seen == Mat3()) return true;
    const bool upright = seen.row[1] == Vec3d{0, 1, 0},
               mirrored = dot(cross(seen.row[0], seen.row[1]), seen.row[2]) < 0;
    if (upright && !mirrored) return std::nullopt;
    return false;
}

std::string convention_of(const Mat3& ours_from_theirs, const Mat3& world_to_source) {
    if (ours_from_theirs == Mat3()) return "";
    const Mat3 read = world_to_source * ours_from_theirs;
    for (const std::string& name : latlong_convention_names())
        if (const auto convention = latlong_convention(name); convention && convention->world_to_default() == read)
            return name;
    return "";
}

Result<std::optional<ReadErrors>> read_errors_of(const StoredBake& bake, const BakeAudit& audit,
                                                 const Environment& environment, int threads) {
    if (audit.orientation.error > AuditOptions{}.same) return std::optional<ReadErrors>();
    ReadChain chain;
    chain.lobe = bake.lobe;
    chain.level_of = bake.level_of;
    chain.map_from_world = audit.orientation.ours_from_theirs.transposed();
    for (std::size_t l = 0; l < bake.levels.size(); ++l) {
        chain.levels.emplace_back(bake.levels[l].cube);
        chain.roughness.push_back(bake.levels[l].roughness.value_or(audit.levels[l].roughness));
    }
    ReadErrorOptions options;
    options.threads = threads;
    auto errors = measure_as_read(chain, environment, options);
    if (!errors) return errors.error().at(field_place("as_read"));
    return std::optional(*std::move(errors));
}

}  // namespace domelight
