#include "engines/all.h"

#include <algorithm>

namespace domelight {
namespace {

/// PlayCanvas reads level = 5 roughness: level l shows roughness l / 5. (Its own tool stores 0.18, 0.36, 0.55, 0.73,
/// 0.91 and 1 in levels 1 to 6.) Level 6 is never reached.
double playcanvas_roughness(double level, int, int) {
    return std::min(1.0, level / 5.0);
}

}  // namespace

/// PlayCanvas: envAtlas, one PNG of 512^2 in RGBP with lat-long maps for mirrors, six for rougher surfaces and one of
/// E / pi (src/texture/container/playcanvas_atlas.h). It looks up u = 1/2 + atan2(-x, z) / 2 pi: centre +Z, right -X.
Engine playcanvas_engine() {
    Engine e;
    e.name = "playcanvas";
    e.loads = "PlayCanvas: envAtlas, a 512^2 RGBP PNG (scene.envAtlas)";
    e.note = "level l holds roughness l / 5, which is what PlayCanvas reads there";
    e.size = 256;
    e.smallest = 8;
    e.roughness = playcanvas_roughness;
    e.level_text = "5 r";
    e.layout = Layout::latlong;
    e.latlong = "usd";
    e.encoding = Encoding::rgbp;
    e.container = Container::playcanvas_atlas;
    e.specular_file = "{stem}-env-atlas";
    e.irradiance_file = "";  // in the atlas
    e.irradiance_size = 32;
    e.irradiance_quantity = Quantity::irradiance_over_pi;
    e.brdf_file = "";
    e.brdf_form = BrdfForm::none;
    return e;
}

}  // namespace domelight
