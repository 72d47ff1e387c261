#include "render/texture_lookup.h"

#include "image/srgb_curve.h"

#include <algorithm>
#include <cmath>

namespace domelight {
namespace {

/// 8-bit values as linear floats: sRGB's curve (IEC 61966-2-1), and v / 255.
struct Decoded {
    std::array<float, 256> srgb, linear;
    Decoded() {
        for (int i = 0; i < 256; ++i) {
            const double v = i / 255.0;
            linear[i] = float(v);
            srgb[i] = float(srgb_to_linear(v));
        }
    }
};
const Decoded k_decoded;

int wrap(int i, int n, SceneTexture::Wrap how) {
    if (how == SceneTexture::Wrap::clamp) return std::clamp(i, 0, n - 1);
    const int period = how == SceneTexture::Wrap::mirror ? 2 * n : n;
    i %= period;
    if (i < 0) i += period;
    return i < n ? i : period - 1 - i;
}

}  // namespace

Rgba look_up(const Scene& scene, const SceneTexture& t, const Mesh::TexCoord& uv, bool srgb) {
    if (!t) return {};
    const Rgba8Image& image = scene.images[t.image];
    if (image.width < 1 || image.height < 1) return {};
    // KHR_texture_transform: scaled, turned (counter-clockwise as seen with v down), moved.
    const float c = std::cos(t.rotation), s = std::sin(t.rotation), su = uv.u * t.scale_u, sv = uv.v * t.scale_v;
    float u = c * su + s * sv + t.offset_u, v = -s * su + c * sv + t.offset_v;
    if (!(std::abs(u) < 1e6f && std::abs(v) < 1e6f)) u = v = 0;
    const auto& colour = srgb ? k_decoded.srgb : k_decoded.linear;
    const auto texel = [&](int x, int y) {
        const std::uint8_t* p = image.rgba.data() + 4 * (std::size_t(wrap(y, image.height, t.wrap_v)) * image.width +
                                                         wrap(x, image.width, t.wrap_u));
        return Rgba{{colour[p[0]], colour[p[1]], colour[p[2]]}, k_decoded.linear[p[3]]};
    };
    const float x = u * float(image.width), y = v * float(image.height);
    if (t.nearest) return texel(int(std::floor(x)), int(std::floor(y)));
    const float fx = std::floor(x - 0.5f), fy = std::floor(y - 0.5f), a = x - 0.5f - fx, b = y - 0.5f - fy;
    const int ix = int(fx), iy = int(fy);
    const Rgba p = texel(ix, iy), q = texel(ix + 1, iy), r = texel(ix, iy + 1), w = texel(ix + 1, iy + 1);
    const auto mix = [](const Rgba& m, const Rgba& n, float k) {
        return Rgba{m.rgb + (n.rgb - m.rgb) * k, m.a + (n.a - m.a) * k};
    };
    return mix(mix(p, q, a), mix(r, w, a), b);
}

}  // namespace domelight
