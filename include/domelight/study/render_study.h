#pragma once
// The figures of `render --study`: how errors of rendering depend on strategy, samples, roughness and angle.

#include "domelight/base/progress.h"
#include "domelight/render/render.h"
#include "domelight/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// The size and quality of a study.
struct RenderStudyOptions {
    int size = 88;     ///< pixels of one small picture, square
    int samples = 16;  ///< of each pixel where strategies are compared; all other counts follow from it
    std::uint64_t seed = 0;
    int threads = 0;
    Progress progress;
};

/// The scene of a study: its materials' roughness is replaced, the rest stays.
struct StudyScene {
    Scene scene;
    Camera camera;
    std::string name;
    int object = 0;  ///< the one whose errors count, from 1 on; 0: all
};
/// A metal ball on a floor of plastic.
StudyScene study_ball();

/// A light of a study: a round one, or the environment.
struct StudyLight {
    double diameter_deg = 0;  ///< 0: the environment itself
    std::string name;         ///< "2°", "sky"
    ImageF image;             ///< lat-long
    Mat3 world_to_source;
};
/// Round lights of one irradiance (pi, on a surface that faces them) and rising size in the dark.
std::vector<StudyLight> round_lights();

/// One small picture of the first figure.
struct StrategyCell {
    bool occlusion = false;
    double roughness = 0;
    int light = 0;
    LightStrategy strategy = LightStrategy::mis;
    double error = 0;  ///< RMSE of L / (1 + L), of the scene's object
    ImageF picture;
};
struct StrategyFigure {
    std::vector<double> roughness;
    std::vector<StudyLight> lights;
    int samples = 0, reference_samples = 0;
    bool one_object = false;  ///< errors are those of the scene's one object
    std::vector<StrategyCell> cells;
    const StrategyCell& at(bool occlusion, double roughness, int light, LightStrategy strategy) const;
};

/// One line of the second figure: the error of a strategy by the number of samples.
struct NoiseLine {
    bool occlusion = false;
    LightStrategy strategy = LightStrategy::mis;
    struct Point {
        int samples = 0;
        double error = 0;
        ImageF picture;
    };
    std::vector<Point> points;
    double slope = 0;  ///< of log error over log samples, least squares
};
struct NoiseFigure {
    double roughness = 0;
    int reference_samples = 0;
    std::vector<NoiseLine> lines;
};

/// The third figure: errors of split-sum shading by roughness and view angle.
struct SplitSumFigure {
    std::vector<double> roughness;
    int bins = 10;  ///< of NdotV, equal ones
    int samples = 0, views = 0;
    struct Part {
        bool occlusion = false;        ///< of the reference; split-sum never has any
        ImageF error;                  ///< bins x roughness: RMSE of L / (1 + L); NaN for a bin without pixels
        ImageF difference;             ///< mean of split-sum's L / (1 + L) minus the reference's
        double noise = 0;              ///< of the reference: standard error of L / (1 + L), rms
        double rmse = 0;               ///< over all of it
        std::vector<ImageF> pictures;  ///< of the reference, one for each roughness, the first view
    };
    std::vector<Part> parts;       ///< without occlusion, then with
    std::vector<ImageF> pictures;  ///< of split-sum
};

/// Each function reports its progress from 0 to 1. Errors: "cancelled"; those of rendering.
Result<StrategyFigure> study_light_strategies(const StudyScene& scene, StudyLight environment,
                                              const RenderStudyOptions& options);
Result<NoiseFigure> study_noise(const StudyScene& scene, const StudyLight& environment,
                                const RenderStudyOptions& options);
Result<SplitSumFigure> study_split_sum(const StudyScene& scene, const StudyLight& environment,
                                       const RenderStudyOptions& options);

/// "environment", "BRDF", "MIS".
const char* strategy_label(LightStrategy strategy);

}  // namespace domelight
