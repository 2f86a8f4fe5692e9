# wasm.cmake: what stands in for the libraries where Emscripten compiles for WebAssembly?
#
# Of Highway the headers are enough, there is nothing to dispatch; oneTBB is not needed (core/parallel.cpp), and
# GoogleTest is compiled from its sources. All of it from Debian's packages for any machine: libhwy-dev, libgtest-dev.
# The oldest Emscripten in use, Debian 12's, lacks a little of C++20's library, which src/ gets from wasm_compat.h.
find_path(BOXWOOD_HWY_INCLUDE hwy/highway.h PATHS /usr/include NO_CMAKE_FIND_ROOT_PATH NO_DEFAULT_PATH REQUIRED)
# The folder as a whole would bring along the headers of another machine.
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/include)
file(CREATE_LINK ${BOXWOOD_HWY_INCLUDE}/hwy ${CMAKE_BINARY_DIR}/include/hwy SYMBOLIC)
add_library(hwy::hwy INTERFACE IMPORTED)
target_include_directories(hwy::hwy SYSTEM INTERFACE ${CMAKE_BINARY_DIR}/include)
add_library(TBB::tbb INTERFACE IMPORTED)

add_compile_options(-msimd128 -fexceptions "$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include ${CMAKE_CURRENT_LIST_DIR}/wasm_compat.h>")
# Room for the kernels' stacks and for millions of rays; and the program ends when main does.
add_link_options(-fexceptions -sALLOW_MEMORY_GROWTH=1 -sMAXIMUM_MEMORY=4GB -sTOTAL_STACK=8MB -sEXIT_RUNTIME=1)
if(BOXWOOD_BUILD_TESTS)
  add_subdirectory(/usr/src/googletest ${CMAKE_BINARY_DIR}/googletest EXCLUDE_FROM_ALL)
  foreach(name gtest gtest_main)
    if(NOT TARGET GTest::${name})
      add_library(GTest::${name} ALIAS ${name})
    endif()
  endforeach()
endif()
