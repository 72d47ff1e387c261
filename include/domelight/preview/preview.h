#pragma once

#include "domelight/base/vec.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/image/image.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// One specular level on the contact sheet.
struct PreviewLevel {
    const FilteredMap* map = nullptr;
    double roughness = 0, alpha = 0;
    std::string detail = {};  ///< in place of "roughness ... α ..." where it is not empty: "exponent 64"
    std::string name = {};    ///< the line above that; empty: "level 2 · 128²"
};

/// The contents of a contact sheet. Views and pointers are only used during the call; empty ones are left out.
struct PreviewInput {
    std::string title;                   ///< the environment's file name, UTF-8
    std::string subtitle;                ///< "4096 × 2048 · GGX · rgba16f · generic"
    ImageView<const float> environment;  ///< lat-long RGB, any size; empty: the first specular level is shown instead
    Mat3 world_to_source;                ///< the same as for the maps
    std::vector<PreviewLevel> specular;  ///< sharpest first
    std::vector<PreviewLevel> sheen;     ///< of Charlie's lobe, shown below the others
    const FilteredMap* irradiance_over_pi = nullptr;
    std::string irradiance_detail;  ///< the second line of the label below the irradiance; empty: its size
    std::span<const Vec3d> sh;      ///< radiance coefficients (spherical_harmonics.h)
    ImageView<const float> brdf;    ///< a BRDF table (brdf_table.h)
    int brdf_channels = 2;          ///< how many of its channels are shown, as red, green and blue
    std::string brdf_detail = "red scale, green bias";  ///< what these channels hold
    std::optional<double> exposure_ev;  ///< stops; empty: the exposure that brings the environment's log-average
                                        ///< luminance to 0.18
    int width = 1600;                   ///< pixels, at least 800
    int threads = 0;
};

/// A contact sheet (8-bit sRGB, 3 channels) that a person can judge a bake by at a glance: the environment, each level
/// (of the sheen too) as a chrome ball and unfolded, irradiance, its spherical-harmonic reconstruction, the BRDF table;
/// tone mapped (AgX) and labelled.
///
/// Balls are seen along -Z with +X to the right and +Y up, so a chrome ball has +Z at its middle and -Z around its rim.
/// Cubes unfold as a horizontal cross, lat-long levels in the default convention. The same bytes on any number of
/// threads.
Image<std::uint8_t> contact_sheet(const PreviewInput& input);

}  // namespace domelight
