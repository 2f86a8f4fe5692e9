# Installs the build into an empty folder, then configures, builds and runs two small projects against it.
#
#   cmake -DBUILD=... -DSCRATCH=... -DSOURCE=... -DGENERATOR=... -DBUILD_TYPE=... -DDEBUG_FLAGS=... -P install_test.cmake

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "failed (${code}): ${ARGN}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix)

# Nothing that was installed may point back at the build or the source.
file(GLOB_RECURSE scripts ${SCRATCH}/prefix/*.cmake)
foreach(script IN LISTS scripts)
  file(READ ${script} text)
  foreach(path ${BUILD} ${SOURCE})
    string(FIND "${text}" "${path}" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${script} mentions ${path}")
    endif()
  endforeach()
endforeach()

foreach(project core wings)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/${project} -B ${SCRATCH}/${project} -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix -DCMAKE_BUILD_TYPE=${BUILD_TYPE} "-DCMAKE_CXX_FLAGS_DEBUG=${DEBUG_FLAGS}")
  run(${CMAKE_COMMAND} --build ${SCRATCH}/${project})
  run(${SCRATCH}/${project}/consumer ${SCRATCH}/picture.png)
  message(STATUS "a project with the installed ${project}: built and ran")
endforeach()

