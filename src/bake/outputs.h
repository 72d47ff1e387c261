#pragma once

#include "domelight/bake/bake.h"

#include "bake/plan.h"
#include "bake/staging.h"
#include "base/background_task.h"
#include "texture/texel_order.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// Writing and hashing in the background of a bake. With one thread each task runs immediately.
class Background {
  public:
    explicit Background(int threads) : at_once_(threads == 1) {}
    ~Background() { (void)!wait(); }
    /// `task` must own everything that it uses, unless that exists until wait() returns.
    void start(std::function<Result<void>()> task);
    /// Counts finished work among the tasks, so that its error is reported in order.
    void done(Result<void> result);
    /// Waits for all tasks; their first error in the order they were started.
    Result<void> wait();

  private:
    bool at_once_;
    std::vector<BackgroundTask<Result<void>>> tasks_;
};

/// How one map is stored.
struct MapFormat {
    Encoding encoding = Encoding::rgba16f;
    /// In OpenEXR: 32-bit floats instead of halves where halves would clip a level (fits_half()).
    bool widen_for_range = false;
    Container container = Container::ktx2;
    bool zstd = false;
    CubePicture cube_picture = CubePicture::cross;
    TexelOrder order;    ///< from the maps to the file
    std::string envmap;  ///< OpenEXR's attribute: "latlong" or "cube"; empty: none
    std::string name;    ///< without extension
    std::map<std::string, std::string> metadata;
    /// For containers that also hold diffuse light: radiance coefficients, and E / pi as a map.
    std::span<const Vec3d> radiance_sh = {};
    const FilteredMap* irradiance_over_pi = nullptr;
};

/// Encodes a map's levels now and writes them, or starts to do so. Fills in `report`, whose role, lobe, quantity,
/// layout and levels (one for each of `levels`) are set; its file names are valid at once, its hashes after
/// `background.wait()`. `report` must not be moved until then.
void write_map(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
               const BakeOptions& options, Staging& staging, Background& background);

/// What encoding did to each level goes into the report.
void take_reports(BakedMap& report, const std::vector<EncodingReport>& encoded);

/// Encodes a map's levels in memory, and fills in the report of each. The texture has no metadata.
Texture encode_chain(BakedMap& report, std::span<const FilteredMap> levels, const MapFormat& format,
                     const BakeOptions& options);

/// The file's name and, unless hashes are off, its hash.
Result<void> hash_into(BakedFile& file, const std::filesystem::path& written, bool hashes);

/// "shiny.min/{stem}_ibl" with the environment's name put in.
std::string expand_stem(std::string name, const std::string& stem);

}  // namespace domelight
