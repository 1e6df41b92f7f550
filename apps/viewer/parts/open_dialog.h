#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "apps/viewer/parts/part.h"
#include "apps/viewer/tools/folder_list.h"

namespace terrella {

/// Chooses a file, a folder or an address to open: a line for a path, recent files, and the entries of a folder. Owns
/// the panel. thread: main
class OpenDialog : public Panel {
 public:
  /// `open` opens what the user chose: an existing file or folder, or an address.
  OpenDialog(const ViewerContext& context, std::function<void(std::filesystem::path)> open);

  void take_keyboard() override;

 private:
  void toggled() override;
  void draw_open(float foot) override;
  void draw_path();
  void draw_recent();
  void draw_entries(float height);
  void draw_buttons();
  void typed();
  void enter(const std::filesystem::path& folder);
  void choose(const std::filesystem::path& file);
  void take(const std::string& text);
  void list();
  [[nodiscard]] std::filesystem::path path_of(const std::string& text) const;
  [[nodiscard]] std::filesystem::path marked_folder() const;

  std::function<void(std::filesystem::path)> open_;
  std::filesystem::path folder_;
  std::vector<FolderEntry> entries_;  ///< entries of the folder
  std::vector<std::string> recent_;
  std::string text_;     ///< text in the line
  std::string begins_;   ///< start of the names in the list, from the line
  std::string problem_;  ///< may be empty
  bool all_ = false;     ///< the list has files of every kind
};

}  // namespace terrella
