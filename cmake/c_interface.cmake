# The C interface (include/domelight/domelight_c.h) as a shared library of its own, whatever the components are: a program in any language links it or loads it
# at run time. The components are inside it, and none of their symbols is visible.

# One number in one place: the header's.
file(STRINGS include/domelight/domelight_c.h domelight_c_abi REGEX "define DOMELIGHT_C_ABI_VERSION")
string(REGEX MATCH "[0-9]+" domelight_c_abi "${domelight_c_abi}")

set(domelight_c_sources ${domelight_unassigned})
list(FILTER domelight_c_sources INCLUDE REGEX "^c/")
list(REMOVE_ITEM domelight_unassigned ${domelight_c_sources})
list(TRANSFORM domelight_c_sources PREPEND ${PROJECT_SOURCE_DIR}/src/)

add_library(domelight_c SHARED ${domelight_c_sources})
add_library(domelight::c ALIAS domelight_c)
target_include_directories(domelight_c PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>" $<INSTALL_INTERFACE:include> PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_compile_features(domelight_c PRIVATE cxx_std_20)
target_link_libraries(domelight_c PRIVATE $<BUILD_INTERFACE:domelight_bake> $<BUILD_INTERFACE:domelight_flags>)
set_target_properties(domelight_c PROPERTIES EXPORT_NAME c CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
                      SOVERSION ${domelight_c_abi} VERSION ${domelight_c_abi}.${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
# The components are compiled with visible symbols, because they may be shared libraries themselves. The linkers of ELF hide them by a list.
if(UNIX AND NOT APPLE)
  target_link_options(domelight_c PRIVATE -Wl,--version-script=${CMAKE_CURRENT_LIST_DIR}/domelight_c.map $<$<NOT:$<BOOL:${DOMELIGHT_SANITIZE}>>:-Wl,-z,defs>)
  set_target_properties(domelight_c PROPERTIES LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/domelight_c.map)
endif()
