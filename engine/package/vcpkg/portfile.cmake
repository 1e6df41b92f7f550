# vcpkg install terrella --overlay-ports=engine/package/vcpkg: the libraries of this source tree.
vcpkg_cmake_configure(SOURCE_PATH ${CMAKE_CURRENT_LIST_DIR}/../../..
  OPTIONS -DTERRELLA_APPS=OFF -DTERRELLA_INSTALL=ON -DBUILD_TESTING=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/Terrella)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE ${CURRENT_PACKAGES_DIR}/debug/include)
vcpkg_install_copyright(FILE_LIST ${CMAKE_CURRENT_LIST_DIR}/../../../LICENSE)
