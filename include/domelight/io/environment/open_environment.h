#pragma once

#include "domelight/environment/environment.h"
#include "domelight/image/negatives.h"
#include "domelight/io/decode.h"
#include "domelight/io/face_orientation.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace domelight {

/// How to interpret an environment's file where the file does not say so itself.
struct EnvironmentOptions {
    /// auto | latlong | cube | cube-cross | cube-strip | cube-faces, or any other of projections.h, each with its
    /// convention: "latlong/usd", "cube/openexr", "angular/centre=+Z", "mirror-ball/fov=20".
    std::string projection = "auto";
    /// Lat-long convention: default, usd, mitsuba, openexr, materialx, mod, or "centre=+X,right=+Z[,up=+Y]", or pbrt
    /// (the equal-area octahedral square). Empty: the convention that the file states, otherwise default.
    std::string latlong = "";
    /// OpenEXR: the layer to read. Empty: the unnamed layer; else the one named rgba, rgb, beauty or combined, in any
    /// case and after any prefix ("View Layer.Combined"); else the only one that has a colour. Otherwise a layer's
    /// name, the end of only one layer's name after a dot, a channel's name, or the name, the view or the number (from
    /// 0) of a part of a file with several.
    std::string layer = "";
    /// The faces that six files, or the pictures of a strip of faces, show one after the other, where their names do
    /// not say it: "px nx py ny pz nz". Any of the names that docs/conventions.md lists, separated by spaces or commas.
    std::string faces = "";
    /// How each face of a cube lies. Empty: what the files state or show, otherwise opengl.
    std::optional<FaceOrientation> face_orientation = std::nullopt;
    Decode decode = Decode::automatic;  ///< of PNG, JPEG, and textures of eight bits a channel
    double rotate_y_deg = 0;            ///< turns the light about +Y: +X moves towards +Z
    /// The axis, in the coordinate system of the file's author, at the top of the image: +Y, +Z, ...
    std::string up = "+Y";
    double exposure = 0;                             ///< stops: radiance is multiplied by 2^exposure
    std::int64_t max_bytes = std::int64_t(1) << 30;  ///< images whose decoding would need more memory are refused
    Negatives negatives = Negatives::balance;        ///< what becomes of negative values in the file
    int threads = 0;                                 ///< for decoding; 0: all
};

/// Opens an environment. `files` is one image or cube texture (KTX2, KTX, DDS, .env), the six faces of a cube in any
/// order (recognised by name), or the front and the back of a dual paraboloid.
/// Errors that name the option: an unknown value, or one out of its range. Errors that name the file: no such file,
/// unknown or broken format, wrong shape, over `max_bytes`.
Result<Environment> open_environment(const std::vector<std::filesystem::path>& files,
                                     const EnvironmentOptions& options = {});

/// Opens an environment from the bytes of one file in memory, of any kind that open_environment() reads. The bytes are
/// copied.
///
/// bytes    the whole file
/// name     what errors call it; Environment::file
/// Errors: as above; `bytes` is empty; a glTF file whose pictures are in files of their own.
Result<Environment> open_environment_bytes(std::span<const std::uint8_t> bytes, const std::string& name,
                                           const EnvironmentOptions& options = {});

/// The SHA-256 of the contents of an environment's files, one after the other, in 64 hexadecimal digits: of a lat-long
/// image and of a pipe as they were read, of others by reading them once more. Empty where there are no files.
/// Errors name the file: it cannot be read any more.
Result<std::string> environment_sha256(const Environment& environment);

/// Whether a picture of this size is taken for an environment where nothing else is said: twice as wide as high (a
/// lat-long map), or a cross or strip of cube faces (4:3, 3:4, 6:1 or 1:6).
bool has_environment_shape(int width, int height);

}  // namespace domelight
