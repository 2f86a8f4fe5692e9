# dependencies.cmake: every library that the project uses, looked up once.
#
# What is missing is told all at once, with how to get it.
list(PREPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})

set(BOXWOOD_MISSING "")
set(BOXWOOD_MISSING_PACKAGES "")
macro(boxwood_require name package)
  find_package(${name} QUIET ${ARGN})
  if(NOT ${name}_FOUND)
    list(APPEND BOXWOOD_MISSING ${name})
    list(APPEND BOXWOOD_MISSING_PACKAGES ${package})
  endif()
endmacro()

if(EMSCRIPTEN)
  include(${CMAKE_CURRENT_LIST_DIR}/wasm.cmake)
else()
  boxwood_require(TBB libtbb-dev)
  boxwood_require(hwy libhwy-dev CONFIG)
endif()

if(BOXWOOD_BUILD_APP OR BOXWOOD_BUILD_PYTHON)
  boxwood_require(tinyobjloader libtinyobjloader-dev)
  boxwood_require(TinyGLTF libtinygltf-dev)
endif()
if(BOXWOOD_BUILD_APP)
  boxwood_require(OpenImageIO libopenimageio-dev)
  boxwood_require(CLI11 libcli11-dev)
  boxwood_require(fmt libfmt-dev)
  boxwood_require(nlohmann_json nlohmann-json3-dev)
endif()
if(BOXWOOD_BUILD_APP)
  # Renders shared among machines (mpirun); absent is fine. The C interface alone.
  set(MPI_CXX_SKIP_MPICXX ON)
  find_package(MPI QUIET COMPONENTS CXX)
endif()
if(BOXWOOD_BUILD_APP OR BOXWOOD_BUILD_TESTS)
  find_package(embree 3 QUIET)     # only a peer to measure against and to compare with; absent is fine
endif()
if(BOXWOOD_BUILD_TESTS)
  if(NOT EMSCRIPTEN)
    boxwood_require(GTest libgtest-dev)
  endif()
  find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter)  # the checks of layers, snippets and outputs
  find_package(benchmark QUIET)    # only for make microbench
endif()

if(BOXWOOD_MISSING)
  list(JOIN BOXWOOD_MISSING ", " names)
  list(JOIN BOXWOOD_MISSING_PACKAGES " " packages)
  message(FATAL_ERROR "Boxwood needs ${names}, not found here. On Debian: apt-get install ${packages}\n"
    "(tools/setup.sh installs whatever any part of Boxwood needs.)")
endif()
