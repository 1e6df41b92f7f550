# The libraries, their headers and a package description: find_package(Terrella) and link Terrella::terrella.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Terrella)
set(libraries terrella_geo terrella_scene terrella_streaming terrella_cut terrella_shaders terrella_render terrella)
foreach(library IN LISTS libraries)
  if(TARGET ${library})
    install(TARGETS ${library} EXPORT TerrellaTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  endif()
endforeach()
install(EXPORT TerrellaTargets NAMESPACE Terrella:: DESTINATION ${package_dir})

# Installed as they lie in the source: includes read the same in both.
set(include_dir ${CMAKE_INSTALL_INCLUDEDIR}/terrella)
install(DIRECTORY engine/geo engine/scene engine/render streaming DESTINATION ${include_dir} FILES_MATCHING PATTERN *.h)
install(FILES engine/globe.h DESTINATION ${include_dir}/engine)

configure_package_config_file(engine/package/TerrellaConfig.cmake.in ${PROJECT_BINARY_DIR}/TerrellaConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/TerrellaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/TerrellaConfig.cmake ${PROJECT_BINARY_DIR}/TerrellaConfigVersion.cmake
  DESTINATION ${package_dir})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/terrella)
