#pragma once

#include <pybind11/pybind11.h>

#include "codecs/image.h"

namespace terrella {

/// Adds render, cut, preload, info, merge and convert. thread: that of Python
void add_commands(pybind11::module_& module);

/// Adds the class Globe. thread: that of Python
void add_globe(pybind11::module_& module);

/// The picture as a numpy array, rows from the top: height x width x 3, as the program writes it to a PNG. thread: that
/// of Python
[[nodiscard]] pybind11::object to_array(const Image& image);

}  // namespace terrella
