#pragma once

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/georeference.h"
#include "streaming/raster/gdal/gdal_library.h"
#include "streaming/raster/tiff_tags.h"

namespace terrella {

/// Name of a file, and how GDAL opens it.
struct DatasetSource {
  std::string name;                 ///< GDAL's name of the file
  bool alone = false;               ///< files beside it do not count
  bool by_points = false;           ///< true: resampled by its control points or its camera model
  std::string option{};             ///< an open option of its driver; empty: none
  std::shared_ptr<void> mounted{};  ///< keeps its bytes
};

/// An open dataset, used by one thread at a time.
struct OpenDataset {
  GDALDatasetH stored = nullptr;
  GDALDatasetH warped = nullptr;  ///< null: `stored` is read
  [[nodiscard]] GDALDatasetH read() const { return warped != nullptr ? warped : stored; }
};
struct CloseDataset {
  void operator()(OpenDataset* dataset) const;
};
using DatasetHandle = std::unique_ptr<OpenDataset, CloseDataset>;

/// Opens a dataset. The error is the fault alone, without the file's name. Blocks. thread: any
[[nodiscard]] Result<DatasetHandle> open_dataset(const DatasetSource& source);
/// The same. Of a file that holds several rasters it opens the first one, sets the source's name to that, and adds a
/// remark that names the others. thread: any
[[nodiscard]] Result<DatasetHandle> open_first_dataset(DatasetSource& source, const std::string& shown_name,
                                                       std::vector<std::string>& remarks);
/// Reads the statement about the place, with its fault if it has one. Opens a dataset that is placed by points anew, so
/// that it is resampled. thread: any
[[nodiscard]] std::optional<Georeference> place_of(DatasetSource& source, DatasetHandle& dataset, const TiffTags& tags);

/// A message of GDAL without the file's name, which ours have already. thread: any
[[nodiscard]] std::string without_name(std::string message, const std::string& name);
/// The first error of GDAL. thread: that of the messages
[[nodiscard]] Status failure(const GdalMessages& messages);

/// Datasets of one file: each thread that reads has its own, and those that were busy at once stay open, up to a limit.
/// thread: any, several at once
class DatasetPool {
 public:
  explicit DatasetPool(DatasetSource source) : source_(std::move(source)) {}
  void give_back(DatasetHandle dataset) {
    const std::lock_guard lock(mutex_);
    if (idle_.size() < kMostIdle) idle_.push_back(std::move(dataset));
  }

  /// Calls use(dataset, messages) with a dataset. The error does not name the file.
  template <class Use>
  [[nodiscard]] Status lend(const Use& use) {
    auto dataset = take();
    if (!dataset) return dataset.error();
    const GdalMessages messages;
    Status used = use((*dataset)->read(), messages);
    // GDAL takes blocks for sparse ones whose table it cannot read, from then on: a failed dataset is closed.
    if (used && !messages.error().empty()) used = failure(messages);
    if (used) give_back(*std::move(dataset));
    return used;
  }

 private:
  [[nodiscard]] Result<DatasetHandle> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        DatasetHandle dataset = std::move(idle_.back());
        idle_.pop_back();
        return dataset;
      }
    }
    return open_dataset(source_);
  }

  /// A mosaic has many files open.
  inline static const std::size_t kMostIdle = std::clamp(std::thread::hardware_concurrency(), 2U, 8U);
  const DatasetSource source_;
  std::mutex mutex_;
  std::vector<DatasetHandle> idle_;
};

}  // namespace terrella
