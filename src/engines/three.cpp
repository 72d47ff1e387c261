#include "engines/all.h"

namespace domelight {

/// three.js (r187 on): a cube in UASTC HDR 4x4 with zstd, 512^2 in 7 levels down to 8^2, which KTX2Loader turns into
/// BC6H, ASTC HDR or half floats, whatever the GPU has; the page sets `texture.isPMREMTexture = true`. Read at level =
/// 6 r (2 - r); the diffuse light is the last level times pi. A cube that is uploaded is looked up at (-x, y, z).
/// Radiance above 65216, the most that UASTC HDR holds, is clipped: three.js' own filter clips at 65280.
Target three_target() {
    Target t;
    t.name = "three";
    t.consumer = "three.js: prefiltered cube in UASTC HDR with zstd, .pmrem.ktx2 (KTX2Loader)";
    t.note = "set texture.isPMREMTexture = true; versions before r187 want --for three-latlong";
    t.roughness = quadratic_roughness;
    t.mirror = CubeMirror::x;
    t.encoding = Encoding::uastc_hdr;
    t.zstd = true;
    t.specular_file = "{stem}.pmrem";
    t.irradiance_file = "";
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

/// three.js of any version: the environment as a lat-long half-float EXR in its own orientation (which is Domelight's
/// default), for its PMREM generator to filter. That generator makes cubes of a quarter of the width: 2048 x 1024 fills
/// its 512^2.
Target three_latlong_target() {
    Target t;
    t.name = "three-latlong";
    t.consumer = "three.js: lat-long EXR for its own filter (EXRLoader, PMREMGenerator)";
    t.note = "three.js filters this image itself";
    t.roughness = linear_roughness;
    t.container = Container::exr;
    t.environment_only = true;
    t.specular_file = "{stem}";
    t.irradiance_file = "";
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

}  // namespace domelight
