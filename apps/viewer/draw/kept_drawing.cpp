#include "apps/viewer/draw/kept_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "apps/process/user_folder.h"
#include "apps/viewer/bodies/body_names.h"
#include "apps/viewer/draw/drawing_file.h"
#include "apps/viewer/tools/kept_json.h"
#include "apps/viewer/tools/screenshot.h"
#include "geo/body.h"
#include "streaming/file_bytes.h"
#include "streaming/objects/geojson_objects.h"

namespace terrella {

/// An empty text for a missing file.
Result<std::string> KeptDrawing::text_now() const {
  const auto bytes = read_file(*file_, kMaxObjectFileBytes);
  if (!bytes && bytes.error().problem == FileProblem::missing) return std::string();
  if (!bytes) return Error{bytes.error().message};
  return std::string(as_text(*bytes));
}

Result<std::filesystem::path> KeptDrawing::set_aside() const {
  const auto aside = new_file_name(file_->parent_path(), std::chrono::system_clock::now(), ".geojson");
  std::error_code failed;
  std::filesystem::rename(*file_, aside, failed);
  if (failed) return Error{fmt::format("{}: cannot be renamed: {}", file_->string(), failed.message())};
  return aside;
}

Error KeptDrawing::not_kept() const { return Error{"Drawings last until the window closes: " + problem_}; }

KeptDrawing::Loaded KeptDrawing::load() {
  if (!file_) return {};
  const Result<std::string> text = text_now();
  if (!text) {
    problem_ = text.error().message;
    return {.drawing = {}, .complaint = not_kept().message};
  }
  if (text->empty()) return {};
  known_ = *text;
  const Result<OpenedDrawing> read = parse_drawing(*text, file_->string());
  Drawing taken = read ? read->drawing : Drawing{};
  if (read && read->complaints.empty() && read->left_out == 0) return {std::move(taken), {}};
  const Result<std::filesystem::path> aside = set_aside();
  if (!aside) {
    problem_ = aside.error().message;
    return {std::move(taken), not_kept().message};
  }
  known_.clear();
  return {std::move(taken), fmt::format("Some drawings cannot be read. The file is now {}", aside->string())};
}

Result<std::string> KeptDrawing::save(const Drawing& drawing) {
  if (!problem_.empty()) return not_kept();
  const Result<std::string> before = text_now();
  if (!before) return before.error();
  std::string message;
  if (!before->empty() && *before != known_) {
    const Result<std::filesystem::path> aside = set_aside();
    if (!aside) return aside.error();
    message = "Another window has changed the drawings. Its drawings are now in " + aside->string();
  }
  std::string text = drawing_geojson(drawing);
  if (Status written = write_kept_text(*file_, text); !written) return written.error();
  known_ = std::move(text);
  return message;
}

std::optional<std::filesystem::path> drawings_file(const std::string& body) {
  const auto folder = user_folder("XDG_CONFIG_HOME", ".config");
  if (!folder) return std::nullopt;
  if (body == earth().name) return *folder / "drawings.geojson";
  return *folder / fmt::format("drawings-{}.geojson", body_file_word(body));
}

}  // namespace terrella
