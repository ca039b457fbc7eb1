# Finds the program robosc, which pip installs, and its CMake code, so that both have the same version.
# -DROBOSC_EXECUTABLE sets the program, or -DROBOSC_PYTHON its Python. The three packages contain identical copies.
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
