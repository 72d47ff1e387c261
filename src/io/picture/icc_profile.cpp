#include "io/picture/icc_profile.h"

#include "io/file/printable.h"

#include <fmt/format.h>
#include <lcms2.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace domelight {

namespace {

struct CloseProfile {
    void operator()(void* profile) const { cmsCloseProfile(profile); }
};
using Profile = std::unique_ptr<void, CloseProfile>;

std::string profile_name(cmsHPROFILE profile) {
    char name[100] = "";
    cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", name, sizeof name);
    const std::string shown = printable(name, 60);
    return shown.empty() ? "the ICC profile" : fmt::format("the ICC profile \"{}\"", shown);
}

/// Four bytes of each code point (ICC.1:2022, section 10.5). Little CMS 2.14 cannot read the tag.
std::optional<CodePoints> code_points(cmsHPROFILE profile) {
    std::uint8_t tag[12];
    if (cmsReadRawTag(profile, cmsTagSignature(0x63696370), tag, sizeof tag) != sizeof tag) return std::nullopt;
    return CodePoints{tag[8], tag[9], tag[10], tag[11] != 0};
}

bool set_channel(ScreenColour& colour, std::size_t channel, cmsHPROFILE profile, cmsTagSignature tag, int levels) {
    const auto* curve = static_cast<const cmsToneCurve*>(cmsReadTag(profile, tag));
    if (!curve) return false;
    ScreenColour one;
    set_curves(one, levels, [&](double v) {
        const double light = cmsEvalToneCurveFloat(curve, float(v));
        return std::isfinite(light) ? std::clamp(light, 0.0, 1.0) : 0.0;
    });
    colour.curves[channel] = one.curves[0];
    return true;
}

/// Curves and a matrix: "matrix-based" profiles (ICC.1:2022, section 8.4.3). The colourants are XYZ of D50.
std::optional<ScreenColour> by_matrix(cmsHPROFILE profile, int levels) {
    constexpr cmsTagSignature curves[] = {cmsSigRedTRCTag, cmsSigGreenTRCTag, cmsSigBlueTRCTag};
    constexpr cmsTagSignature colourants[] = {cmsSigRedColorantTag, cmsSigGreenColorantTag, cmsSigBlueColorantTag};
    ScreenColour colour;
    Mat3 columns;
    for (std::size_t c = 0; c < 3; ++c) {
        if (!set_channel(colour, c, profile, curves[c], levels)) return std::nullopt;
        const auto* xyz = static_cast<const cmsCIEXYZ*>(cmsReadTag(profile, colourants[c]));
        if (!xyz) return std::nullopt;
        columns.row[c] = {xyz->X, xyz->Y, xyz->Z};
    }
    colour.to_rec709 = rec709_of_colourants(columns.transposed());
    return colour;
}

/// Through the profile's tables, with its media's white as white.
Result<ScreenColour> by_tables(cmsHPROFILE profile, int levels) {
    constexpr cmsCIExyY white{0.3127, 0.3290, 1};
    constexpr cmsCIExyYTRIPLE rec709{{0.640, 0.330, 1}, {0.300, 0.600, 1}, {0.150, 0.060, 1}};
    const std::unique_ptr<cmsToneCurve, void (*)(cmsToneCurve*)> straight(cmsBuildGamma(nullptr, 1), cmsFreeToneCurve);
    cmsToneCurve* const curves[] = {straight.get(), straight.get(), straight.get()};
    const Profile linear(cmsCreateRGBProfile(&white, &rec709, curves));
    const std::shared_ptr<void> transform(
        cmsCreateTransform(profile, TYPE_RGB_FLT, linear.get(), TYPE_RGB_FLT, INTENT_RELATIVE_COLORIMETRIC,
                           cmsFLAGS_NOCACHE | cmsFLAGS_NOOPTIMIZE),
        [](void* t) {
            if (t) cmsDeleteTransform(t);
        });
    if (!transform) return Error{"its tables cannot be used", "", ""};
    ScreenColour colour = colour_of_decode(Decode::linear, levels);
    colour.profile = [transform](float* rgb, int texels) {
        cmsDoTransform(transform.get(), rgb, rgb, cmsUInt32Number(texels));
    };
    return colour;
}

Result<ScreenColour> by_kind(cmsHPROFILE profile, int levels) {
    if (const auto points = code_points(profile); points && points->matrix == 0)
        if (auto colour = colour_of_code_points(*points, levels)) return colour;
    if (cmsGetColorSpace(profile) == cmsSigGrayData) {
        ScreenColour colour;
        for (std::size_t c = 0; c < 3; ++c)
            if (!set_channel(colour, c, profile, cmsSigGrayTRCTag, levels)) return Error{"it has no curve", "", ""};
        return colour;
    }
    if (cmsGetColorSpace(profile) != cmsSigRgbData) return Error{"it is neither of RGB nor of grey", "", ""};
    const bool tables = cmsIsTag(profile, cmsSigAToB0Tag) || cmsIsTag(profile, cmsSigAToB1Tag) ||
                        cmsIsTag(profile, cmsSigDToB0Tag) || cmsIsTag(profile, cmsSigDToB1Tag);
    if (!tables)
        if (auto colour = by_matrix(profile, levels)) return *std::move(colour);
    return by_tables(profile, levels);
}

}  // namespace

Result<ScreenColour> colour_of_icc_profile(std::span<const std::uint8_t> bytes, int levels) {
    const Profile profile(cmsOpenProfileFromMem(bytes.data(), cmsUInt32Number(bytes.size())));
    if (!profile) return Error{"the ICC profile is damaged", "", ""};
    const std::string name = profile_name(profile.get());
    auto colour = by_kind(profile.get(), levels);
    if (!colour) return Error{fmt::format("{} cannot be used: {}", name, colour.error().what), "", ""};
    if (!colour->profile && is_srgb(*colour, levels)) return colour_of_decode(Decode::srgb, levels);
    colour->notes.insert(colour->notes.begin(), name + " was converted to linear Rec. 709");
    return colour;
}

}  // namespace domelight
