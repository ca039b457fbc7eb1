# Common code of the packages robosc, ament_cmake_robosc and catkin_robosc. CMake generates code from a model when it
# configures, because the dependencies of the code follow from the model. This file is a part of ROBOSC_COMMAND.
include_guard()

# robosc_generate(<variable> <target> <into> <model> [CONFIG <file>] [LIBRARY_PATH <folder>...]
#                 [INTERFACE_PATH <folder>...] [LAYER] [TESTS])
#
# Generates a model for a target of `robosc transform` into a package, or into a CMake target. Sets the variable to the
# file to include. Leaves unchanged files untouched, so that they are not compiled again.
function(robosc_generate variable target into model)
  cmake_parse_arguments(PARSE_ARGV 4 arg "LAYER;TESTS" "CONFIG" "LIBRARY_PATH;INTERFACE_PATH")
  if(arg_UNPARSED_ARGUMENTS OR arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "robosc: ${model}: what is meant by ${arg_UNPARSED_ARGUMENTS} ${arg_KEYWORDS_MISSING_VALUES}?")
  endif()
  get_filename_component(model_file "${model}" ABSOLUTE)
  get_filename_component(name "${model}" NAME_WE)
  if(arg_LAYER)
    string(APPEND target "-layer")
  endif()
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/robosc/${target}/${into}/${name}")
  set(command ${ROBOSC_COMMAND} transform "${model_file}" --to ${target} --into "${into}" -o "${folder}")
  if(arg_CONFIG)
    get_filename_component(file "${arg_CONFIG}" ABSOLUTE)
    list(APPEND command --config "${file}")
  endif()
  foreach(path IN LISTS arg_LIBRARY_PATH)
    get_filename_component(path "${path}" ABSOLUTE)
    list(APPEND command --library-path "${path}")
  endforeach()
  foreach(path IN LISTS arg_INTERFACE_PATH)
    get_filename_component(path "${path}" ABSOLUTE)
    list(APPEND command --interface-path "${path}")
  endforeach()
  if(arg_TESTS)
    list(APPEND command --with-tests)
  endif()

  execute_process(
    COMMAND ${command}
    OUTPUT_VARIABLE findings
    ERROR_VARIABLE remarks
    RESULT_VARIABLE status)
  # Printed unchanged: CMake would wrap the lines of an error.
  string(STRIP "${findings}" findings)
  string(STRIP "${remarks}" remarks)
  if(findings)
    message(NOTICE "${findings}")
  endif()
  if(NOT status EQUAL 0)
    message(NOTICE "${remarks}")
    message(FATAL_ERROR "robosc generates nothing from ${model}: see above.")
  endif()
  string(REPLACE "\n" "; " remarks "${remarks}")
  message(STATUS "robosc: ${remarks}")

  file(STRINGS "${folder}/inputs.txt" inputs ENCODING UTF-8)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${inputs})
  set(${variable} "${folder}/fragment.cmake" PARENT_SCOPE)
endfunction()

# robosc_generate_supervisor(<target> <model> [CONFIG <file>] [LIBRARY_PATH <folder>...] [INTERFACE_PATH <folder>...])
#
# Adds a static library <target>: the supervisor of the model with its control loop, in C99. Its header is
# <robot>_supervisor.h, with the name of the robot in snake case.
function(robosc_generate_supervisor target model)
  robosc_generate(fragment supervisor "${target}" "${model}" ${ARGN})
  include("${fragment}")
endfunction()

# robosc_require_declared([DEPENDS <package>...] [BUILD_DEPENDS ...] [EXEC_DEPENDS ...] [TEST_DEPENDS ...])
#
# Reports an error if the package.xml of this project lacks one of the packages. Without it, a workspace may be built in
# the wrong order. Call it after catkin_package_xml() or ament_package_xml().
function(robosc_require_declared)
  cmake_parse_arguments(PARSE_ARGV 0 needed "" "" "DEPENDS;BUILD_DEPENDS;EXEC_DEPENDS;TEST_DEPENDS")
  # catkin calls these RUN_DEPENDS.
  set(declared_EXEC ${PROJECT_NAME} ${${PROJECT_NAME}_EXEC_DEPENDS} ${${PROJECT_NAME}_RUN_DEPENDS})
  set(declared_BUILD ${PROJECT_NAME} ${${PROJECT_NAME}_BUILD_DEPENDS})
  set(declared_TEST ${${PROJECT_NAME}_TEST_DEPENDS} ${declared_BUILD} ${declared_EXEC})
  set(missing "")
  foreach(kind BUILD EXEC TEST)
    foreach(package IN LISTS needed_${kind}_DEPENDS)
      if(NOT package IN_LIST declared_${kind})
        list(APPEND ${package}_lacks ${kind})
        list(APPEND missing ${package})
      endif()
    endforeach()
  endforeach()
  foreach(package IN LISTS needed_DEPENDS)
    if(NOT package IN_LIST declared_BUILD OR NOT package IN_LIST declared_EXEC)
      set(${package}_lacks BUILD EXEC)
      list(APPEND missing ${package})
    endif()
  endforeach()
  if(missing)
    list(REMOVE_DUPLICATES missing)
    message(NOTICE "The model needs packages that the package.xml of ${PROJECT_NAME} does not name. Add to it:")
    foreach(package IN LISTS missing)
      set(tag depend)
      list(LENGTH ${package}_lacks kinds)
      if(kinds EQUAL 1)
        string(TOLOWER "${${package}_lacks}_depend" tag)
      endif()
      message(NOTICE "  <${tag}>${package}</${tag}>")
    endforeach()
    message(FATAL_ERROR "The package.xml of ${PROJECT_NAME} is not complete: see above.")
  endif()
endfunction()
