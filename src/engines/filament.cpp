#include "engines/all.h"

namespace domelight {

/// Filament: KTX1 in R11F_G11F_B10F, {stem}_ibl.ktx from 256^2 to 16^2 and {stem}_skybox.ktx, nine SH numbers of E / pi
/// in the key "sh" and in sh.txt. Its shaders look along the world direction itself. cmgen takes the centre of a
/// lat-long image for +Z, where Domelight's default takes it for +X: the same file through cmgen is what `--latlong
/// usd` gives here. Filament brings its own BRDF table, so brdf.ktx2 (the form it uses, with multiple scattering) is
/// for comparison.
Target filament_target() {
    Target t;
    t.name = "filament";
    t.consumer = "Filament: KTX1 R11F_G11F_B10F (*_ibl.ktx, *_skybox.ktx) and sh.txt";
    t.note = "cmgen sees +Z in the centre of a lat-long image: --latlong usd gives its orientation";
    t.size = 256;
    t.smallest = 16;
    t.roughness = quadratic_roughness;
    t.encoding = Encoding::r11g11b10f;
    t.container = Container::ktx1;
    t.specular_file = "{stem}_ibl";
    t.skybox_file = "{stem}_skybox";
    t.irradiance_file = "";  // it lights with the harmonics
    t.brdf_form = BrdfForm::multiscatter;
    t.sh_text_file = "sh.txt";
    t.sh_metadata = true;
    return t;
}

}  // namespace domelight
