// module.cpp: what is in the extension module boxwood._core?
#include <nanobind/stl/string.h>

#include "answers.h"
#include "boxwood/core/error.h"
#include "boxwood/simd/kernels.h"
#include "describe.h"
#include "docstrings.h"
#include "queries.h"

namespace boxwood::python {

NB_MODULE(_core, module) {
  nb::set_leak_warnings(false);  // what Python has not yet freed when it ends is no fault of ours
  module.attr("version") = BOXWOOD_VERSION;
  nb::exception<FileError>(module, "FileError", PyExc_OSError).attr("__doc__") = doc::FileError;
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
