# The default BRDF table is computed once, here, and embedded: the program needs no time for it.
add_executable(make_brdf_table ${PROJECT_SOURCE_DIR}/cmake/make_brdf_table.cpp ${PROJECT_SOURCE_DIR}/src/filtering/brdf/brdf_quadrature.cpp
               ${PROJECT_SOURCE_DIR}/src/base/gauss_legendre.cpp)
target_include_directories(make_brdf_table PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
# The library's own arithmetic, whatever else (sanitizers) a configuration adds: the same bits in every build.
target_compile_options(make_brdf_table PRIVATE -O2 -fno-math-errno -fno-trapping-math -ffp-contract=off)
add_custom_command(OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/brdf_table_default.cpp
                   COMMAND make_brdf_table ${CMAKE_CURRENT_BINARY_DIR}/brdf_table_default.cpp
                   DEPENDS make_brdf_table COMMENT "Integrating the default BRDF table" VERBATIM)
target_sources(domelight_core PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/brdf_table_default.cpp)
