#include "io/scene_readers.h"
namespace domelight {
Result<Scene> read_obj(std::shared_ptr<const FileBytes>, const std::filesystem::path&, const SceneOptions&) {
    return Error{"not yet", "", ""};
}
Result<Scene> read_ply(std::shared_ptr<const FileBytes>, const SceneOptions&) {
    return Error{"not yet", "", ""};
}
}  // namespace domelight
