// module.cpp: what is in the extension module boxwood._core?
#include <nanobind/stl/string.h>

#include "answers.h"
#include "boxwood/core/error.h"
#include "boxwood/simd/kernels.h"
#include "describe.h"
#include "docstrings.h"
#include "queries.h"

namespace boxwood::python {

namespace {

void bind_file_error(nb::module_& module) {
  const nb::exception<FileError> type(module, "FileError", PyExc_OSError);
  type.attr("__doc__") = doc::FileError;
  // nanobind would take the message for UTF-8, and files may have names of any bytes.
  nb::register_exception_translator(
      [](const std::exception_ptr& error, void* payload) {
        try {
          std::rethrow_exception(error);
        } catch (const FileError& e) {
          const std::string_view what = e.what();
          const auto text =
              nb::steal(PyUnicode_DecodeUTF8(what.data(), static_cast<Py_ssize_t>(what.size()), "replace"));
          PyErr_SetObject(static_cast<PyObject*>(payload), text.ptr());
        }
      },
      type.ptr());
}

}  // namespace

NB_MODULE(_core, module) {
  nb::set_leak_warnings(false);  // what Python has not yet freed when it ends is no fault of ours
  module.attr("version") = BOXWOOD_VERSION;
  bind_file_error(module);
  module.def(
      "cpu_target",
      [] {
        const simd::Kernels* kernels = simd::kernels();
        return std::string(kernels ? kernels->name : "scalar");
      },
      "The instruction set that answers on this machine: \"avx512\", \"avx2\", \"sse4\", \"neon\", or "
      "\"scalar\" "
      "for plain C++.\nThe environment variable BOXWOOD_TARGET may name a lesser one before the first use.");
  bind_description(module);
  bind_answers(module);
  bind_scene(module);
  bind_yardstick(module);
}

}  // namespace boxwood::python
