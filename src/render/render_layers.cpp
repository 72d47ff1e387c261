#include "render/render_layers.h"

#include "domelight/io/write_image.h"

#include "io/file/printable.h"

#include <string>

namespace domelight {

Result<void> write_render_layers(const std::filesystem::path& file, const RenderResult& r,
                                 ImageView<const float> radiance, const Scene& scene) {
    const ExrLayer layers[] = {{"", radiance, ""},           {"", r.opacity, "A"},         {"direct", r.direct, ""},
                               {"indirect", r.indirect, ""}, {"diffuse", r.diffuse, ""},   {"specular", r.specular, ""},
                               {"albedo", r.albedo, ""},     {"normal", r.normal, ""},     {"depth", r.depth, "Z"},
                               {"object", r.object, "Y"},    {"variance", r.variance, ""}, {"samples", r.samples, "Y"}};
    // `compare` takes the names in its table of objects from this attribute: one name a line, from object 1 on.
    ExrWriteOptions options;
    std::string& names = options.attributes["objects"];
    for (const Instance& instance : scene.instances) names += escaped(instance.name) + "\n";
    return write_exr_layers(file, layers, options);
}

}  // namespace domelight
