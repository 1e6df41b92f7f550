# Writes OUTPUT, a source that defines embedded_shaders() (embedded_shaders.h) with the text of each of FILES.
set(text "#include \"shaders/embedded_shaders.h\"\n\nnamespace terrella {\n\nstd::span<const EmbeddedShader> embedded_shaders() {\n  static constexpr EmbeddedShader shaders[] = {\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  file(READ ${file} body)
  string(APPEND text "      {\"${name}\", R\"glsl(${body})glsl\"},\n")
endforeach()
string(APPEND text "  };\n  return shaders;\n}\n\n}  // namespace terrella\n")
file(WRITE ${OUTPUT} "${text}")
