# Packages of Debian for the controller PC, made by `make deb`: the library to compile against, and LinuxCNC's module where
# it was built. Names of files and folders are those of Debian with the prefix /usr (preset `deb`).
include(GNUInstallDirs)
install(DIRECTORY firmware_interfaces/linuxcnc DESTINATION ${CMAKE_INSTALL_DATADIR}/hexdbb COMPONENT development)
install(FILES firmware_interfaces/ballbar_gauge.eds firmware_interfaces/hexglider_drive.eds
  firmware_interfaces/ballbar_gauge_od.h firmware_interfaces/hexglider_drive_od.h
  DESTINATION ${CMAKE_INSTALL_DATADIR}/hexdbb/canopen COMPONENT development)
install(FILES cpp/licences/debian-copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libhexdbb-dev
  RENAME copyright COMPONENT development)
set(HEXDBB_PACKAGES development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hexdbb)
set(CPACK_PACKAGE_VENDOR hexdbb)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The hexdbb project")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libhexdbb-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
# Diagnosis alone needs Ceres; what a controller does without it.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "libceres-dev (>= 2.1), linuxcnc-uspace-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "Kinematics, compensation and diagnosis of a HexGlider
Static libraries, C++ headers and the C interface, with CMake and pkg-config files;
the source of LinuxCNC's kinematics module with a sample configuration;
EDS files and object dictionaries of the CANopen nodes.")

if(TARGET hexdbb_kins)
  list(APPEND HEXDBB_PACKAGES linuxcnc)
  install(FILES cpp/licences/debian-copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/linuxcnc-hexdbb
    RENAME copyright COMPONENT linuxcnc)
  set(CPACK_DEBIAN_LINUXCNC_PACKAGE_NAME linuxcnc-hexdbb)
  set(CPACK_DEBIAN_LINUXCNC_PACKAGE_SECTION misc)
  set(CPACK_DEBIAN_LINUXCNC_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_LINUXCNC_PACKAGE_DEPENDS "linuxcnc-uspace")
  set(CPACK_COMPONENT_LINUXCNC_DESCRIPTION
    "LinuxCNC's kinematics module of the HexGlider
Forward and inverse kinematics with the compensation of a machine's measured errors.")
endif()
set(CPACK_COMPONENTS_ALL ${HEXDBB_PACKAGES})
include(CPack)
