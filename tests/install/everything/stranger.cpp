// Uses an installed domelight as any user would, by the one header.
#include <domelight/domelight.h>

#include <cstdio>
#include <string>

int main() {
    static_assert(DOMELIGHT_VERSION_MAJOR >= 0 && DOMELIGHT_VERSION_MINOR >= 0 && DOMELIGHT_VERSION_PATCH >= 0);
    if (std::string(domelight::version()) != DOMELIGHT_VERSION) return 1;
    const domelight::Vec3d d = domelight::latlong_direction({0.5, 0.5});
    std::printf("the centre looks along (%g, %g, %g)\n", d.x, d.y, d.z);
    return d.x > 0.999 ? 0 : 1;
}
