#include "texture/texel_order.h"

#include "domelight/engines/engine.h"
#include "domelight/projection/projection.h"

#include "texture/chain_encoder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace domelight;

namespace {

FilteredMap counted(FilteredMap map) {
    for (std::size_t i = 0; i < map.pixels().size(); ++i) map.pixels()[i] = float(i);
    return map;
}

bool same_pixels(const FilteredMap& a, const FilteredMap& b) {
    return a.layout == b.layout && std::ranges::equal(a.pixels(), b.pixels());
}

}  // namespace

TEST_CASE("texel order: texture(cube, M d) of the mirrored cube is texture(cube, d), and twice is nothing") {
    for (const int size : {1, 4, 5})
        for (const CubeMirror mirror : {CubeMirror::x, CubeMirror::z, CubeMirror::swap_yz}) {
            const FilteredMap cube = counted(Cubemap(size));
            const TexelOrder order = TexelOrder::of_cube(cube_mirror_matrix(mirror));
            const FilteredMap mirrored = order.apply(cube);
            for (int f = 0; f < 6; ++f)
                for (int y = 0; y < size; ++y)
                    for (int x = 0; x < size; ++x) {
                        const Vec3d d = cube_direction(f, {(x + 0.5) / size, (y + 0.5) / size});
                        const CubePoint p = cube_point(mirror == CubeMirror::x   ? Vec3d{-d.x, d.y, d.z}
                                                       : mirror == CubeMirror::z ? Vec3d{d.x, d.y, -d.z}
                                                                                 : Vec3d{d.x, d.z, d.y});
                        CHECK(mirrored.face(p.face).at(int(p.uv.u * size), int(p.uv.v * size))[1] ==
                              cube.face(f).at(x, y)[1]);
                    }
            CHECK(same_pixels(order.apply(mirrored), cube));
        }
}

TEST_CASE("texel order: every exchange and negation of the axes, also those that are not their own inverse") {
    const FilteredMap cube = counted(Cubemap(3));
    const int permutations[][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& p : permutations)
        for (int signs = 0; signs < 8; ++signs) {
            const auto axis = [&](int i) {
                Vec3d a;
                (p[i] == 0 ? a.x : p[i] == 1 ? a.y : a.z) = signs >> i & 1 ? -1 : 1;
                return a;
            };
            const Mat3 lookup{{axis(0), axis(1), axis(2)}};
            const TexelOrder order = TexelOrder::of_cube(lookup);
            CHECK(order.keeps_places() == (lookup == Mat3()));
            const FilteredMap stored = order.apply(cube);
            int wrong = 0;
            for (int row = 0; row < 18; ++row)
                for (int x = 0; x < 3; ++x) {
                    const CubePoint at = cube_point(lookup * map_direction(Layout::cube, 3, 3, x, row));
                    wrong += stored.face(at.face).at(int(at.uv.u * 3), int(at.uv.v * 3))[0] != cube.image.at(x, row)[0];
                }
            CHECK(wrong == 0);
        }
}

TEST_CASE("texel order: quarter turns move a lat-long map's columns") {
    const FilteredMap map = counted({Layout::latlong, ImageF(8, 4, 3)});
    for (const int quarters : {-1, 0, 1, 2, 3}) {
        const FilteredMap turned = TexelOrder::of_latlong(quarters).apply(map);
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 8; ++x)
                CHECK(turned.image.at(x, y)[2] == map.image.at((x + 2 * quarters + 8) % 8, y)[2]);
    }
}

TEST_CASE("texel order: an encoder reads texels in an order as if the map had been copied in it") {
    const auto check = [](const FilteredMap& map, const TexelOrder& order) {
        const FilteredMap copy = order.apply(map);
        for (const Encoding encoding : {Encoding::rgba16f, Encoding::bc6h, Encoding::astc6x6_hdr}) {
            ChainEncoder direct({&map, 1}, encoding, {}, EncodingQuality::fast, order),
                copied({&copy, 1}, encoding, {}, EncodingQuality::fast);
            CHECK(encode_in_memory(direct, 2).levels == encode_in_memory(copied, 1).levels);
            const EncodingReport a = direct.reports()[0], b = copied.reports()[0];
            CHECK(a.clipped_texels == b.clipped_texels);
            CHECK(a.clipped_energy == b.clipped_energy);
            CHECK(a.rms_error == b.rms_error);
            CHECK(a.log_psnr == b.log_psnr);
        }
        CHECK(rgbe_reports({&map, 1}, order)[0].log_psnr == rgbe_reports({&copy, 1})[0].log_psnr);
    };
    FilteredMap cube = Cubemap(26);  // not whole blocks, and rows that are not a whole part of what is summed at once
    for (std::size_t i = 0; i < cube.pixels().size(); ++i) cube.pixels()[i] = 1 + std::sin(float(i) * 0.37f) * 0.9f;
    cube.pixels()[1000] = 1e6f;
    for (const CubeMirror mirror : {CubeMirror::x, CubeMirror::z, CubeMirror::swap_yz})
        check(cube, TexelOrder::of_cube(cube_mirror_matrix(mirror)));
    FilteredMap latlong(Layout::latlong, ImageF(52, 26, 3));
    std::copy_n(cube.pixels().begin(), latlong.pixels().size(), latlong.pixels().begin());
    for (int quarters = 1; quarters < 4; ++quarters) check(latlong, TexelOrder::of_latlong(quarters));
}
