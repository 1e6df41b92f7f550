#include <dlfcn.h>
#include <pybind11/pybind11.h>

#include <filesystem>

#include "apps/process/data_dir.h"
#include "apps/python/bindings.h"
#include "apps/python/long_call.h"

namespace {

/// Folder of the module's file.
std::filesystem::path module_folder() {
  Dl_info here{};
  static const int kInThisFile = 0;
  if (dladdr(&kInThisFile, &here) == 0) return {};
  return std::filesystem::absolute(here.dli_fname).parent_path();
}

}  // namespace

PYBIND11_MODULE(_terrella, module) {
  pybind11::options options;
  options.disable_function_signatures();  // each docstring begins with its own, as inspect.signature() reads it
  // PREFIX/lib/python3/dist-packages/terrella, or python/terrella in a build.
  const std::filesystem::path folder = module_folder();
  terrella::set_data_folders({folder / "../../data", folder / "../../../../share/terrella"});
  module.attr("__version__") = TERRELLA_VERSION;
  terrella::add_exceptions(module);
  terrella::add_commands(module);
  terrella::add_globe(module);
}
