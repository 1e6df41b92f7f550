# What an application includes, as <terrella/globe.h> and so on; what these include in turn is public with them. Nothing else is installed.
set(TERRELLA_PUBLIC_HEADERS
  engine/globe/data_files.h
  engine/globe/globe.h
  engine/geo/great_circle.h
  engine/geo/measure.h
  engine/render/caller_glsl.h
  engine/render/gl/offscreen.h
  engine/objects/graticule.h
  engine/view/navigation.h
  engine/sky/star_catalogue.h
  streaming/cache/tile_cache.h
  streaming/cut.h
  engine/codecs/image.h
  engine/codecs/numbers.h
  streaming/objects/geojson_objects.h
  streaming/preload/preloader.h
  streaming/remote/describe_remote.h
  streaming/remote/grid_check.h
  streaming/remote/remote_source.h
  streaming/sets/open_tile_set.h
  engine/tiles/tile_source.h)

# Which header of the source tree an include of another means; empty: none of the project's.
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

# The name under include/terrella: globe.h for engine/globe/globe.h, codecs/image.h for engine/codecs/image.h.
function(terrella_installed_header header out)
  string(REGEX REPLACE "^engine/(globe/globe.h$)?" "" installed ${header})
  if(NOT installed)
    set(installed globe.h)
  endif()
  set(${out} ${installed} PARENT_SCOPE)
endfunction()

# Fills `folder` with links to the public headers, as they lie when installed. An edited header may include another one, so
# that CMake then runs again.
function(terrella_link_headers source folder)
  terrella_public_headers(${source} headers)
  file(REMOVE_RECURSE ${folder})
  foreach(header IN LISTS headers)
    terrella_installed_header(${header} installed)
    cmake_path(GET installed PARENT_PATH parent)
    file(MAKE_DIRECTORY ${folder}/${parent})
    file(CREATE_LINK ${source}/${header} ${folder}/${installed} SYMBOLIC)
  endforeach()
  list(TRANSFORM headers PREPEND ${source}/)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${headers})
endfunction()
