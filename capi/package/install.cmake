# Installation: the library (component runtime), header, CMake and pkg-config files (component development).
# The command line's own list installs it (component cli).
include(CMakePackageConfigHelpers)

set(cmake_files ${CMAKE_INSTALL_LIBDIR}/cmake/brinell)
set(pkgconfig_files ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(TARGETS brinell EXPORT brinell_targets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT brinell_targets NAMESPACE brinell:: FILE brinellTargets.cmake
  DESTINATION ${cmake_files} COMPONENT development)

configure_package_config_file(package/brinellConfig.cmake.in brinellConfig.cmake
  INSTALL_DESTINATION ${cmake_files} NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(brinellConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/brinellConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/brinellConfigVersion.cmake
  DESTINATION ${cmake_files} COMPONENT development)

# The prefix is found from where the file lies, so that an installed tree may be moved.
file(RELATIVE_PATH prefix_from_pkgconfig /prefix/${pkgconfig_files} /prefix)
string(REGEX REPLACE "/$" "" prefix_from_pkgconfig ${prefix_from_pkgconfig})
configure_file(package/brinell.pc.in brinell.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/brinell.pc DESTINATION ${pkgconfig_files} COMPONENT development)

file(READ ${PROJECT_SOURCE_DIR}/LICENSE licence)
configure_file(package/copyright.in copyright @ONLY)
set(package_runtime libbrinell${library_abi})
set(package_development libbrinell-dev)
set(package_cli brinell)
foreach(component runtime development cli)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/copyright
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package_${component}} COMPONENT ${component})
endforeach()
file(GLOB example_sources CONFIGURE_DEPENDS examples/*.c)
install(FILES ${example_sources} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libbrinell-dev/examples
  COMPONENT development)
