# When the project is installed: engine/globe.h becomes terrella/globe.h and streaming/image.h terrella/streaming/image.h, so that
# includes read the same here and there. TERRELLA_SOURCE and TERRELLA_INCLUDE_DIR are set by Install.cmake.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/public_headers.cmake)
terrella_public_headers(${TERRELLA_SOURCE} headers)
foreach(header IN LISTS headers)
  string(REGEX REPLACE "^engine/" "" installed ${header})
  get_filename_component(folder ${installed} DIRECTORY)
  file(INSTALL ${TERRELLA_SOURCE}/${header} DESTINATION ${TERRELLA_INCLUDE_DIR}/${folder})
endforeach()
