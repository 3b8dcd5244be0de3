# What an outside project finds: find_package(hexdbb) with hexdbb::kinematics, and hexdbb::diagnosis where Ceres is; or
# pkg-config hexdbb, hexdbb-diagnosis. The Python package installs its own component and none of this.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(HEXDBB_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/hexdbb)
set(HEXDBB_INSTALLED kinematics)
if(HEXDBB_DIAGNOSIS)
  list(APPEND HEXDBB_INSTALLED diagnosis)
endif()

foreach(part ${HEXDBB_INSTALLED})
  set_target_properties(hexdbb_${part} PROPERTIES EXPORT_NAME ${part})
  install(TARGETS hexdbb_${part} EXPORT hexdbb-${part}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(EXPORT hexdbb-${part} NAMESPACE hexdbb:: DESTINATION ${HEXDBB_CMAKE_DIR} COMPONENT development)
endforeach()

install(DIRECTORY include/hexdbb DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)

configure_package_config_file(cmake/hexdbb-config.cmake.in hexdbb-config.cmake INSTALL_DESTINATION ${HEXDBB_CMAKE_DIR})
write_basic_package_version_file(hexdbb-config-version.cmake COMPATIBILITY SameMinorVersion)
# Relative, so that an installed tree may be moved.
file(RELATIVE_PATH HEXDBB_PREFIX_FROM_PC /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/hexdbb.pc.in hexdbb.pc @ONLY)
configure_file(cmake/hexdbb-diagnosis.pc.in hexdbb-diagnosis.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hexdbb-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/hexdbb-config-version.cmake
  DESTINATION ${HEXDBB_CMAKE_DIR} COMPONENT development)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hexdbb.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
if(HEXDBB_DIAGNOSIS)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hexdbb-diagnosis.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endif()
