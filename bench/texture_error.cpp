// texture_error PICTURE TEXTURE...: the errors of textures of one face against the picture that they were made from, as
//     JSON.
// texture_error --encode ENCODING QUALITY PICTURE OUT.ktx2: makes a texture on one thread and prints the CPU time.
//
// The figure is the PSNR of log radiance: log2(v + 1e-4 mean) of every channel, the picture's own range as the peak.
#include "domelight/texture/texture.h"

#include "io/file/file_reader.h"
#include "io/image_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <nlohmann/json.hpp>

using namespace domelight;

namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void fail(const Error& e) {
    fmt::print(stderr, "texture_error: {} {}\n", e.where, e.what);
    std::exit(1);
}

template <typename T>
T need(Result<T> result) {
    if (!result) fail(result.error());
    return *std::move(result);
}

ImageF read_picture(const char* file) {
    const auto reader = need(open_image_reader(need(FileBytes::open(file, std::int64_t(1) << 30)), {}));
    ImageF image(reader->facts().width, reader->facts().height, 3);
    need(reader->read(image.view()));
    return image;
}

double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// PSNR in decibels over `count` values of picture and texture, each from 0 up.
double log_psnr(int count, double floor, const std::function<double(int)>& picture,
                const std::function<double(int)>& texture) {
    double sum = 0, low = INFINITY, high = -INFINITY;
    for (int i = 0; i < count; ++i) {
        const double a = std::log2(picture(i) + floor), b = std::log2(texture(i) + floor);
        sum += (a - b) * (a - b);
        low = std::min(low, a);
        high = std::max(high, a);
    }
    return 20 * std::log10((high - low) / std::sqrt(sum / count));
}

Json compare(const ImageF& picture, const char* file) {
    const ImageF back = decode_texture(need(read_texture(file)), 0, 0);
    if (back.width() != picture.width() || back.height() != picture.height())
        fail({"has another size than the picture", file, ""});
    const auto a = picture.pixels(), b = back.pixels();
    const int count = int(a.size());
    const auto held = [&](int i) { return std::clamp(double(a[std::size_t(i)]), 0.0, 65504.0); };
    double mean = 0, error = 0, norm = 0;
    for (int i = 0; i < count; ++i) {
        const double off = held(i) - b[std::size_t(i)];
        mean += held(i) / count;
        error += off * off;
        norm += held(i) * held(i);
    }
    const auto luminance = [](auto v, int i) {
        return 0.2126 * v(3 * i) + 0.7152 * v(3 * i + 1) + 0.0722 * v(3 * i + 2);
    };
    const auto stored = [&](int i) { return double(b[std::size_t(i)]); };
    return {{"file", file},
            {"log_psnr", log_psnr(count, 1e-4 * mean, held, stored)},
            {"log_psnr_luminance", log_psnr(
                                       count / 3, 1e-4 * mean, [&](int i) { return luminance(held, i); },
                                       [&](int i) { return luminance(stored, i); })},
            {"relative_rms", std::sqrt(error / norm)}};
}

Json encode(char** args) {
    const Encoding encoding = need(from_name<Encoding>(args[0]));
    const EncodingQuality quality = need(from_name<EncodingQuality>(args[1]));
    const std::vector<FilteredMap> maps{{Layout::latlong, read_picture(args[2])}};
    std::vector<double> seconds;
    Texture texture;
    for (int k = 0; k < 4; ++k) {  // the first is a warm-up
        const double before = cpu_seconds();
        texture = encode_texture(maps, encoding, 1, nullptr, quality);
        seconds.push_back(cpu_seconds() - before);
    }
    const auto written = write_ktx2(args[3], texture);
    if (!written) fail(written.error());
    return {{"seconds", *std::min_element(seconds.begin(), seconds.end())}};
}

}  // namespace

int main(int count, char** args) {
    if (count == 6 && std::string(args[1]) == "--encode") {
        fmt::print("{}\n", encode(args + 2).dump());
    } else if (count >= 3 && args[1][0] != '-') {
        const ImageF picture = read_picture(args[1]);
        Json list = Json::array();
        for (int i = 2; i < count; ++i) list.push_back(compare(picture, args[i]));
        fmt::print("{}\n", list.dump());
    } else {
        fmt::print(stderr, "usage: texture_error PICTURE TEXTURE... | --encode ENCODING QUALITY PICTURE OUT.ktx2\n");
        return 2;
    }
}
