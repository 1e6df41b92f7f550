#include "render/gl/shader_library.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "shaders/embedded_shaders.h"

namespace terrella {
namespace {

std::filesystem::path g_folder;  // set by read_shaders_from()

std::filesystem::path shader_folder() {
#ifndef NDEBUG
  const char* named = std::getenv("TERRELLA_SHADER_DIR");
  if (g_folder.empty() && named != nullptr) return named;
#endif
  return g_folder;
}

}  // namespace

void read_shaders_from(std::filesystem::path folder) { g_folder = std::move(folder); }

std::optional<std::string> shader_text(std::string_view name) {
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(shader_folder(), error)) {
    if (entry.path().filename() != name) continue;
    if (std::ifstream file(entry.path()); file) return (std::ostringstream() << file.rdbuf()).str();
  }
  for (const EmbeddedShader& shader : embedded_shaders()) {
    if (shader.name == name) return std::string(shader.text);
  }
  return std::nullopt;
}

namespace {

bool is_text(std::string_view entry) { return entry.find('\n') != std::string_view::npos; }

std::string joined(const std::vector<std::string_view>& names) {
  std::string all;
  for (std::string_view name : names)
    if (!is_text(name)) all += (all.empty() ? "" : ", ") + std::string(name);
  return all;
}

template <class Get, class Log>
std::string info_log(GLuint name, Get get, Log log) {
  GLint length = 0;
  get(name, GL_INFO_LOG_LENGTH, &length);
  std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
  log(name, length, nullptr, text.data());
  return text;
}

Result<GLuint> compile(const ShaderStage& stage, std::initializer_list<std::string_view> defines) {
  std::string text = "#version 450 core\n";
  for (std::string_view define : defines) text += "#define " + std::string(define) + "\n";
  for (std::string_view file : stage.files) {
    const std::optional<std::string> part = is_text(file) ? std::string(file) : shader_text(file);
    if (!part) return Error{"shader " + std::string(file) + " is missing from this installation"};
    text += "#line 1\n" + *part;
  }
  const GLuint shader = glCreateShader(stage.type);
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint ok = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok == GL_TRUE) return shader;
  Error error{"shader " + joined(stage.files) + ": " + info_log(shader, glGetShaderiv, glGetShaderInfoLog)};
  glDeleteShader(shader);
  return error;
}

}  // namespace

std::string_view depth_define(DepthMode mode) {
  switch (mode) {
    case DepthMode::logarithmic:
      return "DEPTH_LOGARITHMIC";
    case DepthMode::standard:
      return "DEPTH_STANDARD";
    case DepthMode::reversed:
      break;
  }
  return "DEPTH_REVERSED";
}

Result<gl::Program> build_program(std::initializer_list<ShaderStage> stages,
                                  std::initializer_list<std::string_view> defines,
                                  std::initializer_list<const char*> feedback) {
  gl::Program program(glCreateProgram());
  for (const ShaderStage& stage : stages) {
    const Result<GLuint> shader = compile(stage, defines);
    if (!shader) return shader.error();
    glAttachShader(program.name(), *shader);
    glDeleteShader(*shader);
  }
  if (feedback.size() > 0) {
    glTransformFeedbackVaryings(program.name(), static_cast<GLsizei>(feedback.size()), std::data(feedback),
                                GL_INTERLEAVED_ATTRIBS);
  }
  glLinkProgram(program.name());
  const std::vector<std::string_view>& last = std::prev(stages.end())->files;
  const std::string_view name = *std::find_if_not(last.rbegin(), last.rend(), is_text);
  glObjectLabel(GL_PROGRAM, program.name(), static_cast<GLsizei>(name.size()), name.data());
  GLint ok = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &ok);
  if (ok == GL_TRUE) return program;
  return Error{"program of " + joined(stages.begin()[stages.size() - 1].files) + ": " +
               info_log(program.name(), glGetProgramiv, glGetProgramInfoLog)};
}

Status build_into(gl::Program& place, std::initializer_list<ShaderStage> stages,
                  std::initializer_list<std::string_view> defines) {
  Result<gl::Program> program = build_program(stages, defines);
  if (!program) return program.error();
  place = std::move(*program);
  return Done{};
}

}  // namespace terrella
