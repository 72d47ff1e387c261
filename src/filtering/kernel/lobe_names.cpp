#include "domelight/filtering/kernel/lobe_names.h"

namespace domelight {

std::optional<Lobe> lobe_from_name(std::string_view name) {
    for (const Lobe lobe : {Lobe::ggx, Lobe::charlie, Lobe::phong_brdf, Lobe::phong_plain})
        if (lobe_name(lobe) == name) return lobe;
    return std::nullopt;
}

}  // namespace domelight
