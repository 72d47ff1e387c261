// Files that other tools wrote: each is read right, or refused with one clear error.
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/texture/texture.h"

#include "test.h"

#include <string>

using namespace domelight;

namespace {

/// Opens the file as an environment and reads it to the end. Returns the text of the error, or "".
std::string outcome(const std::filesystem::path& file) {
    auto environment = open_environment({file});
    if (!environment) return environment.error().what;
    if (environment->cube()) return environment->cube()->empty() ? "nothing in it" : "";
    const auto image = read_latlong(**environment->rows());
    return image ? "" : image.error().what;
}

}  // namespace

TEST_CASE("others' files: what can be read is read, and the rest is refused by name") {
    struct File {
        const char *name, *error;  // "": read
    };
    constexpr File k_files[] = {
        {"env_projections/KernerEnvCube.exr", ""},
        {"env_projections/KernerEnvLatLong.exr", ""},
        {"env_projections/OrientationCube.exr", ""},
        {"env_projections/OrientationLatLong.exr", ""},
        {"env_projections/WavyLinesCube.exr", ""},
        {"env_projections/WavyLinesLatLong.exr", ""},
        {"env_projections/WavyLinesSphere.exr", "twice as wide as high"},
        {"env_projections/dxt1-cube-mips.dds", ""},
        {"env_projections/dxt10-r16f-cube.dds", "fewer than three channels"},
        {"env_projections/dxt10-bc7-cube-mips.dds", ""},
        {"env_projections/dxt10-r8snorm-cube-array.dds", "not a cube"},
        {"env_projections/Ryfjallet_cubemap_bc7.ktx2", ""},
        {"reference/symmetrical_garden/symmetrical_garden.env", ""},
        {"reference/symmetrical_garden/symmetrical_garden_1k.hdr", ""},
        {"reference/symmetrical_garden/symmetrical_garden_ibl.ktx", ""},
        {"reference/symmetrical_garden/symmetrical_garden_skybox.ktx", ""},
        {"reference/filament_default_env/RNF_default_env_ibl.ktx", ""},
        {"reference/filament_default_env/default_env_skybox.ktx", ""},
        {"reference/materialx_irradiance/san_giuseppe_bridge.hdr", ""},
        {"reference/materialx_irradiance/table_mountain_split.hdr", ""},
    };
    const auto folder = test::data_folder();
    if (!folder) {
        test::note_skip("DOMELIGHT_DATA is not set");
        return;
    }
    for (const File& file : k_files) {
        if (!std::filesystem::exists(*folder / file.name)) {
            test::note_skip("DOMELIGHT_DATA lacks a file that others wrote");
            continue;
        }
        const std::string text = outcome(*folder / file.name);
        INFO(file.name << ": " << text);
        CHECK((*file.error ? text.find(file.error) != text.npos : text.empty()));
    }
}
