# libterrella.so: all libraries that applications link. It exports what the public headers declare and nothing else.
find_package(glm REQUIRED)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
set(parts base geo text codecs tiles view surface sky objects shaders render globe streaming cut)
list(TRANSFORM parts PREPEND terrella_)
list(TRANSFORM parts REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
add_library(terrella_shared SHARED ${objects})
target_link_libraries(terrella_shared PRIVATE ${parts} PUBLIC glm::glm PkgConfig::EPOXY)
target_link_options(terrella_shared PRIVATE -Wl,--no-undefined)
target_compile_features(terrella_shared PUBLIC cxx_std_20)
target_include_directories(terrella_shared INTERFACE $<BUILD_INTERFACE:${terrella_headers}>)
# Versions with the same first two numbers are compatible.
set_target_properties(terrella_shared PROPERTIES OUTPUT_NAME terrella EXPORT_NAME terrella LINKER_LANGUAGE CXX
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
foreach(component terrella streaming cut)
  add_library(Terrella::${component} ALIAS terrella_shared)
endforeach()
