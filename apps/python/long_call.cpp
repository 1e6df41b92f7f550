#include "apps/python/long_call.h"

#include <utility>

#include "apps/process/console.h"
#include "apps/process/option_names.h"
#include "apps/process/stop_signals.h"
#include "apps/program/commands.h"
#include "streaming/url.h"

namespace terrella {
namespace {

namespace py = pybind11;

// Never destroyed: the interpreter may be gone before.
PyObject* g_error = nullptr;
PyObject* g_incomplete = nullptr;

void warn(PyObject* category, const std::string& message) {
  constexpr int kCaller = 1;
  if (PyErr_WarnEx(category, message.c_str(), kCaller) != 0) throw py::error_already_set();
}

std::string without_line_end(const std::string& text) { return text.substr(0, text.find_last_not_of('\n') + 1); }

}  // namespace

Said run_long(const std::function<int()>& work) {
  static std::mutex one_at_a_time;
  Said said;
  std::mutex saying;
  const py::gil_scoped_release others_run;
  const std::lock_guard lock(one_at_a_time);
  const CapturedConsole captured({.result =
                                      [&](const std::string& text) {
                                        const std::lock_guard one(saying);
                                        said.result += text;
                                      },
                                  .message =
                                      [&](const std::string& text) {
                                        const std::lock_guard one(saying);
                                        said.messages.push_back(without_line_end(text));
                                      }});
  { const StopSignals none_yet; }
  said.exit_code = work();
  said.stopped = StopSignals::came();
  return said;
}

void conclude(const Said& said) {
  if (said.stopped) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  std::vector<std::string> remarks = said.messages;
  std::string failure;
  if (said.exit_code == kWrongUsage && !remarks.empty()) throw py::value_error(remarks.front());
  if (said.exit_code == kFailed && !remarks.empty()) {
    failure = std::move(remarks.back());
    remarks.pop_back();
  }
  for (const std::string& remark : remarks) {
    warn(said.exit_code == kDoneInPart ? g_incomplete : PyExc_UserWarning, remark);
  }
  if (said.exit_code == kFailed) raise_error(failure.empty() ? said.result : failure);
}

void raise_error(const std::string& message) {
  PyErr_SetString(g_error, shown_message(message).c_str());
  throw py::error_already_set();
}

void add_exceptions(py::module_& module) {
  g_error = PyErr_NewExceptionWithDoc("terrella.Error", "A failure of a file, a server or a driver, and its cure.",
                                      PyExc_RuntimeError, nullptr);
  g_incomplete = PyErr_NewExceptionWithDoc("terrella.IncompleteWarning", "Some tiles or objects are missing.",
                                           PyExc_UserWarning, nullptr);
  module.attr("Error") = py::handle(g_error);
  module.attr("IncompleteWarning") = py::handle(g_incomplete);
}

}  // namespace terrella
