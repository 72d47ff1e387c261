#pragma once
// JPEG files that tests make of a few pixels.

#include <cstdint>
#include <cstdio>
// jpeglib.h requires <cstdio> before it.
#include <jpeglib.h>

#include <cstdlib>
#include <vector>

namespace domelight::test {

struct JpegSample {
    int width, height;
    int components = 3;  ///< 1: grey, 3: RGB, 4: CMYK
    int quality = 100;
    bool progressive = false;
    bool whole_chroma = false;  ///< the colours of each pixel, not of four together
};

/// rows: height rows of width x components bytes, from the top.
inline std::vector<std::uint8_t> encode_jpeg(const JpegSample& sample, std::vector<std::uint8_t> rows) {
    jpeg_compress_struct state{};
    jpeg_error_mgr errors;
    state.err = jpeg_std_error(&errors);
    jpeg_create_compress(&state);
    unsigned char* buffer = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&state, &buffer, &size);
    state.image_width = JDIMENSION(sample.width), state.image_height = JDIMENSION(sample.height);
    state.input_components = sample.components;
    state.in_color_space = sample.components == 1 ? JCS_GRAYSCALE : sample.components == 4 ? JCS_CMYK : JCS_RGB;
    jpeg_set_defaults(&state);
    jpeg_set_quality(&state, sample.quality, TRUE);
    if (sample.progressive) jpeg_simple_progression(&state);
    if (sample.whole_chroma) state.comp_info[0].h_samp_factor = state.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&state, TRUE);
    for (int y = 0; y < sample.height; ++y) {
        unsigned char* start = rows.data() + std::size_t(y) * std::size_t(sample.width * sample.components);
        jpeg_write_scanlines(&state, &start, 1);
    }
    jpeg_finish_compress(&state);
    std::vector<std::uint8_t> out(buffer, buffer + size);
    jpeg_destroy_compress(&state);
    std::free(buffer);
    return out;
}

}  // namespace domelight::test
