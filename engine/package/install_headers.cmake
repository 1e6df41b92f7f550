# Runs when the project is installed. Install.cmake sets TERRELLA_SOURCE and TERRELLA_INCLUDE_DIR.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/public_headers.cmake)
terrella_public_headers(${TERRELLA_SOURCE} headers)
foreach(header IN LISTS headers)
  terrella_installed_header(${header} installed)
  cmake_path(GET installed PARENT_PATH folder)
  file(INSTALL ${TERRELLA_SOURCE}/${header} DESTINATION ${TERRELLA_INCLUDE_DIR}/${folder})
endforeach()
