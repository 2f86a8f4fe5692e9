# install.cmake: what does `cmake --install` leave behind?
#
# A package with one target for the core and one for each wing, each in an export set of its own, so that a project that
# uses the core alone never looks for OpenImageIO. tests/install builds projects against it.
include(CMakePackageConfigHelpers)
set(BOXWOOD_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/boxwood)

function(boxwood_install target export_set)
  install(TARGETS ${target} EXPORT ${export_set}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(EXPORT ${export_set} NAMESPACE boxwood:: DESTINATION ${BOXWOOD_PACKAGE_DIR})
endfunction()

boxwood_install(boxwood boxwood_core_targets)
if(BOXWOOD_BUILD_APP)
  boxwood_install(boxwood_io boxwood_io_targets)
  boxwood_install(boxwood_render boxwood_render_targets)
  install(TARGETS boxwood_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(FILES cmake/FindOpenImageIO.cmake DESTINATION ${BOXWOOD_PACKAGE_DIR})
  set(not_installed "")
else()
  set(not_installed REGEX "/(io|render)$" EXCLUDE)
endif()

install(DIRECTORY src/boxwood DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h"
  PATTERN "*-inl.h" EXCLUDE ${not_installed})
configure_package_config_file(cmake/boxwoodConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/boxwoodConfig.cmake
  INSTALL_DESTINATION ${BOXWOOD_PACKAGE_DIR})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/boxwoodConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/boxwoodConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/boxwoodConfigVersion.cmake
  DESTINATION ${BOXWOOD_PACKAGE_DIR})
