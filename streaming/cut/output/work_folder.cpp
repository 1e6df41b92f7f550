#include "streaming/cut/output/work_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <regex>
#include <vector>

#include "streaming/cut/output/part_name.h"
#include "streaming/cut/output/tile_writer.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr const char* kKeyFile = "key";
constexpr const char* kLockFile = "lock";
/// Most times that a folder may vanish between its creation and its locking.
constexpr int kMostPlaces = 100;

/// Locks the folder and returns the file descriptor; -1 if another process holds the lock or the folder is gone.
int lock_folder(const fs::path& folder) {
  const fs::path name = folder / kLockFile;
  const int lock = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock < 0) return -1;
  struct stat held {};
  struct stat named {};
  // The last owner may have removed the file between open() and flock().
  if (flock(lock, LOCK_EX | LOCK_NB) == 0 && fstat(lock, &held) == 0 && stat(name.c_str(), &named) == 0 &&
      held.st_ino == named.st_ino) {
    return lock;
  }
  const int failed = errno;
  close(lock);
  errno = failed;
  return -1;
}

void remove_quietly(const fs::path& path) {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

void remove_contents(const fs::path& folder) {
  // Removes the key first: without a key no run takes the rest for resumable work.
  remove_quietly(folder / kKeyFile);
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().filename() != kLockFile) remove_quietly(entry.path());
  }
}

/// Removes the lock last, and keeps files that others create after that.
void remove_folder(const fs::path& folder) {
  remove_contents(folder);
  std::error_code ignored;
  fs::remove(folder / kLockFile, ignored);
  fs::remove(folder, ignored);
}

bool write_key(const fs::path& folder, const std::string& key) {
  std::ofstream file(folder / kKeyFile, std::ios::binary);
  file << key;
  file.close();
  return file.good();
}

/// Folders of all runs for this output, running or killed.
std::vector<fs::path> folders_beside(const fs::path& output) {
  static const std::regex kEnding("[0-9]+-[0-9]+\\.part");
  const std::string begin = "." + output.filename().string() + ".";
  std::vector<fs::path> found;
  std::error_code failed;
  for (fs::directory_iterator entry(folder_of(output), failed), end; !failed && entry != end; entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    std::error_code vanished;
    if (name.starts_with(begin) && std::regex_match(name.substr(begin.size()), kEnding) &&
        entry->is_directory(vanished)) {
      found.push_back(entry->path());
    }
  }
  return found;
}

}  // namespace

std::string key_of_folder(const fs::path& folder) {
  std::ifstream file(folder / kKeyFile, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Result<WorkFolder> WorkFolder::beside(const fs::path& output, const std::string& key) {
  for (const fs::path& folder : folders_beside(output)) {
    const int lock = lock_folder(folder);
    if (lock < 0) continue;
    if (key_of_folder(folder) == key) return WorkFolder(folder, lock);
    remove_folder(folder);
    close(lock);
  }
  for (int attempt = 0; attempt < kMostPlaces; ++attempt) {
    const fs::path folder = part_name(output);
    std::error_code failed;
    if (!fs::create_directory(folder, failed) && failed) return cannot_write(output, failed.value());
    const int lock = lock_folder(folder);
    if (lock < 0) continue;
    WorkFolder made(folder, lock);
    if (!write_key(folder, key)) return cannot_write(output, errno);
    return made;
  }
  return cannot_write(output, EBUSY);
}

Result<WorkFolder> WorkFolder::named(const fs::path& folder, const std::string& key) {
  std::error_code failed;
  fs::create_directory(folder, failed);
  if (failed) return cannot_write(folder, failed.value());
  if (!fs::is_empty(folder, failed) && !fs::exists(folder / kKeyFile, failed) && !fs::exists(folder / kLockFile)) {
    return Error{fmt::format("{}: is a folder with other things in it; move it away", folder.string())};
  }
  const int lock = lock_folder(folder);
  if (lock < 0) return Error{fmt::format("{}: another run is at work in it; wait for its end", folder.string())};
  WorkFolder made(folder, lock);
  made.keep();
  if (key_of_folder(folder) == key) return made;
  remove_contents(folder);
  if (!write_key(folder, key)) return cannot_write(folder, errno);
  return made;
}

WorkFolder::~WorkFolder() {
  if (lock_ < 0) return;
  if (!keep_) remove_folder(path_);
  close(lock_);
}

}  // namespace terrella
