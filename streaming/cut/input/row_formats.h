#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "streaming/cut/input/height_samples.h"
#include "streaming/cut/input/row_reader.h"

/// Helpers shared by the readers of all formats. `name` is the path of the file, for messages.
namespace terrella {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// Opens a reader. The file must be at its first byte, and its head already checked for the format.
/// `eighths`, 1 to 8: a smaller picture of that many eighths of the size, which takes less time to decode.
[[nodiscard]] Result<std::unique_ptr<RowReader>> open_jpeg_rows(File file, std::string name, int eighths = 8);
[[nodiscard]] Result<std::unique_ptr<RowReader>> open_webp_rows(const std::string& name);
[[nodiscard]] Result<std::unique_ptr<RowReader>> open_png_rows(File file, std::string name,
                                                               const std::optional<HeightCoding>& heights);
[[nodiscard]] Result<std::unique_ptr<RowReader>> open_raster_rows(const std::string& name,
                                                                  const std::optional<HeightCoding>& heights,
                                                                  const CodingOptions& choice, int jobs);

/// Refuses a picture that is empty or over kMaxPictureSide_px.
[[nodiscard]] Status check_picture_size(const std::string& name, std::int64_t width_px, std::int64_t height_px);

/// "PATH: heights are read from …"
[[nodiscard]] Error refuse_heights(const std::string& name);

/// "PATH: row 12 of 400 cannot be read: WHY; …"
[[nodiscard]] Error row_error(const std::string& name, std::int64_t row, std::int64_t rows, std::string_view why);

}  // namespace terrella
