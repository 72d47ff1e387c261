#include "engines/all.h"

namespace domelight {

/// Filament: KTX1 in R11F_G11F_B10F, {stem}_ibl.ktx from 256^2 to 16^2 and {stem}_skybox.ktx, nine SH numbers of E / pi
/// in the key "sh" and in sh.txt. Its shaders look along the world direction itself. cmgen takes the centre of a
/// lat-long image for +Z, where Domelight's default takes it for +X: the same file through cmgen is what `--latlong
/// usd` gives here. Filament brings its own BRDF table, so brdf.ktx2 (the form it uses, with multiple scattering) is
/// for comparison.
Engine filament_engine() {
    Engine e;
    e.name = "filament";
    e.loads = "Filament: KTX1 R11F_G11F_B10F (*_ibl.ktx, *_skybox.ktx) and sh.txt";
    e.note = "cmgen sees +Z in the centre of a lat-long image: the convention usd has its orientation";
    e.size = 256;
    e.smallest = 16;
    e.roughness = quadratic_roughness;
    e.level_text = "M r (2 - r)";
    e.encoding = Encoding::r11g11b10f;
    e.container = Container::ktx1;
    e.specular_file = "{stem}_ibl";
    e.skybox_file = "{stem}_skybox";
    e.irradiance_file = "";  // it lights with the harmonics
    e.brdf_form = BrdfForm::multiscatter;
    e.sh_text_file = "sh.txt";
    e.sh_metadata = true;
    return e;
}

}  // namespace domelight
