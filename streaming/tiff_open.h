#pragma once

#include <tiffio.h>

#include <memory>
#include <string>
#include <string_view>

namespace terrella {

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffHandle = std::unique_ptr<TIFF, CloseTiff>;

/// Opens a TIFF or BigTIFF for reading, with bounded memory and no output to the console. Errors, also later ones, are
/// written to `message`, which must outlive the handle. Returns null on failure. thread: any
[[nodiscard]] TiffHandle open_tiff(const std::string& name, std::string& message);

/// True for the first bytes of a TIFF or BigTIFF in either byte order. thread: any
[[nodiscard]] bool begins_as_tiff(std::string_view head);

}  // namespace terrella
