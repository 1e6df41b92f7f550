# cpack -G DEB: terrella, the program with its data; libterrella-dev, what other programs are built with; and
# python3-terrella, the Python module.
set(CPACK_PACKAGE_NAME terrella)
set(CPACK_PACKAGE_VENDOR "Terrella developers")
set(CPACK_PACKAGE_CONTACT "Terrella developers <terrella@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_ALL program development)
if(TARGET terrella_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
if(BUILD_SHARED_LIBS)
  list(APPEND CPACK_COMPONENTS_ALL library)
endif()

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME terrella)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# Libraries opened at run time, which shlibdeps does not see.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libegl1, libgl1")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libgdal32, libgl1-mesa-dri, libegl-mesa0")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS gnuplot-nox)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Looks at the Earth, or at any planet that there is an equirectangular picture of, of any size.
Cuts pictures into tiles, streams tiles from servers and fills caches with them.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libterrella-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
string(CONCAT CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libcurl4-openssl-dev, libepoxy-dev, liberfa-dev, libexif-dev, libfmt-dev, libfontconfig-dev, libfreetype-dev, libfribidi-dev, "
  "libgeographiclib-dev, libglm-dev, libglu1-mesa-dev, libharfbuzz-dev, libjpeg62-turbo-dev, libpng-dev, libproj-dev, libpugixml-dev, "
  "libsqlite3-dev, libtiff-dev, libtinygltf-dev, libturbojpeg0-dev, libwebp-dev, nlohmann-json3-dev, pkg-config, zlib1g-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS terrella)
get_property(python GLOBAL PROPERTY TERRELLA_PYTHON_VERSIONS)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-terrella)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${python}, python3-numpy, terrella, libegl1, libgl1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "libgdal32, libgl1-mesa-dri, libegl-mesa0")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-distributed)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Globes for notebooks: pictures as numpy arrays, without a display and without a GPU.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libterrella${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS libgdal32)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "The globe as a C++20 library: the shared library.")

set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "The globe as a C++20 library: static libraries, headers, CMake and pkg-config descriptions.")

include(CPack)
