#include "domelight/zonal_kernel.h"

namespace domelight {

std::string lobe_name(Lobe lobe) {
    switch (lobe) {
        case Lobe::ggx: return "ggx";
        case Lobe::charlie: return "charlie";
        case Lobe::phong_brdf: return "phong";
        case Lobe::phong_plain: return "phong-plain";
    }
    return {};
}

}  // namespace domelight
