#include "io/exr/exr_layers.h"

#include "domelight/compare/picture_reader.h"

#include "test.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <cmath>
#include <limits>

using namespace domelight;

namespace {

constexpr int k_width = 6, k_height = 4;

/// A file in which channel c of the list has the value c + x / 10 + y.
std::filesystem::path write_layers(const std::filesystem::path& file, const std::vector<std::string>& names,
                                   Imath::Box2i data = {{0, 0}, {k_width - 1, k_height - 1}},
                                   const std::string& objects = "") {
    Imf::Header header(Imath::Box2i({0, 0}, {k_width - 1, k_height - 1}), data);
    if (!objects.empty()) header.insert("objects", Imf::StringAttribute(objects));
    Imf::FrameBuffer buffer;
    const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
    std::vector<std::vector<float>> values;
    for (std::size_t c = 0; c < names.size(); ++c) {
        header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        values.emplace_back();
        for (int y = data.min.y; y <= data.max.y; ++y)
            for (int x = data.min.x; x <= data.max.x; ++x) values.back().push_back(float(c) + float(x) / 10 + float(y));
    }
    for (std::size_t c = 0; c < names.size(); ++c)
        buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, values[c].data(), data.min, width, height));
    Imf::OutputFile out(file.c_str(), header);
    out.setFrameBuffer(buffer);
    out.writePixels(height);
    return file;
}

Picture read(const std::filesystem::path& file, const PictureOptions& options = {}) {
    auto picture = read_picture(file, options);
    REQUIRE_MESSAGE(bool(picture), (picture ? "" : picture.error().format()));
    return std::move(*picture);
}

}  // namespace

TEST_SUITE("io") {
    TEST_CASE(
        "read_picture: a layer is found by its name, by its last part, and a single channel stands for all three") {
        const test::TemporaryFolder folder;
        const auto file = write_layers(folder / "a.exr", {"R", "G", "B", "View.Combined.R", "View.Combined.G",
                                                          "View.Combined.B", "depth.Z", "N.X", "N.Y", "N.Z"});
        CHECK(read(file).rgb.at(2, 1)[2] == doctest::Approx(2 + 0.2 + 1));
        CHECK(read(file, {.layer = "View.Combined"}).rgb.at(2, 1)[0] == doctest::Approx(3 + 0.2 + 1));
        CHECK(read(file, {.layer = "Combined"}).rgb.at(5, 3)[1] == doctest::Approx(4 + 0.5 + 3));
        const Picture depth = read(file, {.layer = "depth"});
        CHECK(depth.rgb.at(1, 0)[0] == doctest::Approx(6.1f));
        CHECK(depth.rgb.at(1, 0)[2] == doctest::Approx(6.1f));
        CHECK(read(file, {.layer = "N"}).rgb.at(0, 0)[1] == doctest::Approx(8));
        const auto none = read_picture(file, {.layer = "diffuse"});
        REQUIRE_FALSE(bool(none));
        CHECK(none.error().hint.find("View.Combined") != std::string::npos);
    }

    TEST_CASE("read_picture: variance is that of the pixel, or of a sample over the channel samples") {
        const test::TemporaryFolder folder;
        const auto file =
            write_layers(folder / "a.exr", {"R", "G", "B", "variance.R", "variance.G", "variance.B", "samples"});
        CHECK(read(file, {.variance = "sample"}).variance.at(1, 2)[0] ==
              doctest::Approx((3 + 0.1 + 2) / (6 + 0.1 + 2)));
        CHECK(read(file).variance.at(1, 2)[0] == doctest::Approx(5.1));
        const auto without = write_layers(folder / "b.exr", {"R", "G", "B", "variance.R", "variance.G", "variance.B"});
        CHECK(read(without).variance.at(1, 2)[1] == doctest::Approx(6.1));
        CHECK_FALSE(read_picture(without, {.variance = "sample"}));
        CHECK(read(write_layers(folder / "c.exr", {"R", "G", "B"})).variance.empty());
    }

    TEST_CASE("read_picture: objects come with their names") {
        const test::TemporaryFolder folder;
        const Picture p = read(write_layers(folder / "a.exr", {"object", "R", "G", "B"},
                                            {{0, 0}, {k_width - 1, k_height - 1}}, "floor\nball\n"));
        REQUIRE_FALSE(p.objects.empty());
        CHECK(*p.objects.at(0, 1) == doctest::Approx(1));
        REQUIRE(p.object_names.size() == 2);
        CHECK(p.object_names[1] == "ball");
    }

    TEST_CASE("exr layers: a data window that sticks out, or leaves a rest, is put where it belongs") {
        const test::TemporaryFolder folder;
        const auto file = write_layers(folder / "a.exr", {"a.R", "a.G", "a.B"}, {{-2, 1}, {3, 7}});
        const Picture p = read(file, {.layer = "a"});
        CHECK(p.rgb.width() == k_width);
        CHECK(p.rgb.at(2, 3)[1] == doctest::Approx(1 + 0.2 + 3));
        CHECK(p.rgb.at(2, 0)[1] == 0);
        CHECK(p.rgb.at(4, 2)[1] == 0);
    }

    TEST_CASE("read_picture: truncated files and layers of other formats are errors") {
        const test::TemporaryFolder folder;
        const auto file = write_layers(folder / "a.exr", {"a.R", "a.G", "a.B"});
        std::filesystem::resize_file(file, std::filesystem::file_size(file) - 40);
        CHECK_FALSE(read_picture(file, {.layer = "a"}));
        CHECK_FALSE(read_picture(folder / "missing.exr"));
    }
}
