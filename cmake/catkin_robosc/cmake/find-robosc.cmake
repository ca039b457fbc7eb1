# Finds the program robosc, which comes by pip, and what belongs to it for CMake, so that both are of one version.
# -DROBOSC_EXECUTABLE names the program, or -DROBOSC_PYTHON the Python that has it. The three packages have this same text.
find_program(ROBOSC_EXECUTABLE robosc DOC "The program robosc: pip install robosc")
if(ROBOSC_PYTHON)
  set(ROBOSC_COMMAND "${ROBOSC_PYTHON}" -m robosc)
elseif(ROBOSC_EXECUTABLE)
  set(ROBOSC_COMMAND "${ROBOSC_EXECUTABLE}")
else()
  set(ROBOSC_COMMAND python3 -m robosc)
endif()
execute_process(
  COMMAND ${ROBOSC_COMMAND} --cmake-dir
  OUTPUT_VARIABLE ROBOSC_CMAKE_DIR
  OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_VARIABLE _robosc_error
  RESULT_VARIABLE _robosc_status)
if(NOT _robosc_status EQUAL 0)
  message(NOTICE "${_robosc_error}")
  message(FATAL_ERROR
    "The program robosc is not found, or does not run: pip install robosc, or name it with -DROBOSC_EXECUTABLE=...")
endif()
include("${ROBOSC_CMAKE_DIR}/robosc/generating.cmake")
