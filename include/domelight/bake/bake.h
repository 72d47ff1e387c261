#pragma once

#include "domelight/base/names.h"
#include "domelight/base/progress.h"
#include "domelight/base/result.h"
#include "domelight/compare/read_error.h"
#include "domelight/engines/engine.h"
#include "domelight/environment/environment.h"
#include "domelight/filtering/brdf/brdf_table.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/reference.h"
#include "domelight/image/repair_report.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/texture/texture.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// How the filtering is done: exactly, or by one of the plain methods of reference.h.
enum class BakeMethod { exact, bruteforce, riemann, montecarlo };
template <>
struct EnumNames<BakeMethod> {
    static constexpr const char* kind = "a method";
    static constexpr NamedValue<BakeMethod> table[] = {
        {BakeMethod::exact, "exact"},
        {BakeMethod::bruteforce, "bruteforce"},
        {BakeMethod::riemann, "riemann"},
        {BakeMethod::montecarlo, "montecarlo"},
    };
};

/// How cubes are laid out in .exr and .hdr files: one picture a level, or six.
enum class CubePicture { cross, strip, faces };
template <>
struct EnumNames<CubePicture> {
    static constexpr const char* kind = "a layout of a cube";
    static constexpr NamedValue<CubePicture> table[] = {
        {CubePicture::cross, "cross"},
        {CubePicture::strip, "strip"},
        {CubePicture::faces, "faces"},
    };
};

/// What to bake. Each engine has its own default for a field that is empty.
struct BakeOptions {
    std::vector<std::string> engines{"generic"};  ///< several engines share one reading of the environment
    std::optional<Layout> layout;                 ///< by default the engine's, which is mostly cube
    std::optional<int> size;                      ///< level 0: face size, or height of a lat-long map; 1 .. 16384
    std::optional<int> levels;
    std::vector<double> roughness;  ///< of each level, [0, 1]; empty: the engine's curve
    std::optional<Lobe> lobe;
    std::vector<double> exponents;  ///< Phong: of each level; infinity is the environment itself
    /// Of the specular chain and the sheen's: `read` needs cubes and the exact method, and is the default there. All else
    /// holds the value at each texel's centre.
    std::optional<Texels> texels;
    BakeMethod method = BakeMethod::exact;
    PointSet points;         ///< montecarlo: the sample points, 1 .. 2^24 of them, the same for every texel
    RiemannOptions riemann;  ///< 1 .. 65536 steps of each angle

    std::optional<Encoding> encoding;
    EncodingQuality encoding_quality = EncodingQuality::standard;
    std::optional<Container> format;
    std::optional<bool> zstd;
    CubePicture cube_picture = CubePicture::cross;
    /// Convention of every lat-long image that is written, with or without "latlong/" before it: default, usd, mitsuba,
    /// openexr, materialx, mod, or "centre=+X,right=+Z[,up=+Y]". By default the engine's own. An error for an engine
    /// whose bake has no lat-long image, or has one of a fixed convention.
    std::optional<std::string> latlong_out;
    std::optional<Quantity> irradiance_quantity;  ///< irradiance or irradiance_over_pi
    std::optional<int> irradiance_size;           ///< face size, or half the height of a lat-long map; 1 .. 4096
    int sh_bands = 3;                             ///< 1 .. 64
    ShWindow sh_window = ShWindow::none;
    BrdfG brdf_g = BrdfG::correlated;
    std::optional<BrdfForm> brdf_form;
    std::optional<int> brdf_size;  ///< width and height, 1 .. 4096
    bool brdf_float = false;       ///< the BRDF table in 32-bit floats instead of 16-bit ones

    /// Measures what a shader reads from the chains of GGX and Charlie (read_error.h), for the manifest.
    bool as_read = false;
    bool preview = true;  ///< preview.png
    bool hashes = true;   ///< SHA-256 of source and files in the manifest
    int threads = 0;
    Progress progress;

    /// For the manifest: the environment's files in the order to hash them (empty: Environment::file), and how it was
    /// opened.
    std::vector<std::filesystem::path> source_files;
    EnvironmentOptions environment;
};

/// A file that was written, relative to the bake's folder.
struct BakedFile {
    std::string file;
    std::string sha256;  ///< empty without hashes
};

