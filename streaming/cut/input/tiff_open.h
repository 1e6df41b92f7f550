#pragma once

#include <tiffio.h>

#include <memory>
#include <string>

namespace terrella {

struct CloseTiff {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffHandle = std::unique_ptr<TIFF, CloseTiff>;

/// Opens a TIFF or BigTIFF to read, with bounded memory and silent: errors, also later ones, stand in `message`, which
/// outlives the handle. None if it cannot be opened. thread: any
[[nodiscard]] TiffHandle open_tiff(const std::string& name, std::string& message);

}  // namespace terrella
