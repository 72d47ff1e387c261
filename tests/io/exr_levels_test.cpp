#include "domelight/bake/bake.h"
#include "domelight/image/row_source.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/write_image.h"
#include "domelight/projection/projections.h"

#include "oriented.h"
#include "test.h"

#include <ImfChannelList.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfStandardAttributes.h>
#include <ImfTiledInputFile.h>

using namespace domelight;
using namespace domelight::test;

namespace {

/// A level by OpenEXR's own reader.
ImageF read_level(const std::filesystem::path& file, int level) {
    Imf::TiledInputFile in(file.c_str());
    const int width = in.levelWidth(level), height = in.levelHeight(level);
    ImageF image(width, height, 3);
    Imf::FrameBuffer frame;
    const char* names[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c)
        frame.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(image.pixels().data() + c), 12,
                                          12 * std::size_t(width)));
    in.setFrameBuffer(frame);
    in.readTiles(0, in.numXTiles(level) - 1, 0, in.numYTiles(level) - 1, level);
    return image;
}

ImageF numbered(int width, int height, float first) {
    ImageF image(width, height, 3);
    for (float& v : image.pixels()) v = first++;
    return image;
}

}  // namespace

TEST_CASE("write_exr_levels: one level that halves would clip makes floats of all") {
    const TemporaryFolder folder;
    const std::vector<ImageF> levels{numbered(4, 2, 0), numbered(2, 1, 70000)};
    const auto channel_type = [&](std::size_t count) {
        const std::vector<ImageView<const float>> views(levels.begin(), levels.begin() + count);
        REQUIRE(write_exr_levels(folder / "a.exr", views));
        return Imf::TiledInputFile((folder / "a.exr").c_str()).header().channels().begin().channel().type;
    };
    CHECK(channel_type(1) == Imf::HALF);
    CHECK(channel_type(2) == Imf::FLOAT);
}

TEST_CASE("write_exr_levels: OpenEXR reads every level back, and the ones that were not given are averages") {
    const TemporaryFolder folder;
    const std::vector<ImageF> levels{numbered(80, 40, 0), numbered(40, 20, 7), numbered(20, 10, 3)};
    const std::vector<ImageView<const float>> views(levels.begin(), levels.end());
    ExrWriteOptions options;
    options.half = false;
    options.envmap = "latlong";
    options.attributes = {{"domelight.roughness", "0 0.5 1"}};
    REQUIRE(write_exr_levels(folder / "a.exr", views, options));
    {
        Imf::TiledInputFile in((folder / "a.exr").c_str());
        CHECK(in.levelMode() == Imf::MIPMAP_LEVELS);
        CHECK(in.numLevels() == 7);  // 80 40 20 10 5 2 1
        CHECK(Imf::envmap(in.header()) == Imf::ENVMAP_LATLONG);
        CHECK(in.isComplete());
    }
    for (int l = 0; l < 3; ++l) {
        const ImageF back = read_level(folder / "a.exr", l);
        CHECK(std::equal(back.pixels().begin(), back.pixels().end(), levels[std::size_t(l)].pixels().begin()));
    }
    const ImageF fourth = read_level(folder / "a.exr", 3);
    REQUIRE(fourth.width() == 10);
    const ImageF& third = levels[2];
    CHECK(fourth.at(4, 2)[1] == (third.at(8, 4)[1] + third.at(9, 4)[1] + third.at(8, 5)[1] + third.at(9, 5)[1]) / 4);
    const ImageF last = read_level(folder / "a.exr", 6);
    CHECK(last.width() == 1);
    double mean = 0;
    for (const float v : third.pixels()) mean += double(v) / double(third.pixels().size());
    CHECK(last.at(0, 0)[1] == doctest::Approx(mean).epsilon(0.15));  // at odd sizes the last texels have less weight
}

TEST_CASE("write_exr_levels: levels of other sizes are refused") {
    const TemporaryFolder folder;
    const std::vector<ImageF> levels{numbered(16, 8, 0), numbered(9, 4, 0)};
    const std::vector<ImageView<const float>> views(levels.begin(), levels.end());
    const auto written = write_exr_levels(folder / "a.exr", views);
    REQUIRE_FALSE(written);
    CHECK(written.error().what.find("level 1 is 9 x 4") != std::string::npos);
    CHECK_FALSE(write_exr_levels(folder / "a.exr", {}));
    CHECK_FALSE(std::filesystem::exists(folder / "a.exr"));
}

TEST_CASE("bake: exr-mip lies as OpenEXR's envmap says, in every level, and is read back so") {
    const TemporaryFolder folder;
    const ImageF image = direction_image(64);
    for (const Layout layout : {Layout::latlong, Layout::cube}) {
        Environment environment = environment_of(image);
        BakeOptions options;
        options.layout = layout;
        options.size = 32;
        options.levels = 3;
        options.roughness = {0, 0, 0};  // the environment at three sizes: every level shows it
        options.format = Container::exr_mip;
        options.irradiance_size = 8;
        options.preview = false;
        REQUIRE(bake(environment, options, folder.path()));
        const auto projection = *projection_from_name(layout == Layout::latlong ? "latlong/openexr" : "cube/openexr");
        if (layout == Layout::latlong)
            for (int l = 0; l < 3; ++l) {
                const ImageF level = read_level(folder / "specular.exr", l);
                double worst = 0;
                for (int y = 0; y < level.height(); ++y)
                    for (int x = 0; x < level.width(); ++x) {
                        const Vec3d d =
                            projection.direction(0, {x / (level.width() - 1.0), y / (level.height() - 1.0)});
                        worst = std::max(worst, length(direction_of(level.at(x, y)) - d));
                    }
                // Samples on the edges represent half texels, whose centres lie elsewhere.
                CHECK(worst < 4.0 / level.height());
            }
        const auto opened = open_environment({folder / "specular.exr"});
        REQUIRE(opened);
        if (layout == Layout::cube) {
            CHECK(worst_direction(*opened->cube(), [](const Vec3d& d) { return d; }) < 0.1);
        } else {
            const auto read = read_latlong(**opened->rows());
            REQUIRE(read);
            for (const Vec3d& d : {Vec3d{1, 0.2, 0.1}, Vec3d{-1, -0.5, 0.3}, Vec3d{0.1, 1, 1}, Vec3d{0.2, 0.3, -1}}) {
                const UV uv = latlong_uv(opened->world_to_source * d);
                CHECK(length(direction_of(texel_at(*read, uv.u, uv.v)) - normalize(d)) < 0.15);
            }
        }
    }
}
