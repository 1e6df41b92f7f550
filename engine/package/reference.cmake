# cmake -DOUTPUT=FOLDER -P engine/package/reference.cmake: the API reference in FOLDER/html. Fails on a warning.
cmake_minimum_required(VERSION 3.25)
cmake_path(SET source NORMALIZE ${CMAKE_CURRENT_LIST_DIR}/../..)
include(${CMAKE_CURRENT_LIST_DIR}/public_headers.cmake)
terrella_public_headers(${source} headers)
list(JOIN headers " " input)

file(MAKE_DIRECTORY ${OUTPUT})
file(READ ${CMAKE_CURRENT_LIST_DIR}/Doxyfile settings)
file(WRITE ${OUTPUT}/Doxyfile "${settings}
INPUT = engine/README.md ${input}
STRIP_FROM_PATH = ${source}
STRIP_FROM_INC_PATH = ${source} ${source}/engine
IMAGE_PATH = ${source}/engine/drawings
OUTPUT_DIRECTORY = ${OUTPUT}
WARN_LOGFILE = ${OUTPUT}/warnings.txt
")
execute_process(COMMAND doxygen ${OUTPUT}/Doxyfile WORKING_DIRECTORY ${source} COMMAND_ERROR_IS_FATAL ANY)
file(READ ${OUTPUT}/warnings.txt warnings)
if(warnings)
  message(FATAL_ERROR "Doxygen warns:\n${warnings}")
endif()
