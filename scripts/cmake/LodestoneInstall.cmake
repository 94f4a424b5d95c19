# install(): the program, the libraries with their headers, and a CMake package, so that another project's
# find_package(lodestone) gives targets lodestone::scene, lodestone::geometry_image, lodestone::render, lodestone::host,
# lodestone::cpu_fallback and those below them.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY LODESTONE_LIBRARIES)
install(TARGETS ${libraries} lodestone_options EXPORT lodestoneTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS lodestone RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

foreach(folder src/base src/scene src/mesh src/base_complex src/image src/report src/geometry_image src/render host cpu_fallback shaders/layout)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lodestone FILES_MATCHING PATTERN "*.h")
endforeach()
install(DIRECTORY shaders/embed/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lodestone/kernels FILES_MATCHING PATTERN "*.h")

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/lodestone)
install(EXPORT lodestoneTargets NAMESPACE lodestone:: DESTINATION ${package_folder})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/lodestoneConfig.cmake.in
                              ${CMAKE_BINARY_DIR}/lodestoneConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/lodestoneConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/lodestoneConfig.cmake ${CMAKE_BINARY_DIR}/lodestoneConfigVersion.cmake
        DESTINATION ${package_folder})
