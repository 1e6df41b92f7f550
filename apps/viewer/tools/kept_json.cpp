#include "apps/viewer/tools/kept_json.h"

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "apps/process/write_file.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"

namespace terrella {

Result<nlohmann::json> read_kept_json(const std::filesystem::path& file) {
  constexpr std::size_t kMostBytes = 1UL << 20;
  const auto bytes = read_file(file, kMostBytes);
  if (!bytes && bytes.error().problem == FileProblem::missing) return nlohmann::json();
  if (!bytes) return Error{bytes.error().message};
  const std::string_view text = as_text(*bytes);
  return parse_json_object(text, kMostBytes, file.string());
}

Status write_kept_json(const std::filesystem::path& file, const nlohmann::json& json) {
  return write_kept_text(file, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

Status write_kept_text(const std::filesystem::path& file, std::string_view text) {
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (failed) return Error{file.parent_path().string() + ": " + failed.message()};
  return write_file(file, std::as_bytes(std::span(text)));
}

std::string set_aside(const std::filesystem::path& file, const std::string& complaint) {
  std::filesystem::path copy = file;
  copy += ".damaged";
  std::error_code failed;
  std::filesystem::copy_file(file, copy, std::filesystem::copy_options::overwrite_existing, failed);
  return complaint + "; it is ignored" + (failed ? "" : ", and a copy is kept in " + copy.filename().string());
}

}  // namespace terrella
