#pragma once
// Image-based lighting: all of Domelight's public headers, and a tour of them in five steps. examples/tour.cpp is the
// same code as a program.
//
// 1. Open an environment, from any file and in any projection.
//
//        auto environment = open_environment({"studio.hdr"});        // Result<Environment>
//        if (!environment) return environment.error();               // what is wrong, where, and what to do
//        auto up = environment->radiance({0, 1, 0});                 // light from one direction; latlong(): from all
//
// 2. Filter it: levels for roughness, irradiance, spherical harmonics. Exact, in one pass over the rows.
//
//        FilterOptions options;
//        options.irradiance_size = 32;
//        for (int level = 0; level < 5; ++level)                     // 256² at roughness 0 to 16² at roughness 1
//            options.specular.push_back({256 >> level, level == 0, ZonalKernel::ggx(level / 4.0)});
//        auto filtered = prefilter(*environment, options);
//
// 3. Write what an engine loads: one texture by hand, or the whole folder as an engine wants it.
//
//        write_ktx2("specular.ktx2", encode_texture(filtered->specular, Encoding::rgba16f, 0));
//        BakeOptions for_engine;
//        for_engine.engines = {"filament"};
//        bake(*environment, for_engine, "out");
//
// 4. Draw light directions from it, in proportion to the radiance, for a renderer of your own.
//
//        auto sampler = EnvironmentSampler::build(*environment);
//        LightSample light = sampler->sample(unit_point(Sequence::sobol, seed, index, count));
//        sum += brdf(light.direction) * light.radiance * (NdotL / light.pdf_solid_angle);
//
// 5. Compare with a path-traced picture: here direct light with shadows. RenderOptions::bounces adds indirect light.
//
//        auto scene = load_scene("helmet.glb");
//        auto traced = RayScene::build(*std::move(scene));
//        RenderOptions view;
//        view.camera = default_camera(traced->scene(), 1);
//        auto picture = render_reference(*traced, *sampler, view);
//
// docs/conventions.md defines the axes and the units of light.

#include "domelight/bake/bake.h"
#include "domelight/bake/brdf_file.h"
#include "domelight/batch/batch_plan.h"
#include "domelight/batch/batch_results.h"
#include "domelight/batch/batch_run.h"
#include "domelight/base/frame.h"
#include "domelight/base/large_allocator.h"
#include "domelight/base/names.h"
#include "domelight/base/parallel.h"
#include "domelight/base/progress.h"
#include "domelight/base/random.h"
#include "domelight/base/result.h"
#include "domelight/base/unit_point.h"
#include "domelight/base/vec.h"
#include "domelight/base/version.h"
#include "domelight/capture/capture.h"
#include "domelight/capture/engine_files.h"
#include "domelight/capture/placement.h"
#include "domelight/capture/probe_bake.h"
#include "domelight/capture/probe_baker.h"
#include "domelight/capture/probe_plan.h"
#include "domelight/capture/probe_rooms.h"
#include "domelight/compare/bake_audit.h"
#include "domelight/compare/compare_sheet.h"
#include "domelight/compare/difference_map.h"
#include "domelight/compare/metrics.h"
#include "domelight/compare/picture_comparison.h"
#include "domelight/compare/picture_reader.h"
#include "domelight/compare/read_error.h"
#include "domelight/engines/engine.h"
#include "domelight/environment/environment.h"
#include "domelight/environment/sky/sky.h"
#include "domelight/filtering/brdf/brdf_table.h"
#include "domelight/filtering/harmonic/spherical_harmonics.h"
#include "domelight/filtering/kernel/zonal_kernel.h"
#include "domelight/filtering/prefilter.h"
#include "domelight/filtering/prefilter_transpose.h"
#include "domelight/filtering/probe_filter.h"
#include "domelight/filtering/quantity.h"
#include "domelight/filtering/reference.h"
#include "domelight/filtering/resample/area_resample.h"
#include "domelight/filtering/resample/reproject.h"
#include "domelight/image/colour.h"
#include "domelight/image/cube_layout.h"
#include "domelight/image/image.h"
#include "domelight/image/negatives.h"
#include "domelight/image/repair_report.h"
#include "domelight/image/rgba8_image.h"
#include "domelight/image/row_source.h"
#include "domelight/io/decode.h"
#include "domelight/io/environment/convert.h"
#include "domelight/io/environment/open_environment.h"
#include "domelight/io/face_orientation.h"
#include "domelight/io/file/atomic_file.h"
#include "domelight/io/file/file_extension.h"
#include "domelight/io/picture/animation.h"
#include "domelight/io/write_image.h"
#include "domelight/preview/preview.h"
#include "domelight/probe/probe.h"
#include "domelight/probe/probe_blend.h"
#include "domelight/probe/probe_check.h"
#include "domelight/probe/probe_grid.h"
#include "domelight/probe/probe_set.h"
#include "domelight/probe/scene_hash.h"
#include "domelight/probe/tetrahedra.h"
#include "domelight/projection/projection.h"
#include "domelight/projection/projections.h"
#include "domelight/render/render.h"
#include "domelight/render/shading/shading.h"
#include "domelight/sampling/brdf.h"
#include "domelight/sampling/distribution/alias.h"
#include "domelight/sampling/distribution/bilinear.h"
#include "domelight/sampling/distribution/binary.h"
#include "domelight/sampling/distribution/distribution.h"
#include "domelight/sampling/distribution/guided.h"
#include "domelight/sampling/distribution/hierarchical.h"
#include "domelight/sampling/distribution/plain.h"
#include "domelight/sampling/environment_sampler.h"
#include "domelight/sampling/light_extraction.h"
#include "domelight/sampling/low_discrepancy.h"
#include "domelight/sampling/microfacet.h"
#include "domelight/sampling/product_sampling.h"
#include "domelight/sampling/reflection_estimate.h"
#include "domelight/sampling/sequences.h"
#include "domelight/sampling/warps.h"
#include "domelight/scene/scene.h"
#include "domelight/study/environment_survey.h"
#include "domelight/study/explanation_picture.h"
#include "domelight/study/render_study.h"
#include "domelight/study/render_study_pictures.h"
#include "domelight/study/sample_explanation.h"
#include "domelight/study/strategy_study.h"
#include "domelight/texture/container/babylon_env.h"
#include "domelight/texture/container/texture_bytes.h"
#include "domelight/texture/texture.h"
#include "domelight/view/view_server.h"