struct BakedLevel {
    int level = 0;
    int size = 0;                     ///< of a cube's face, or the image's height
    int width = 0;                    ///< of a cube's face, or the image's width
    bool mirror = false;              ///< the environment itself
    double roughness = 0, alpha = 0;  ///< ggx and charlie
    double exponent = 0;              ///< phong
    std::vector<BakedFile> files;     ///< for containers that hold one image a level
    EncodingReport encoding;
};

/// The error of interpolating a Phong chain half way between two neighbouring levels: the mean of the two levels is
/// compared with a map that is filtered with `exponent`. Relative errors of the luminance (0.01 is 1 %), median and
/// maximum over the texels that are not black.
struct PhongGap {
    /// The geometric mean of the two levels' exponents. Where one of these is below 1, the exponent whose roughness is
    /// the mean of theirs, with roughness = (2 / (n + 2))^(1/4).
    double exponent = 0;
    double median_error = 0, worst_error = 0;
};

/// A map with its levels: specular, sheen, skybox or irradiance.
struct BakedMap {
    std::string role;
    Lobe lobe = Lobe::ggx;
    Quantity quantity = Quantity::radiance;
    Layout layout = Layout::cube;
    /// Of a map that is not a cube: the name and convention of its projection, as projections.h takes them:
    /// "latlong/usd". Empty for a cube.
    std::string projection;
    std::string encoding, container;
    bool widened = false;  ///< `encoding` is rgba32f, because halves, the default of OpenEXR files, would clip
    bool zstd = false;
    BakedFile file;  ///< for containers that hold the whole chain
    std::vector<BakedLevel> levels;
    /// Phong by the exact method: one for each pair of neighbouring levels, without the level that is the environment
    /// itself.
    std::vector<PhongGap> gaps;
    std::string level_text;  ///< the level that a shader reads for a roughness (Engine::level_text), or empty
    std::optional<ReadErrors> as_read;  ///< where BakeOptions::as_read asks for it
};

struct ShReport {
    int bands = 0;
    ShWindow window = ShWindow::none;
    std::vector<Vec3d> radiance;    ///< windowed
    std::vector<Vec3d> irradiance;  ///< E
    double rms_error = 0,
           max_error = 0;  ///< of E against the exact irradiance, relative; the maximum against max(E, 1 % of the mean)
    std::vector<BakedFile> files;
};

struct BrdfReport {
    BakedFile file;
    BrdfForm form = BrdfForm::none;
    BrdfG g = BrdfG::correlated;
    int size = 0;
    std::string encoding;
};

/// The contents of one engine's folder.
struct EngineReport {
    std::string name;
    std::filesystem::path folder;
    std::vector<BakedMap> maps;
    ShReport sh;
    BrdfReport brdf;
    std::optional<BakedFile> preview;
    std::string manifest;  ///< manifest.json's text
};

struct StageTime {
    std::string stage;
    double seconds = 0;      ///< wall-clock time
    double cpu_seconds = 0;  ///< CPU time of all threads together
};

struct BakeReport {
    std::vector<EngineReport> engines;
    std::string source_sha256;
    RepairReport repaired;
    Vec3d mean_radiance;
    /// Texels whose value came out negative because the expansion in harmonics is truncated; they were set to 0.
    std::int64_t clamped = 0;
    int band_limit = 0;
    std::vector<std::string> warnings;
    std::vector<StageTime> stages;
};

/// Checks whether the options are consistent, before anything is read. The error's `where` names the field.
Result<void> check_bake_options(const BakeOptions& options);

/// Bakes an environment into `folder`: specular chain, irradiance, harmonics, BRDF table, picture, manifest. With
/// several engines, each has a subfolder with its name. Everything is first written next to its final place and moved
/// there when all is complete, so an error changes nothing.
/// Errors: those of check_bake_options(), of reading the environment and of writing; `folder` is a file; "cancelled".
Result<BakeReport> bake(const Environment& environment, const BakeOptions& options,
                        const std::filesystem::path& folder);

/// Whether `folder` already holds exactly what a bake of these files with these options would write: the same version,
/// options and source hash, and every file with its hash.
bool bake_is_up_to_date(const std::vector<std::filesystem::path>& source_files, const BakeOptions& options,
                        const std::filesystem::path& folder);

}  // namespace domelight
