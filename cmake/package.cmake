# cpack: Debian packages of the three parts of install.cmake. Their dependencies are read from the programs and libraries themselves (dpkg-shlibdeps).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME domelight)
set(CPACK_PACKAGE_VENDOR Domelight)
set(CPACK_PACKAGE_CONTACT "The Domelight authors <domelight@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)

set(CPACK_COMPONENTS_ALL program c development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME domelight)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Bakes HDR environments for real-time engines, draws light directions,
extracts lights, and renders reference images.")

set(CPACK_DEBIAN_C_PACKAGE_NAME libdomelight-c${domelight_c_abi})
set(CPACK_DEBIAN_C_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_C_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_COMPONENT_C_DESCRIPTION "The shared library behind domelight_c.h, for programs in any language.")

# What the static libraries are linked with: the libraries that building needs.
file(STRINGS scripts/packages.sh domelight_build_libraries REGEX "^ +lib")
string(REGEX REPLACE "#[^;]*" "" domelight_build_libraries "${domelight_build_libraries}")
string(REGEX MATCHALL "lib[a-z0-9.-]+-dev" domelight_build_libraries "${domelight_build_libraries}")
list(REMOVE_DUPLICATES domelight_build_libraries)
list(JOIN domelight_build_libraries ", " domelight_build_libraries)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libdomelight-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${CPACK_DEBIAN_C_PACKAGE_NAME} (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "${domelight_build_libraries}, nlohmann-json3-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers and libraries for programs in C (domelight_c.h, a shared
library) and in C++ (static libraries, which need the recommended packages).")
include(CPack)
