#include "domelight/base/names.h"

#include "domelight/bake/bake.h"
#include "domelight/base/version.h"
#include "domelight/io/decode.h"
#include "domelight/render/shading/shading.h"
#include "domelight/sampling/reflection_estimate.h"

#include "preview/sample_picture.h"
#include "preview/tonemap.h"
#include "test.h"

#include <set>
#include <utility>

using namespace domelight;

namespace {

/// Whether an enumeration has an enumerator of this value. The compiler's name of this function has the enumerator's
/// name, or a number in a cast where there is none.
template <auto enumerator>
constexpr bool is_enumerator() {
    return std::string_view(__PRETTY_FUNCTION__).find("enumerator = (") == std::string_view::npos;
}

/// The enumerators of E, which lie from 0 to 31.
template <typename E>
std::vector<E> enumerators() {
    std::vector<E> found;
    [&]<int... i>(std::integer_sequence<int, i...>) {
        ((is_enumerator<E(i)>() ? found.push_back(E(i)) : void()), ...);
    }
    (std::make_integer_sequence<int, 32>());
    return found;
}

enum class Fruit { apple, pear, quince };

}  // namespace

TEST_CASE("names: the test finds the enumerators of an enumeration") {
    CHECK(enumerators<Fruit>() == std::vector{Fruit::apple, Fruit::pear, Fruit::quince});
    CHECK(enumerators<Container>().size() == 10);
}

TEST_CASE_TEMPLATE("names: every value has a name that is read back, and an unknown name lists all of them", E,
                   BakeMethod, Background, BrdfForm, BrdfG, Container, CubePicture, Decode, DensityMeasure,
                   DiffuseWeight, DistributionMethod, Encoding, EncodingQuality, Layout, LightStrategy, LightWeight,
                   Lobe, MapLookup, Quantity, Sequence, ShadingModel, ShWindow, Strategy, Tonemap) {
    for (const E value : enumerators<E>()) {
        const std::string name = name_of(value);
        CAPTURE(int(value));
        CHECK(!name.empty());
        const auto found = from_name<E>(name);
        REQUIRE(found);
        CHECK(*found == value);
    }
    const auto names = names_of<E>();
    CHECK(std::set(names.begin(), names.end()).size() == names.size());
    const auto unknown = from_name<E>("xyzzy");
    REQUIRE(!unknown);
    CHECK(unknown.error().what == std::string("\"xyzzy\" is not ") + EnumNames<E>::kind);
    for (const std::string& name : names) CHECK(unknown.error().hint.find(name) != std::string::npos);
}

TEST_CASE("names: another name of a value is accepted, and some values are listed in the order asked for") {
    CHECK(*from_name<Background>("color") == Background::colour);
    CHECK(name_of(Background::colour) == "colour");
    const auto some = with_names({Encoding::rgbm, Encoding::bc6h});
    REQUIRE(some.size() == 2);
    CHECK(some[0].name == "rgbm");
    CHECK(some[1].value == Encoding::bc6h);
    CHECK(from_name<Lobe>("cosine").value_or(Lobe::charlie) == Lobe::charlie);
}

TEST_CASE("version: the library says the version of its headers") {
    CHECK(std::string(version()) == DOMELIGHT_VERSION);
    CHECK(std::string(version()) == std::to_string(DOMELIGHT_VERSION_MAJOR) + "." +
                                        std::to_string(DOMELIGHT_VERSION_MINOR) + "." +
                                        std::to_string(DOMELIGHT_VERSION_PATCH));
}
