#include "domelight/base/version.h"

namespace domelight {

const char* version() {
    return DOMELIGHT_VERSION;
}

}  // namespace domelight
