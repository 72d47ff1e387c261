#include "io/exr/exr_channels.h"

#include "domelight/compare/picture_reader.h"
#include "domelight/io/environment/open_environment.h"

#include "io/reader_samples.h"
#include "test.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>

using namespace domelight;
using namespace domelight::test;

namespace {

constexpr int k_width = 8, k_height = 4;

struct Part {
    std::string name, view;
    std::vector<std::string> channels;
    bool deep = false;
};

void write_flat(Imf::MultiPartOutputFile& file, int p, const std::vector<std::string>& channels, float first) {
    std::vector<std::vector<float>> values;
    for (std::size_t c = 0; c < channels.size(); ++c)
        values.emplace_back(std::size_t(k_width) * k_height, first + float(c));
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < channels.size(); ++c)
        buffer.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, values[c].data(), {0, 0}, k_width, k_height));
    Imf::OutputPart part(file, p);
    part.setFrameBuffer(buffer);
    part.writePixels(k_height);
}

/// A deep image without samples.
void write_deep(Imf::MultiPartOutputFile& file, int p, const std::vector<std::string>& channels) {
    std::vector<unsigned> counts(std::size_t(k_width) * k_height);
    std::vector<float*> pointers(counts.size());
    Imf::DeepFrameBuffer buffer;
    buffer.insertSampleCountSlice(
        Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned), k_width * sizeof(unsigned)));
    for (const std::string& name : channels)
        buffer.insert(name, Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(pointers.data()), sizeof(float*),
                                           k_width * sizeof(float*), sizeof(float)));
    Imf::DeepScanLineOutputPart part(file, p);
    part.setFrameBuffer(buffer);
    part.writePixels(k_height);
}

