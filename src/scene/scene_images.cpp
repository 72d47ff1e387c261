#include "scene/scene_images.h"

#include "domelight/base/parallel.h"

#include "io/file/printable.h"
#include "io/image_reader.h"
#include "io/picture/texture_image.h"

#include <optional>

namespace domelight {

std::vector<SceneTexture*> textures_of(Material& m) {
    return {&m.base_color_texture,       &m.metallic_roughness_texture, &m.normal_texture,
            &m.occlusion_texture,        &m.emission_texture,           &m.specular_texture,
            &m.specular_color_texture,   &m.clearcoat_texture,          &m.clearcoat_roughness_texture,
            &m.clearcoat_normal_texture, &m.sheen_color_texture,        &m.sheen_roughness_texture,
            &m.transmission_texture,     &m.thickness_texture,          &m.anisotropy_texture};
}

namespace {

/// Takes the textures of an image that cannot be had from the materials, and says why.
void leave_out(Scene& scene, std::size_t image, const Error& why) {
    for (Material& material : scene.materials)
        for (SceneTexture* texture : textures_of(material))
            if (texture->image == int(image)) texture->image = -1;
    const std::string hint = why.hint.empty() ? "" : " " + why.hint;
    scene.warnings.push_back(why.what + ": left out, its materials have their factors alone." + hint);
}

Error at_image(const SceneImageSource& source, const Error& error) {
    return {printable(source.name, 80) + ": " + error.what, "", error.hint};
}

}  // namespace

Result<void> load_scene_images(const std::vector<SceneImageSource>& sources, Scene& scene, ByteBudget& budget,
                               int threads) {
    std::vector<bool> used(sources.size());
    for (Material& material : scene.materials)
        for (const SceneTexture* texture : textures_of(material))
            if (*texture) used[std::size_t(texture->image)] = true;

    // Files are opened and sizes added up in order, so that a refusal does not depend on the number of threads.
    std::vector<std::shared_ptr<const FileBytes>> files(sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (!used[i]) continue;
        auto file = sources[i].open();
        if (!file) {
            leave_out(scene, i, file.error());
            continue;
        }
        const auto size = texture_image_size((*file)->bytes());
        if (!size) {
            leave_out(scene, i, at_image(sources[i], size.error()));
            continue;
        }
        const auto texels = std::uint64_t(size->width) * std::uint64_t(size->height);
        if (const auto room = budget.take(texels, 4, printable(sources[i].name, 80)); !room) return room.error();
        files[i] = std::move(*file);
    }
    std::vector<std::optional<Error>> failed(sources.size());
    scene.images.resize(sources.size());
    parallel_for(int(sources.size()), threads, [&](int n) {
        const auto i = std::size_t(n);
        if (!files[i]) return;
        auto image = decode_texture_image(files[i]->bytes());
        if (!image)
            failed[i] = image.error();
        else
            scene.images[i] = std::move(*image);
        files[i] = nullptr;
    });
    for (std::size_t i = 0; i < sources.size(); ++i) {
        if (failed[i]) leave_out(scene, i, at_image(sources[i], *failed[i]));
        scene.images[i].name = sources[i].name;
    }
    return {};
}

}  // namespace domelight
