#pragma once

#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/filtering/resample/reproject.h"
#include "domelight/image/image.h"
#include "domelight/image/repair_report.h"
#include "domelight/image/row_source.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace domelight {

/// The light that arrives from every direction, as one picture holds it.
///
/// An environment can be read as rows of a lat-long image, as an image in memory, or direction by direction, any number
/// of times and in any order, whatever projection it is stored in. Copies are cheap: they share the pixels. Reading is
/// safe from several threads at once.
///
///     Result<Environment> environment = open_environment({"studio.exr"});
///     Result<FilterResult> levels = prefilter(*environment, options);
///     Result<EnvironmentSampler> sampler = EnvironmentSampler::build(*environment);
///     Result<Vec3f> up = environment->radiance({0, 1, 0});
class Environment {
  public:
    /// Opens the rows of a lat-long image anew, from the top. What the reader repairs is counted in the report, which
    /// is empty at first.
    using RowsOpener = std::function<Result<std::unique_ptr<RowSource>>(std::shared_ptr<RepairReport>)>;

    /// How the pixels are stored.
    enum class Storage {
        none,    ///< there is no light: what a default-constructed environment holds
        rows,    ///< a lat-long image that is read row by row
        cube,    ///< a cube in memory
        picture  ///< a picture in memory in another projection
    };

    std::filesystem::path file;  ///< the first of its files; empty where the environment was made in memory
    std::vector<std::filesystem::path> files;  ///< all of them; faces in the order of a cube
    std::string format;                        ///< "Radiance HDR", "OpenEXR", "PNG", "JPEG", "sky", ...
    std::string layer;                         ///< OpenEXR: the layer that was read; empty: the unnamed one
    std::string projection;                    ///< "latlong", "cube", or the name of another one in projections.h
    std::string convention;                    ///< of a lat-long file: "default", "usd", "openexr", ...
    /// The SHA-256 of the file as it was read, in 64 hexadecimal digits; null where the files have to be read again
    /// for it (environment_sha256() does that).
    std::function<std::string()> sha256;
    int width = 0, height = 0;  ///< texels of the image as it is stored; of one face where a cube is six images
    /// Where to look in the source for the light that arrives from a world direction: the convention, the up axis and
    /// the rotation together (orthogonal, may mirror). The source's own frame is that of latlong_direction() for rows,
    /// that of cube_direction() for a cube, and the world of ProjectedImage::projection for a picture in another
    /// projection.
    Mat3 world_to_source;

    Environment();
    /// From a lat-long image: 3 channels, radiance, linear Rec. 709, finite and >= 0. The light from world direction d
    /// is where the default convention has the direction world_to_source * d.
    static Environment from_latlong(ImageF latlong, const Mat3& world_to_source = {});
    /// From rows of a lat-long image in the default convention, `width` x `height` texels, which `open` opens anew for
    /// each reading. `notes` are the warnings that report() holds until an image has been read.
    static Environment from_rows(int width, int height, RowsOpener open, std::vector<std::string> notes = {});
    /// From a cube of radiance. `threads`: for averaging it to rows; 0: all.
    static Environment from_cube(Cubemap cube, const Mat3& world_to_source = {}, RepairReport report = {},
                                 int threads = 0);
    /// From a picture in any projection. When rows are asked for, it is turned into a lat-long image of the same
    /// resolution, but of 16384 x 8192 texels at most; that image may need at most `max_bytes`. `threads`: for that; 0:
    /// all.
    static Environment from_picture(ProjectedImage picture, const Mat3& world_to_source = {}, RepairReport report = {},
                                    std::int64_t max_bytes = std::int64_t(1) << 30, int threads = 0);

    Storage storage() const;
    /// The cube as it is stored, or null where the environment is not stored as one.
    const Cubemap* cube() const;
    /// The picture as it is stored, or null where the environment is not stored in another projection.
    const ProjectedImage* picture() const;

    /// Texels of the lat-long image that rows() reads; 0 where there is no light.
    int latlong_width() const;
    int latlong_height() const;
    /// The environment as rows of a lat-long image in the source's own frame, from the top. Each call begins a reading
    /// of its own. A cube is averaged over the texels of an image four times as wide as a face, a picture in another
    /// projection is reprojected; either happens once.
    /// Errors: no light; more than `max_bytes`; those of opening the file again.
    Result<std::unique_ptr<RowSource>> rows() const;
    /// The whole of that image, read at the first call and kept for as long as a copy of the environment lives.
    Result<std::shared_ptr<const ImageF>> latlong() const;
    /// The radiance that arrives from a world direction (of any length but 0), bilinear between texels. The first call
    /// reads the image, as latlong() does; a cube is looked up in its own faces.
    Result<Vec3f> radiance(const Vec3d& direction) const;

    /// What was repaired, and the warnings about the files. The counts of texels are complete once an image has
    /// been read to its last row, and do not grow when it is read again.
    RepairReport report() const;

  private:
    struct State;
    std::shared_ptr<State> state_;
};

}  // namespace domelight
