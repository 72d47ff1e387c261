#include "bake/chain_as_read.h"

#include "domelight/texture/texture.h"

#include <algorithm>

namespace domelight {
namespace {

/// A level of a texture as a map of light.
FilteredMap decoded(const Texture& texture, int level, Layout layout) {
    const int width = texture.level_width(level), height = texture.level_height(level);
    ImageF image = ImageF::uninitialized(width, texture.faces * height, 3);
    for (int f = 0; f < texture.faces; ++f) {
        const ImageF face = decode_texture(texture, level, f);
        std::ranges::copy(face.pixels(), image.row(f * height));
    }
    return {layout, std::move(image)};
}

}  // namespace

ReadChain chain_as_read(const EnginePlan& plan, Lobe lobe, std::span<const LevelPlan> levels,
                        std::span<const FilteredMap> maps, const BakeOptions& options) {
    ReadChain chain;
    chain.lobe = lobe;
    chain.level_of = plan.level_of;
    for (const LevelPlan& level : levels) chain.roughness.push_back(level.roughness);
    if (plan.container == Container::hdr) {
        chain.levels.assign(maps.begin(), maps.end());
        return chain;
    }
    // Each level is a texture of its own, because levels that are not halves of one another are no chain.
    for (const FilteredMap& map : maps)
        chain.levels.push_back(
            decoded(encode_texture({&map, 1}, plan.encoding, options.threads, nullptr, options.encoding_quality), 0,
                    plan.layout));
    return chain;
}

}  // namespace domelight
