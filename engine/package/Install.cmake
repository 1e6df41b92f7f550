# The libraries, their public headers and two descriptions of the package: for find_package(Terrella) and for pkg-config.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Terrella)
set(data_dir ${CMAKE_INSTALL_DATADIR}/terrella)

# A component is a set of libraries that is found as a whole: Terrella::terrella, Terrella::streaming, Terrella::cut.
function(terrella_component component)
  install(TARGETS ${ARGN} EXPORT Terrella_${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT Terrella_${component} NAMESPACE Terrella:: DESTINATION ${package_dir} COMPONENT development)
endfunction()
if(BUILD_SHARED_LIBS)
  install(TARGETS terrella_shared EXPORT Terrella_shared
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT Terrella_shared NAMESPACE Terrella:: DESTINATION ${package_dir} COMPONENT development)
else()
  terrella_component(streaming terrella_base terrella_geo terrella_codecs terrella_tiles terrella_streaming)
  terrella_component(cut terrella_cut)
  terrella_component(globe terrella_text terrella_view terrella_surface terrella_sky terrella_objects terrella_shaders terrella_render terrella_globe terrella)

  # cmake --install --strip and cpack: of static libraries CMake strips nothing by itself.
  install(CODE "
  if(CMAKE_INSTALL_DO_STRIP)
    file(GLOB libraries \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/libterrella*.a\")
    execute_process(COMMAND \"${CMAKE_STRIP}\" --strip-debug \${libraries} COMMAND_ERROR_IS_FATAL ANY)
  endif()" COMPONENT development)
endif()

install(DIRECTORY ${terrella_headers}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)

terrella_header_documents(${PROJECT_SOURCE_DIR} documents)
foreach(document IN LISTS documents ITEMS engine/README.md)
  cmake_path(GET document PARENT_PATH folder)
  install(FILES ${PROJECT_SOURCE_DIR}/${document} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/terrella/${folder}
    COMPONENT development)
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/engine/drawings DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/terrella/engine
  COMPONENT development)

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/TerrellaConfig.cmake.in ${PROJECT_BINARY_DIR}/TerrellaConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS data_dir)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/TerrellaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/TerrellaConfig.cmake ${PROJECT_BINARY_DIR}/TerrellaConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT development)

file(RELATIVE_PATH pc_prefix /p/${CMAKE_INSTALL_LIBDIR}/pkgconfig /p)
set(pc_archives "-lterrella_globe -lterrella_render -lterrella_shaders -lterrella_objects -lterrella_sky -lterrella_surface \
-lterrella_view -lterrella_cut -lterrella_streaming -lterrella_tiles -lterrella_codecs -lterrella_text -lterrella_geo -lterrella_base \
-lGeographicLib -ldl -lGLU -pthread")
set(pc_needs "fmt libcurl libpng sqlite3 libtiff-4 proj tinygltf pugixml libturbojpeg libjpeg libwebp libwebpdemux libexif zlib erfa freetype2 \
harfbuzz fribidi fontconfig")
if(BUILD_SHARED_LIBS)
  set(pc_requires "glm epoxy")
  set(pc_libs -lterrella)
else()
  # The libraries are static, so that who links them links what they need; not Requires.private, which would ask for the
  # static libraries of curl too.
  set(pc_requires "glm epoxy ${pc_needs}")
  set(pc_libs "${pc_archives}")
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/terrella.pc.in ${PROJECT_BINARY_DIR}/terrella.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/terrella.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

if(PROJECT_IS_TOP_LEVEL)
  add_custom_target(uninstall COMMAND ${CMAKE_COMMAND} -DMANIFEST=${PROJECT_BINARY_DIR}/install_manifest.txt
    -P ${CMAKE_CURRENT_LIST_DIR}/uninstall.cmake VERBATIM)
endif()
if(TERRELLA_APPS)
  include(${CMAKE_CURRENT_LIST_DIR}/linux/Linux.cmake)
  include(${CMAKE_CURRENT_LIST_DIR}/Debian.cmake)
endif()
