#include "streaming/raster/tiff_reader.h"

#include <fmt/format.h>

#include <cstdarg>
#include <cstdio>

namespace terrella {
namespace {

/// Most memory that libtiff may allocate at once for a strip, tile or table with sizes from the file, bytes.
constexpr tmsize_t kMaxTiffAllocation = 256L << 20;

struct FreeTiffOptions {
  void operator()(TIFFOpenOptions* options) const { TIFFOpenOptionsFree(options); }
};

/// Keeps the first error, because the later ones follow from it.
int keep_tiff_error(TIFF*, void* text, const char*, const char* format, std::va_list arguments) {
  auto& message = *static_cast<std::string*>(text);
  if (!message.empty()) return 1;
  char line[256];
  std::vsnprintf(line, sizeof(line), format, arguments);
  message = line;
  return 1;
}
/// Ignores warnings, such as unknown tags, that do not affect pixels.
int ignore_tiff_warning(TIFF*, void*, const char*, const char*, std::va_list) { return 1; }

tmsize_t refuse_tiff_write(thandle_t, void*, tmsize_t) { return -1; }
int close_nothing(thandle_t) { return 0; }

}  // namespace

tmsize_t TiffReader::read(thandle_t handle, void* into, tmsize_t size) {
  auto* self = static_cast<TiffReader*>(handle);
  if (size <= 0) return 0;
  const std::size_t got =
      self->bytes_->read_at(self->position_, {static_cast<std::byte*>(into), static_cast<std::size_t>(size)});
  self->position_ += got;
  return static_cast<tmsize_t>(got);
}

toff_t TiffReader::seek(thandle_t handle, toff_t offset, int whence) {
  auto* self = static_cast<TiffReader*>(handle);
  if (whence == SEEK_SET) self->position_ = offset;
  if (whence == SEEK_CUR) self->position_ += offset;
  if (whence == SEEK_END) self->position_ = self->bytes_->size() + offset;
  return self->position_;
}

Result<std::unique_ptr<TiffReader>> TiffReader::open(std::shared_ptr<const ByteFile> bytes) {
  std::unique_ptr<TiffReader> reader(new TiffReader(std::move(bytes)));
  const std::string& name = reader->bytes_->name();
  const std::unique_ptr<TIFFOpenOptions, FreeTiffOptions> options(TIFFOpenOptionsAlloc());
  if (!options) return Error{fmt::format("{}: there is not enough memory to open it", name)};
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_tiff_error, &reader->message_);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_tiff_warning, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMaxTiffAllocation);
  const TIFFSizeProc size = [](thandle_t handle) -> toff_t { return static_cast<TiffReader*>(handle)->bytes_->size(); };
  // m: no memory map. O: loads the table of blocks on demand.
  reader->tiff_ = TIFFClientOpenExt(name.c_str(), "rmO", reader.get(), read, refuse_tiff_write, seek, close_nothing,
                                    size, nullptr, nullptr, options.get());
  if (reader->tiff_ == nullptr) {
    return Error{fmt::format("{}: is not a TIFF that can be read: {}", name, reader->message_)};
  }
  return reader;
}

TiffReader::~TiffReader() {
  if (tiff_ != nullptr) TIFFClose(tiff_);
}

Result<std::unique_ptr<TiffReader>> TiffReaders::open() const {
  auto reader = TiffReader::open(bytes_);
  if (!reader) return reader.error();
  TIFF* tiff = (*reader)->get();
  if (TIFFCurrentDirOffset(tiff) != directory_ && TIFFSetSubDirectory(tiff, directory_) != 1) {
    return Error{fmt::format("{}: is not a TIFF that can be read: {}", bytes_->name(), (*reader)->message())};
  }
  std::uint16_t photometric = 0;
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  std::uint16_t compression = 0;
  TIFFGetField(tiff, TIFFTAG_COMPRESSION, &compression);
  // libtiff then makes libjpeg return RGB.
  if (photometric == PHOTOMETRIC_YCBCR && compression == COMPRESSION_JPEG) {
    TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  }
  return reader;
}

Result<TiffReaders::Lent> TiffReaders::lend() {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      Lent lent(*this, std::move(idle_.back()));
      idle_.pop_back();
      lent->clear_message();
      return lent;
    }
  }
  auto reader = open();
  if (!reader) return reader.error();
  return Lent(*this, *std::move(reader));
}

void TiffReaders::give_back(std::unique_ptr<TiffReader> reader) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(reader));
}

}  // namespace terrella
