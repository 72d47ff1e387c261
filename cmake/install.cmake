# A stranger's project finds the library with find_package(domelight) and links domelight::domelight.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS domelight EXPORT domelight-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY include/domelight DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT domelight-targets NAMESPACE domelight:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/domelight)
configure_package_config_file(cmake/domelight-config.cmake.in domelight-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/domelight)
write_basic_package_version_file(domelight-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/domelight-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/domelight-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/domelight)
if(TARGET domelight_program)
  install(TARGETS domelight_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
