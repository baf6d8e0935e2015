# cmake --install, find_package(volcomp), pkg-config and cpack: docs/packages.md.
#
# Two components: dev (libraries and headers, needs Eigen) and tools (command line tool, node and the machines they know).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(volcomp_headers "${CMAKE_INSTALL_INCLUDEDIR}/volcomp")
set(volcomp_config "${CMAKE_INSTALL_LIBDIR}/cmake/volcomp")
set(volcomp_made "${PROJECT_BINARY_DIR}/package_files")

set_target_properties(volcomp_comp PROPERTIES EXPORT_NAME comp)
set_target_properties(volcomp_metrology PROPERTIES EXPORT_NAME metrology)
set_target_properties(volcomp_eigen PROPERTIES EXPORT_NAME eigen)
target_include_directories(volcomp_eigen INTERFACE "$<INSTALL_INTERFACE:${volcomp_headers}>")
target_include_directories(volcomp_c INTERFACE "$<INSTALL_INTERFACE:${volcomp_headers}>")
install(TARGETS volcomp_comp volcomp_metrology volcomp_c volcomp_eigen EXPORT volcomp
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT dev)
install(EXPORT volcomp NAMESPACE volcomp:: FILE volcomp-targets.cmake DESTINATION "${volcomp_config}" COMPONENT dev)

# The headers lie in folders of the names they are included by; volcomp.h beside them.
install(DIRECTORY comp DESTINATION "${volcomp_headers}" COMPONENT dev
  FILES_MATCHING PATTERN "*.hpp" PATTERN "*.inl" PATTERN "*.def")
install(FILES firmware/embed/cpp/axis_port.hpp firmware/embed/cpp/servo_loop.hpp
  DESTINATION "${volcomp_headers}/firmware/embed/cpp" COMPONENT dev)
install(FILES firmware/embed/c/volcomp.h DESTINATION "${volcomp_headers}" COMPONENT dev)
# LinuxCNC's components are built on the machine they run on.
install(FILES firmware/embed/linuxcnc/volcomp.c firmware/embed/linuxcnc/volcomp.hal firmware/embed/linuxcnc/Makefile
  DESTINATION "${CMAKE_INSTALL_DATADIR}/volcomp/linuxcnc" COMPONENT dev)

configure_package_config_file(toolchain/cmake/volcomp-config.cmake.in "${volcomp_made}/volcomp-config.cmake"
  INSTALL_DESTINATION "${volcomp_config}")
write_basic_package_version_file("${volcomp_made}/volcomp-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${volcomp_made}/volcomp-config.cmake" "${volcomp_made}/volcomp-config-version.cmake" comp/eigen.cmake
  DESTINATION "${volcomp_config}" COMPONENT dev)

# The folders relative to that of the .pc files: what is installed may be moved.
file(RELATIVE_PATH volcomp_headers_from_lib "/${CMAKE_INSTALL_LIBDIR}" "/${volcomp_headers}")
foreach(package volcomp volcomp_c)
  configure_file("toolchain/cmake/${package}.pc.in" "${volcomp_made}/${package}.pc" @ONLY)
  install(FILES "${volcomp_made}/${package}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT dev)
endforeach()

if(VOLCOMP_BUILD_HOST_SIM)
  install(TARGETS volcomp volcomp-node RUNTIME COMPONENT tools)
  install(DIRECTORY host_sim/machines host_sim/drives host_sim/plans DESTINATION "${CMAKE_INSTALL_DATADIR}/volcomp" COMPONENT tools)
  install(FILES firmware/posix/volcomp-node@.service DESTINATION lib/systemd/system COMPONENT tools)
  install(FILES firmware/embed/cpp/xyfz.vct firmware/volcomp.eds firmware/volcomp.dbc
    DESTINATION "${CMAKE_INSTALL_DATADIR}/volcomp" COMPONENT tools)
endif()

# Manual page and completions of the program, where man and shells look for them (zsh and fish: Debian's folders).
# Instrumented programs are not installed.
if(VOLCOMP_BUILD_HOST_SIM AND NOT VOLCOMP_SANITIZE AND NOT VOLCOMP_COVERAGE AND NOT VOLCOMP_FUZZ)
  file(MAKE_DIRECTORY "${volcomp_made}")
  add_custom_command(
    OUTPUT "${volcomp_made}/volcomp.1" "${volcomp_made}/volcomp.bash" "${volcomp_made}/_volcomp" "${volcomp_made}/volcomp.fish"
    COMMAND volcomp man > "${volcomp_made}/volcomp.1"
    COMMAND volcomp completion bash > "${volcomp_made}/volcomp.bash"
    COMMAND volcomp completion zsh > "${volcomp_made}/_volcomp"
    COMMAND volcomp completion fish > "${volcomp_made}/volcomp.fish"
    DEPENDS volcomp)
  add_custom_target(volcomp_shell_files ALL DEPENDS "${volcomp_made}/volcomp.1")
  install(FILES "${volcomp_made}/volcomp.1" firmware/posix/volcomp-node.1
    DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT tools)
  install(FILES "${volcomp_made}/volcomp.bash"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME volcomp COMPONENT tools)
  install(FILES "${volcomp_made}/_volcomp" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions" COMPONENT tools)
  install(FILES "${volcomp_made}/volcomp.fish"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" COMPONENT tools)
endif()
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/libvolcomp-dev" RENAME copyright COMPONENT dev)
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/volcomp" RENAME copyright COMPONENT tools)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "volcomp")
set(CPACK_PACKAGE_VENDOR "volcomp")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL dev)
if(VOLCOMP_BUILD_HOST_SIM)
  list(APPEND CPACK_COMPONENTS_ALL tools)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libvolcomp-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEV_DESCRIPTION "${PROJECT_DESCRIPTION}: libraries and headers")
set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME volcomp)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TOOLS_DESCRIPTION "${PROJECT_DESCRIPTION}: command line tool and CANopen node")
include(CPack)
