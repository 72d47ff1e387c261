#include "projection/convention_text.h"

#include "domelight/projection/projections.h"

#include "projection/latlong_convention.h"

#include <doctest/doctest.h>

#include <string>

using namespace domelight;

TEST_CASE("projection_convention: says where the picture's centre, right and top look") {
    CHECK(projection_convention("latlong") == "lat-long, centre +X, right +Z, up +Y");
    CHECK(projection_convention("latlong/usd") == "lat-long, centre +Z, right -X, up +Y");
    CHECK(projection_convention("latlong/mitsuba") ==
          "lat-long, centre +Z, right -X, up +Y, the first and last row on the poles");
    CHECK(projection_convention("pbrt") == "equal-area-octahedral, centre +Y, right +X, up +Z");
}

TEST_CASE("latlong_of_convention: a convention's words lead back to it") {
    for (const auto& name : latlong_convention_names())
        CHECK(latlong_of_convention(projection_convention("latlong/" + std::string(name))) ==
              "latlong/" + std::string(name));
    for (const char* axes : {"centre=-Y,right=+X,up=+Z", "centre=+X,right=-Z,up=+Y", "centre=+Z,right=+Y,up=-X"}) {
        const std::string projection = std::string("latlong/") + axes;
        CHECK(latlong_of_convention(projection_convention(projection)) == projection);
    }
    for (const char* text :
         {"", "lat-long", "lat-long, centre +X, right +X, up +Y", "lat-long, centre +W, right +Z, up +Y",
          "octahedral, centre +Y, right +X, up +Z", "texture(cube, d) is the light"})
        CHECK_FALSE(latlong_of_convention(text));
}
