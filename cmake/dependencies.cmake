# dependencies.cmake: every library that the project uses, looked up once.
#
# Each look-up that fails says what is missing and how to get it.

function(boxwood_find name package)
  find_package(${name} QUIET ${ARGN})
  if(NOT ${name}_FOUND)
    message(FATAL_ERROR "Boxwood needs ${name}, which was not found. On Debian: apt-get install ${package}")
  endif()
endfunction()

macro(boxwood_require name package)
  boxwood_find(${name} ${package} ${ARGN})
  find_package(${name} QUIET ${ARGN})
endmacro()

boxwood_require(TBB libtbb-dev)

if(BOXWOOD_BUILD_APP)
  boxwood_require(OpenImageIO libopenimageio-dev)
  # Debian's package names OpenCV's include folder, which OpenImageIO's headers need only for cv::Mat; drop it when absent.
  get_target_property(_dirs OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
  list(FILTER _dirs EXCLUDE REGEX "opencv")
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${_dirs}")
  boxwood_require(tinyobjloader libtinyobjloader-dev)
  boxwood_require(TinyGLTF libtinygltf-dev)
  boxwood_require(CLI11 libcli11-dev)
  boxwood_require(fmt libfmt-dev)
  boxwood_require(nlohmann_json nlohmann-json3-dev)
endif()
if(BOXWOOD_BUILD_TESTS)
  boxwood_require(GTest libgtest-dev)
  find_package(embree 3 QUIET)  # only a peer to measure against and to compare with; absent is fine
endif()
