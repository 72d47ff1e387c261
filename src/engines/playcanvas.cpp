#include "engines/all.h"

#include <algorithm>

namespace domelight {
namespace {

/// PlayCanvas reads level = 5 roughness: level l shows roughness l / 5. (Its own tool stores 0.18, 0.36, 0.55, 0.73,
/// 0.91 and 1 in levels 1 to 6.) Level 6 is never reached.
double playcanvas_roughness(int level, int, int) {
    return std::min(1.0, level / 5.0);
}

}  // namespace

/// PlayCanvas: envAtlas, one PNG of 512^2 in RGBP with lat-long maps for mirrors, six for rougher surfaces and one of
/// E / pi (src/texture/container/playcanvas_atlas.h). It looks up u = 1/2 + atan2(-x, z) / 2 pi: centre +Z, right -X.
Target playcanvas_target() {
    Target t;
    t.name = "playcanvas";
    t.consumer = "PlayCanvas: envAtlas, a 512^2 RGBP PNG (scene.envAtlas)";
    t.note = "level l holds roughness l / 5, which is what PlayCanvas reads there";
    t.size = 256;
    t.smallest = 8;
    t.roughness = playcanvas_roughness;
    t.layout = Layout::latlong;
    t.latlong = "usd";
    t.encoding = Encoding::rgbp;
    t.container = Container::playcanvas_atlas;
    t.specular_file = "{stem}-env-atlas";
    t.irradiance_file = "";  // in the atlas
    t.irradiance_size = 32;
    t.irradiance_quantity = Quantity::irradiance_over_pi;
    t.brdf_file = "";
    t.brdf_form = BrdfForm::none;
    return t;
}

}  // namespace domelight
