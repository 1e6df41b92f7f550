# Headers that an application includes, as <terrella/globe.h> and so on. Headers that these include are public with
# them. No other header is installed.
set(TERRELLA_PUBLIC_HEADERS
  engine/globe/data_files.h
  engine/globe/globe.h
  engine/globe/features/point_clusters.h
  engine/globe/features/shown_features.h
  engine/geo/great_circle.h
  engine/geo/ranges.h
  engine/geo/measure.h
  engine/geo/split_position.h
  engine/render/caller_glsl.h
  engine/render/gl/offscreen.h
  engine/objects/graticule.h
  engine/view/navigation.h
  engine/sky/star_catalogue.h
  streaming/cache/tile_cache.h
  streaming/cut.h
  engine/codecs/image.h
  engine/codecs/numbers.h
  streaming/objects/feature_style.h
  streaming/objects/geojson_objects.h
  streaming/objects/vector_objects.h
  streaming/preload/preloader.h
  streaming/remote/describe_remote.h
  streaming/remote/grid_check.h
  streaming/remote/remote_source.h
  streaming/sets/open_tile_set.h
  engine/tiles/painted_tiles.h
  engine/tiles/tile_source.h)

# Finds the header of the source tree that an include of another header means; empty: none of the project's.
function(terrella_find_header source include out)
  foreach(root engine/ "")
    if(EXISTS ${source}/${root}${include})
      set(${out} ${root}${include} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  set(${out} "" PARENT_SCOPE)
endfunction()

# All public headers, as paths in the source tree.
function(terrella_public_headers source out)
  set(found)
  set(next ${TERRELLA_PUBLIC_HEADERS})
  while(next)
    list(POP_FRONT next header)
    if(header IN_LIST found)
      continue()
    endif()
    list(APPEND found ${header})
    file(STRINGS ${source}/${header} includes REGEX "^#include \"")
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" include "${line}")
      terrella_find_header(${source} ${include} inner)
      if(inner)
        list(APPEND next ${inner})
      endif()
    endforeach()
  endwhile()
  set(${out} ${found} PARENT_SCOPE)
endfunction()

# Documents that the public headers name, as paths in the source tree.
function(terrella_header_documents source out)
  terrella_public_headers(${source} headers)
  set(found)
  foreach(header IN LISTS headers)
    file(READ ${source}/${header} text)
    string(REGEX MATCHALL "[A-Za-z_/]+\\.md" documents "${text}")
    list(APPEND found ${documents})
  endforeach()
  list(REMOVE_DUPLICATES found)
  set(${out} ${found} PARENT_SCOPE)
endfunction()

# The name under include/terrella: globe.h for engine/globe/globe.h, codecs/image.h for engine/codecs/image.h.
function(terrella_installed_header header out)
  string(REGEX REPLACE "^engine/(globe/globe.h$)?" "" installed ${header})
  if(NOT installed)
    set(installed globe.h)
  endif()
  set(${out} ${installed} PARENT_SCOPE)
endfunction()

# Fills `folder` with the public headers, as they lie when installed. They include each other as <terrella/geo/camera.h>,
# so that an application may have a geo/camera.h of its own. An edited header makes CMake run again.
function(terrella_write_headers source folder)
  terrella_public_headers(${source} headers)
  set(written)
  foreach(header IN LISTS headers)
    terrella_installed_header(${header} installed)
    file(READ ${source}/${header} text)
    file(STRINGS ${source}/${header} includes REGEX "^#include \"")
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" include "${line}")
      terrella_find_header(${source} ${include} inner)
      if(inner)
        terrella_installed_header(${inner} inner)
        string(REPLACE "#include \"${include}\"" "#include <terrella/${inner}>" text "${text}")
      endif()
    endforeach()
    set(before)
    if(EXISTS ${folder}/${installed})
      file(READ ${folder}/${installed} before)
    endif()
    if(NOT before STREQUAL text)  # an untouched header is not compiled again
      file(WRITE ${folder}/${installed} "${text}")
    endif()
    list(APPEND written ${folder}/${installed})
  endforeach()
  file(GLOB_RECURSE old ${folder}/*.h)
  list(REMOVE_ITEM old ${written})
  if(old)
    file(REMOVE ${old})
  endif()
  list(TRANSFORM headers PREPEND ${source}/)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${headers})
endfunction()

# Fills `folder` with headers that give the declarations of the public headers default visibility, as the sources of the
# project include them: "geo/camera.h". All other symbols of libterrella.so are hidden.
function(terrella_export_headers source folder)
  terrella_public_headers(${source} headers)
  foreach(header IN LISTS headers)
    string(REGEX REPLACE "^engine/" "" included ${header})
    file(CONFIGURE OUTPUT ${folder}/${included} CONTENT "#pragma once
#pragma GCC visibility push(default)
#include \"@source@/@header@\"
#pragma GCC visibility pop
" @ONLY)
  endforeach()
endfunction()
