# The library in components. A component is made of rooms (docs/code-map.md) and links what only they need, so that a program links no more than it uses:
# one that samples and filters links domelight::core, and with it Highway and threads. domelight::domelight is all of them.

# What nearly every file includes is parsed once: for core, and once more with what all others use.
set(domelight_common_headers <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <span> <string> <variant> <vector>)

file(GLOB_RECURSE domelight_unassigned CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/src/*.cpp)

include(cmake/compile_together.cmake)

configure_file(include/domelight/base/version.h.in include/domelight/base/version.h @ONLY)

# domelight_component(NAME ROOMS folder ... [USES component ...] [LINKS library ...] [SEPARATE])
# SEPARATE: its files are compiled one by one, because parts of the same kind have functions of the same names.
# Takes the sources below those folders of src/ that no earlier component took.
function(domelight_component name)
  cmake_parse_arguments(PARSE_ARGV 1 component "SEPARATE" "" "ROOMS;USES;LINKS")
  list(JOIN component_ROOMS "|" rooms)
  set(sources ${domelight_unassigned})
  list(FILTER sources INCLUDE REGEX "^(${rooms})/")
  list(REMOVE_ITEM domelight_unassigned ${sources})
  list(TRANSFORM sources PREPEND ${PROJECT_SOURCE_DIR}/src/)
  list(TRANSFORM component_USES PREPEND domelight_)

  add_library(domelight_${name} ${sources})
  if(NOT component_SEPARATE)
    domelight_compile_together(domelight_${name})
  endif()
  add_library(domelight::${name} ALIAS domelight_${name})
  target_include_directories(domelight_${name} PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include;${PROJECT_BINARY_DIR}/include>" $<INSTALL_INTERFACE:include>
                             PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_compile_features(domelight_${name} PUBLIC cxx_std_20)
  target_link_libraries(domelight_${name} PUBLIC ${component_USES} PRIVATE $<BUILD_INTERFACE:domelight_flags> ${component_LINKS})
  set_target_properties(domelight_${name} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} DEFINE_SYMBOL "")
  if(name STREQUAL core)
    target_precompile_headers(domelight_core PRIVATE ${domelight_common_headers})
  else()
    target_precompile_headers(domelight_${name} REUSE_FROM domelight_common_headers)
  endif()
  set(domelight_unassigned ${domelight_unassigned} PARENT_SCOPE)
  set(domelight_components ${domelight_components} ${name} PARENT_SCOPE)
endfunction()

find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(hwy REQUIRED IMPORTED_TARGET libhwy)
domelight_component(core ROOMS base image projection environment sampling filtering texture/texel LINKS PkgConfig::hwy Threads::Threads)
if(DOMELIGHT_CORE_ONLY)
  return()
endif()

find_package(fmt 9 REQUIRED)
find_package(Imath 3.1 REQUIRED)
find_package(OpenEXR 3.1 REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(astcenc 4.2 REQUIRED)
find_package(meshoptimizer REQUIRED)
pkg_check_modules(zstd REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(lcms REQUIRED IMPORTED_TARGET lcms2)
pkg_check_modules(draco REQUIRED IMPORTED_TARGET draco)
pkg_check_modules(webp REQUIRED IMPORTED_TARGET libwebp libwebpmux)

add_library(domelight_common_headers OBJECT ${PROJECT_SOURCE_DIR}/cmake/common_headers.cpp)
target_compile_features(domelight_common_headers PRIVATE cxx_std_20)
target_link_libraries(domelight_common_headers PRIVATE domelight_flags fmt::fmt)
target_precompile_headers(domelight_common_headers PRIVATE ${domelight_common_headers} <fmt/format.h>)

domelight_component(io ROOMS texture io scene engines probe USES core
                    LINKS fmt::fmt OpenEXR::OpenEXR Imath::Imath PNG::PNG JPEG::JPEG OpenSSL::Crypto nlohmann_json::nlohmann_json astcenc::astcenc
                          meshoptimizer::meshoptimizer PkgConfig::zstd PkgConfig::lcms PkgConfig::draco PkgConfig::webp PkgConfig::hwy Threads::Threads)
domelight_component(preview ROOMS preview USES core LINKS fmt::fmt)
find_package(embree 3.13 REQUIRED)
domelight_component(render ROOMS render USES io LINKS fmt::fmt embree Threads::Threads)
pkg_check_modules(httplib REQUIRED IMPORTED_TARGET cpp-httplib)
domelight_component(view ROOMS view USES render LINKS fmt::fmt PkgConfig::httplib Threads::Threads)
domelight_component(bake ROOMS bake compare convert USES io preview LINKS fmt::fmt)
domelight_component(capture ROOMS capture USES render bake LINKS fmt::fmt)
domelight_component(study ROOMS study USES render bake LINKS fmt::fmt)
domelight_component(batch SEPARATE ROOMS batch USES capture LINKS fmt::fmt)
include(cmake/c_interface.cmake)
if(domelight_unassigned)
  message(FATAL_ERROR "These files of src/ are in no component of cmake/components.cmake: ${domelight_unassigned}")
endif()

# The C++ components; the C interface is linked by itself.
add_library(domelight INTERFACE)
add_library(domelight::domelight ALIAS domelight)
list(TRANSFORM domelight_components PREPEND domelight_ OUTPUT_VARIABLE domelight_component_targets)
target_link_libraries(domelight INTERFACE ${domelight_component_targets})
