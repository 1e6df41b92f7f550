#pragma once

#include <tiffio.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "streaming/raster/byte_file.h"

namespace terrella {

/// A libtiff handle over a ByteFile, with its own current directory and last error. libtiff loads the table of blocks
/// piece by piece, so that a huge table costs nothing. No memory map is used, because its size would count as memory
/// held. thread: one at a time
class TiffReader {
 public:
  /// Opens the file and reads its first directory. The error names the file.
  [[nodiscard]] static Result<std::unique_ptr<TiffReader>> open(std::shared_ptr<const ByteFile> bytes);
  ~TiffReader();
  TiffReader(const TiffReader&) = delete;
  TiffReader& operator=(const TiffReader&) = delete;

  [[nodiscard]] TIFF* get() const { return tiff_; }
  [[nodiscard]] const ByteFile& bytes() const { return *bytes_; }
  /// libtiff's last error; empty if there was none since clear_message().
  [[nodiscard]] const std::string& message() const { return message_; }
  void clear_message() { message_.clear(); }

 private:
  explicit TiffReader(std::shared_ptr<const ByteFile> bytes) : bytes_(std::move(bytes)) {}
  static tmsize_t read(thandle_t handle, void* into, tmsize_t size);
  static toff_t seek(thandle_t handle, toff_t offset, int whence);

  std::shared_ptr<const ByteFile> bytes_;
  std::uint64_t position_ = 0;
  std::string message_;
  TIFF* tiff_ = nullptr;
};

/// Readers of one directory (a picture) of a TIFF, lent to the threads that decode it. Keeps a reader for each thread
/// that was busy at the same time. thread: any, several at once
class TiffReaders {
 public:
  TiffReaders(std::shared_ptr<const ByteFile> bytes, std::uint64_t directory)
      : bytes_(std::move(bytes)), directory_(directory) {}

  /// A reader that returns to its pool by itself.
  class Lent {
   public:
    Lent(TiffReaders& pool, std::unique_ptr<TiffReader> reader) : pool_(&pool), reader_(std::move(reader)) {}
    Lent(Lent&&) = default;
    Lent& operator=(Lent&&) = delete;
    ~Lent() {
      if (reader_) pool_->give_back(std::move(reader_));
    }
    [[nodiscard]] TiffReader* operator->() const { return reader_.get(); }
    [[nodiscard]] TiffReader& operator*() const { return *reader_; }
    /// Closes the reader instead of returning it. libtiff takes a part of its table of blocks that could not be read
    /// for zeros from then on.
    void drop() { reader_.reset(); }

   private:
    TiffReaders* pool_;
    std::unique_ptr<TiffReader> reader_;
  };
  /// Lends a reader whose current directory is this pool's. The pool must outlive it.
  [[nodiscard]] Result<Lent> lend();
  [[nodiscard]] const std::shared_ptr<const ByteFile>& bytes() const { return bytes_; }
  /// Opens a reader of the directory for a caller that keeps it.
  [[nodiscard]] Result<std::unique_ptr<TiffReader>> open() const;

 private:
  void give_back(std::unique_ptr<TiffReader> reader);

  std::shared_ptr<const ByteFile> bytes_;
  std::uint64_t directory_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<TiffReader>> idle_;
};

}  // namespace terrella
