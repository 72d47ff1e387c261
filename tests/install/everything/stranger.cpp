// Uses an installed domelight as any user would: the one header, a filter, a file.
#include <domelight/domelight.h>

#include <cstdio>

int main() {
    const domelight::Vec3d d = domelight::latlong_direction({0.5, 0.5});
    std::printf("the centre looks along (%g, %g, %g)\n", d.x, d.y, d.z);
    return d.x > 0.999 ? 0 : 1;
}
