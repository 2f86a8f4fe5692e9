// module.cpp: what is in the extension module boxwood._core?
#include "answers.h"
#include <nanobind/stl/string.h>

#include "boxwood/core/error.h"
#include "boxwood/simd/kernels.h"
#include "describe.h"
#include "scene_type.h"

namespace boxwood::python {

NB_MODULE(_core, module) {
  module.attr("__version__") = BOXWOOD_VERSION;
  nb::exception<FileError>(module, "FileError", PyExc_OSError);
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
}

}  // namespace boxwood::python
