# Installs the build to a folder of its own, builds the outside program against that alone, runs it.
# cmake -DBUILD=... -DSOURCE=... -DWORK=... -DCXX=... -P test.cmake
file(REMOVE_RECURSE ${WORK})
foreach(step
    "${CMAKE_COMMAND};--install;${BUILD};--prefix;${WORK}/prefix"
    "${CMAKE_COMMAND};-G;Ninja;-S;${SOURCE};-B;${WORK}/build;-DCMAKE_PREFIX_PATH=${WORK}/prefix;-DCMAKE_CXX_COMPILER=${CXX};-DCMAKE_BUILD_TYPE=Release"
    "${CMAKE_COMMAND};--build;${WORK}/build"
    "${WORK}/build/outside;${WORK}/picture.png")
  execute_process(COMMAND ${step} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "failed: ${step}")
  endif()
endforeach()
file(SIZE ${WORK}/picture.png size)
if(size LESS 500)
  message(FATAL_ERROR "the picture has only ${size} bytes")
endif()
