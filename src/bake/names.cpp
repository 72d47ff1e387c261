#include "domelight/bake/bake.h"

namespace domelight {

std::string bake_method_name(BakeMethod method) {
    switch (method) {
        case BakeMethod::exact:
            return "exact";
        case BakeMethod::bruteforce:
            return "bruteforce";
        case BakeMethod::riemann:
            return "riemann";
        case BakeMethod::montecarlo:
            return "montecarlo";
    }
    return {};
}

std::string cube_picture_name(CubePicture picture) {
    switch (picture) {
        case CubePicture::cross:
            return "cross";
        case CubePicture::strip:
            return "strip";
        case CubePicture::faces:
            return "faces";
    }
    return {};
}

}  // namespace domelight
