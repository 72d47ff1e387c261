# ccache where it is installed: the second build of anything is quick.
find_program(DOMELIGHT_CCACHE ccache)
if(DOMELIGHT_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${DOMELIGHT_CCACHE})
endif()
