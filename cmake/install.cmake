# What cmake --install puts where, in three parts, which cpack makes a Debian package each of:
#
#   program      the program with its manual pages, completions and the shaders that read what it bakes
#   c            the shared library of the C interface
#   development  headers, static libraries, CMake packages and pkg-config file
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(domelight_package ${CMAKE_INSTALL_LIBDIR}/cmake/domelight)

# The C++ components. A stranger's project finds them with find_package(domelight [COMPONENTS core ...]) and links domelight::domelight, or the components
# that it uses. Shared ones belong to whoever runs the program.
foreach(component ${domelight_components})
  install(TARGETS domelight_${component} EXPORT domelight-targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT program NAMELINK_COMPONENT development)
endforeach()
if(TARGET domelight)
  install(TARGETS domelight EXPORT domelight-targets)
endif()
install(DIRECTORY include/domelight ${PROJECT_BINARY_DIR}/include/domelight DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development FILES_MATCHING PATTERN "*.h")
install(EXPORT domelight-targets NAMESPACE domelight:: DESTINATION ${domelight_package} COMPONENT development)

# The C interface, in an export of its own: who links it needs no compiler of C++ and none of the libraries inside it.
set(domelight_installed_components ${domelight_components})
if(TARGET domelight_c)
  list(APPEND domelight_installed_components c)
  install(TARGETS domelight_c EXPORT domelight-c-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT c NAMELINK_COMPONENT development)
  install(EXPORT domelight-c-targets NAMESPACE domelight:: DESTINATION ${domelight_package} COMPONENT development)
  # Relative to the file itself, so that the prefix can be moved.
  file(RELATIVE_PATH domelight_pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(cmake/domelight_c.pc.in domelight_c.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/domelight_c.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endif()

configure_package_config_file(cmake/domelight-config.cmake.in domelight-config.cmake INSTALL_DESTINATION ${domelight_package})
write_basic_package_version_file(domelight-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/domelight-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/domelight-config-version.cmake DESTINATION ${domelight_package}
        COMPONENT development)

if(TARGET domelight_program)
  install(TARGETS domelight_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  # The program writes its manual pages and completions itself, from the tables of its options.
  set(domelight_manual ${CMAKE_CURRENT_BINARY_DIR}/manual)
  add_custom_command(OUTPUT ${domelight_manual}.stamp
                     COMMAND ${CMAKE_COMMAND} -E make_directory ${domelight_manual}
                     COMMAND domelight_program manual ${domelight_manual}
                     COMMAND ${CMAKE_COMMAND} -E touch ${domelight_manual}.stamp
                     DEPENDS domelight_program COMMENT "Writing the manual pages and completions" VERBATIM)
  add_custom_target(domelight_manual ALL DEPENDS ${domelight_manual}.stamp)
  install(DIRECTORY ${domelight_manual}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program FILES_MATCHING PATTERN "*.1")
  install(FILES ${domelight_manual}/domelight DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
  # zsh looks into the first of these below /usr/local, and Debian's zsh into the second below /usr.
  install(FILES ${domelight_manual}/_domelight DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT program)
  install(FILES ${domelight_manual}/_domelight DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)
  install(FILES ${domelight_manual}/domelight.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT program)
  install(DIRECTORY docs/shaders/ DESTINATION ${CMAKE_INSTALL_DATADIR}/domelight/shaders COMPONENT program)
  # The browser app, where web/build.sh has made it.
  install(DIRECTORY build/web/ DESTINATION ${CMAKE_INSTALL_DATADIR}/domelight/web COMPONENT program OPTIONAL)
  install(FILES LICENSE NOTICE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
endif()
if(TARGET domelight_c)
  install(FILES LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libdomelight-c${domelight_c_abi} COMPONENT c)
endif()
install(FILES LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libdomelight-dev COMPONENT development)
