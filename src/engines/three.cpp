#include "engines/all.h"
#include "engines/environment_engine.h"

namespace domelight {

/// three.js (r187 on): a cube in UASTC HDR 4x4 with zstd, 512^2 in 7 levels down to 8^2, which KTX2Loader turns into
/// BC6H, ASTC HDR or half floats, whatever the GPU has; the page sets `texture.isPMREMTexture = true`. Read at level =
/// 6 r (2 - r); the diffuse light is the last level times pi. A cube that is uploaded is looked up at (-x, y, z).
/// Radiance above 65216, the most that UASTC HDR holds, is clipped: three.js' own filter clips at 65280.
Engine three_engine() {
    Engine e;
    e.name = "three";
    e.loads = "three.js: prefiltered cube in UASTC HDR with zstd, .pmrem.ktx2 (KTX2Loader)";
    e.note = "set texture.isPMREMTexture = true; versions before r187 want the engine three-latlong";
    e.roughness = quadratic_roughness;
    e.level_text = "M r (2 - r)";
    e.mirror = CubeMirror::x;
    e.encoding = Encoding::uastc_hdr;
    e.zstd = true;
    e.specular_file = "{stem}.pmrem";
    e.irradiance_file = "";
    e.brdf_file = "";
    e.brdf_form = BrdfForm::none;
    return e;
}

/// three.js of any version: the environment as a lat-long half-float EXR in its own orientation (which is Domelight's
/// default), for its PMREM generator to filter. That generator makes cubes of a quarter of the width: 2048 x 1024 fills
/// its 512^2.
Engine three_latlong_engine() {
    Engine e = environment_engine("three-latlong",
                                  "three.js: lat-long EXR for its own filter (EXRLoader, PMREMGenerator)", "latlong");
    e.note = "three.js filters this image itself";
    e.size = 512;
    return e;
}

}  // namespace domelight