/// Channel c (in the order given) of part p is 10 p + c + 1 everywhere.
std::filesystem::path write_parts(const std::filesystem::path& file, const std::vector<Part>& parts) {
    std::vector<Imf::Header> headers;
    for (const Part& part : parts) {
        Imf::Header& header = headers.emplace_back(k_width, k_height);
        header.compression() = Imf::ZIPS_COMPRESSION;
        header.setType(part.deep ? Imf::DEEPSCANLINE : Imf::SCANLINEIMAGE);
        header.setName(part.name);
        if (!part.view.empty()) header.setView(part.view);
        for (const std::string& name : part.channels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    }
    Imf::MultiPartOutputFile out(file.c_str(), headers.data(), int(headers.size()));
    for (int p = 0; p < int(parts.size()); ++p) {
        const Part& part = parts[std::size_t(p)];
        part.deep ? write_deep(out, p, part.channels) : write_flat(out, p, part.channels, float(10 * p + 1));
    }
    return file;
}

struct Read {
    std::string layer;
    std::array<float, 3> rgb;
    std::size_t warnings;
    bool operator==(const Read&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Read& r) {
    return out << '"' << r.layer << "\" " << r.rgb[0] << ' ' << r.rgb[1] << ' ' << r.rgb[2] << ", " << r.warnings
               << " warnings";
}

/// What the file is read as, or the error in place of the layer.
Read read(const std::filesystem::path& file, const std::string& layer = "") {
    const auto reader = open_bytes(load(file), {.layer = layer});
    if (!reader) return {"error: " + reader.error().format(), {}, 0};
    const auto image = read_all(**reader);
    REQUIRE_MESSAGE(image, image.error().format());
    const float* p = image->at(k_width - 1, k_height - 1);
    return {(*reader)->facts().layer, {p[0], p[1], p[2]}, (*reader)->facts().warnings.size()};
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("exr channels: the picture is the unnamed layer, else the one named as it, else the only one with colour") {
    const TemporaryFolder folder;
    const auto of = [&](const std::vector<std::string>& channels, const std::string& layer = "") {
        return read(write_parts(folder / "a.exr", {{"", "", channels}}), layer);
    };
    CHECK(of({"AO.R", "AO.G", "AO.B", "R", "G", "B"}) == Read{"", {4, 5, 6}, 0});
    CHECK(of({"View Layer.AO.R", "View Layer.AO.G", "View Layer.AO.B", "View Layer.Combined.R", "View Layer.Combined.G",
              "View Layer.Combined.B"}) == Read{"View Layer.Combined", {4, 5, 6}, 1});
    CHECK(of({"a.R", "a.G", "a.B", "BEAUTY.R", "BEAUTY.G", "BEAUTY.B"}) == Read{"BEAUTY", {4, 5, 6}, 1});
    CHECK(of({"beauty.R", "beauty.G", "beauty.B", "rgba.R", "rgba.G", "rgba.B"}) == Read{"rgba", {4, 5, 6}, 1});
    CHECK(of({"depth.Z", "light.R", "light.G", "light.B"}) == Read{"light", {2, 3, 4}, 1});
    CHECK(of({"samples.Y", "light.R", "light.G", "light.B"}) == Read{"light", {2, 3, 4}, 1});
    // The second axis of a vector is no luminance, but luminance may come with a depth.
    CHECK(of({"N.X", "N.Y", "N.Z", "light.R", "light.G", "light.B"}) == Read{"light", {4, 5, 6}, 1});
    CHECK(contains(of({"N.X", "N.Y", "N.Z"}).layer, "no colour channels"));
    CHECK(of({"Y", "Z"}) == Read{"", {1, 1, 1}, 0});
    // Nobody can know which of these is meant.
    const Read none = of({"sky.R", "sky.G", "sky.B", "sun.R", "sun.G", "sun.B", "N.X", "N.Y", "N.Z"});
    CHECK(contains(none.layer, "sky, sun"));
    CHECK_FALSE(contains(none.layer, "N"));
    CHECK(contains(
        of({"a.Combined.R", "a.Combined.G", "a.Combined.B", "b.Combined.R", "b.Combined.G", "b.Combined.B"}).layer,
        "a.Combined, b.Combined"));
}

TEST_CASE("exr channels: small letters and words name colours too") {
    const TemporaryFolder folder;
    const auto of = [&](const std::vector<std::string>& channels) {
        return read(write_parts(folder / "a.exr", {{"", "", channels}}));
    };
    CHECK(of({"r", "g", "b"}) == Read{"", {1, 2, 3}, 0});
    CHECK(of({"red", "green", "blue"}) == Read{"", {1, 2, 3}, 0});
    CHECK(of({"Red", "Green", "Blue"}) == Read{"", {1, 2, 3}, 0});
    CHECK(of({"beauty.red", "beauty.green", "beauty.blue"}) == Read{"beauty", {1, 2, 3}, 0});
    CHECK(contains(of({"r", "g"}).layer, "no colour channels"));
}

TEST_CASE("exr channels: a layer is named in any case, by its end, by a channel, and its numbers need be no colours") {
    const TemporaryFolder folder;
    const auto file = write_parts(
        folder / "a.exr",
        {{"", "", {"R", "G", "B", "V.Diffuse.R", "V.Diffuse.G", "V.Diffuse.B", "N.X", "N.Y", "N.Z", "depth.Z"}}});
    CHECK(read(file, "V.Diffuse") == Read{"V.Diffuse", {4, 5, 6}, 0});
    CHECK(read(file, "diffuse") == Read{"V.Diffuse", {4, 5, 6}, 0});
    CHECK(read(file, "N") == Read{"N", {7, 8, 9}, 0});
    CHECK(read(file, "N.Y") == Read{"N", {8, 8, 8}, 0});
    CHECK(read(file, "depth") == Read{"depth", {10, 10, 10}, 0});
    CHECK(read(file, "G") == Read{"", {2, 2, 2}, 0});
    const Read none = read(file, "specular");
    CHECK(contains(none.layer, "no layer specular"));
    CHECK(contains(none.layer, "(unnamed), N, V.Diffuse, depth"));
    // Environments and pictures take the same.
    CHECK(read_picture(file, {.layer = "diffuse"})->rgb.at(0, 0)[0] == 4);
    const auto environment = open_environment({file}, {.layer = "diffuse"});
    REQUIRE_MESSAGE(environment, environment.error().format());
    CHECK(environment->layer == "V.Diffuse");
    CHECK((*environment->latlong())->at(0, 0)[0] == 4);
    save(folder / "a.hdr", hdr_header("-Y 1 +X 2"));
    const auto other = open_environment({folder / "a.hdr"}, {.layer = "diffuse"});
    REQUIRE_FALSE(other);
    CHECK(contains(other.error().what, "only OpenEXR files have layers"));
}

TEST_CASE("exr channels: parts are found by their names and numbers") {
    const TemporaryFolder folder;
    const auto file = write_parts(folder / "a.exr", {{"depth", "", {"Z"}},
                                                     {"albedo", "", {"R", "G", "B"}},
                                                     {"RGBA", "", {"R", "G", "B", "A"}},
                                                     {"V.Emit", "", {"V.Emit.R", "V.Emit.G", "V.Emit.B"}}});
    CHECK(read(file) == Read{"RGBA", {21, 22, 23}, 1});
    CHECK(read(file, "albedo") == Read{"albedo", {11, 12, 13}, 0});
    CHECK(read(file, "1") == Read{"albedo", {11, 12, 13}, 0});
    CHECK(read(file, "0") == Read{"depth", {1, 1, 1}, 0});
    CHECK(read(file, "V.Emit") == Read{"V.Emit", {31, 32, 33}, 0});
    CHECK(contains(read(file, "4").layer, "no part 4: the file has 4"));
    const auto unclear = write_parts(folder / "b.exr", {{"sky", "", {"R", "G", "B"}}, {"sun", "", {"R", "G", "B"}}});
    CHECK(contains(read(unclear).layer, "sky, sun"));
    CHECK(read(unclear, "SUN") == Read{"sun", {11, 12, 13}, 0});
}

TEST_CASE("exr channels: of two views the first is read, and either by its name") {
    const TemporaryFolder folder;
    const auto layers =
        write_parts(folder / "a.exr", {{"", "", {"left.R", "left.G", "left.B", "right.R", "right.G", "right.B"}}});
    CHECK(read(layers) == Read{"left", {1, 2, 3}, 1});
    CHECK(read(layers, "right") == Read{"right", {4, 5, 6}, 0});
    const auto hero = write_parts(folder / "b.exr", {{"", "", {"R", "G", "B", "right.R", "right.G", "right.B"}}});
    CHECK(read(hero) == Read{"", {1, 2, 3}, 0});
    const auto parts = write_parts(
        folder / "c.exr",
        {{"depth.one", "one", {"Z"}}, {"rgba.one", "one", {"R", "G", "B"}}, {"rgba.two", "two", {"R", "G", "B"}}});
    CHECK(read(parts) == Read{"rgba.one", {11, 12, 13}, 1});
    CHECK(read(parts, "rgba.two") == Read{"rgba.two", {21, 22, 23}, 0});
    CHECK(read(parts, "two") == Read{"rgba.two", {21, 22, 23}, 0});
}

TEST_CASE("exr channels: deep parts are passed over, and refused where they are asked for or all there is") {
    const TemporaryFolder folder;
    const auto file =
        write_parts(folder / "a.exr", {{"cloud", "", {"R", "G", "B"}, true}, {"rgba", "", {"R", "G", "B"}}});
    CHECK(read(file).rgb == std::array<float, 3>{11, 12, 13});
    CHECK(contains(read(file, "cloud").layer, "cloud is deep"));
    CHECK(contains(read(file, "0").layer, "cloud is deep"));
    const auto deep = write_parts(folder / "b.exr", {{"cloud", "", {"R", "G", "B"}, true}});
    CHECK(contains(read(deep).layer, "deep images cannot be read"));
    const auto depth = write_parts(folder / "c.exr", {{"cloud", "", {"R", "G", "B"}, true}, {"depth", "", {"Z"}}});
    CHECK(contains(read(depth).layer, "deep parts cannot be read"));
}

TEST_CASE("exr channels: renders with layers, and with other names for colours, read as the light that they hold") {
    DOMELIGHT_DATA_FILE(right, "reports/e_ok.exr");
    const auto expected = open_environment({right});
    REQUIRE(expected);
    for (const char* name : {"e_aov.exr", "e_normal.exr", "e_lower.exr", "e_words.exr"}) {
        CAPTURE(name);
        const auto environment = open_environment({right.parent_path() / name});
        REQUIRE_MESSAGE(environment, environment.error().format());
        CHECK(same_pixels(**environment->latlong(), **expected->latlong()));
    }
}
