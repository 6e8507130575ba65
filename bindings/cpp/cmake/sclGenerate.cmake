# scl_generate: a program that runs components of a topology.

# scl_generate(TARGET TOPOLOGY [COMPONENTS NAME...] [TESTABLE])
#
# Checks the topology file, generates <system>.scl.hpp with the components (by default all), compiles the topology's
# schemas with protoc, and lets the target include and link all of that. With TESTABLE, the components have the function
# `test()`, for unit tests.
#
# The check and the header are made when CMake configures, which a build repeats after a change of the topology file, of
# a schema, or of the program `scl`. Files that would not change are left alone, so nothing that includes them is
# compiled again.
function(scl_generate target topology)
  cmake_parse_arguments(PARSE_ARGV 2 arg "TESTABLE" "" "COMPONENTS")
  if(NOT TARGET "${target}")
    message(FATAL_ERROR "scl_generate: there is no target `${target}`; call add_executable(${target} ...) before")
  elseif(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "scl_generate: unknown argument `${arg_UNPARSED_ARGUMENTS}`; \
usage: scl_generate(TARGET TOPOLOGY COMPONENTS NAME... TESTABLE)")
  elseif("COMPONENTS" IN_LIST arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "scl_generate: `COMPONENTS` without names; \
name components of the topology, or leave the word out")
  elseif(NOT SCL_EXECUTABLE)
    message(FATAL_ERROR "scl_generate: the program `scl` was not found; install it with `cargo install scl-cli`, \
or set SCL_EXECUTABLE to its path")
  endif()
  get_filename_component(topology "${topology}" ABSOLUTE)
  get_filename_component(home "${topology}" DIRECTORY)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/scl/${target}")

  set(options "")
  foreach(component IN LISTS arg_COMPONENTS)
    list(APPEND options --component "${component}")
  endforeach()
  if(arg_TESTABLE)
    list(APPEND options --testable)
  endif()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${topology}" "${SCL_EXECUTABLE}")
  # The checker's text goes to standard error as it is.
  execute_process(
    COMMAND "${SCL_EXECUTABLE}" generate --for cpp "${topology}" -o "${folder}" ${options}
    RESULT_VARIABLE failed
    OUTPUT_QUIET)
  if(failed)
    message(FATAL_ERROR "scl_generate: `scl generate --for cpp ${topology}` failed; its output is above")
  endif()
  execute_process(
    COMMAND "${SCL_EXECUTABLE}" generate --for zmq "${topology}"
    OUTPUT_VARIABLE description
    ERROR_QUIET)
  string(JSON count LENGTH "${description}" schemas)
  target_include_directories("${target}" PRIVATE "${folder}")
  target_link_libraries("${target}" PRIVATE scl::scl)
  if(count GREATER 0)
    math(EXPR last "${count} - 1")
    set(schemas "")
    foreach(index RANGE ${last})
      string(JSON schema GET "${description}" schemas ${index})
      # Those of protobuf itself are compiled into libprotobuf.
      if(NOT schema MATCHES "^google/protobuf/")
        list(APPEND schemas "${schema}")
      endif()
    endforeach()
    set(folders "")
    string(JSON count LENGTH "${description}" schema_folders)
    math(EXPR last "${count} - 1")
    foreach(index RANGE ${last})
      string(JSON folder GET "${description}" schema_folders ${index})
      get_filename_component(folder "${folder}" ABSOLUTE BASE_DIR "${home}")
      list(APPEND folders "${folder}")
    endforeach()
    _scl_messages(messages "${folders}" "${schemas}")
    target_link_libraries("${target}" PRIVATE "${messages}")
  endif()
endfunction()

# A static library of the messages of schemas, one for all targets with the same schemas.
function(_scl_messages result folders schemas)
  string(MD5 hash "${folders} ${schemas}")
  set(library "scl_messages_${hash}")
  set(${result} "${library}" PARENT_SCOPE)
  set(paths "")
  foreach(schema IN LISTS schemas)
    _scl_find_schema(path "${schema}" "${folders}")
    list(APPEND paths "${path}")
  endforeach()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${paths})
  if(TARGET "${library}")
    return()
  endif()

  # Newer versions of protobuf depend on other libraries, of which only their own configuration knows.
  find_package(Protobuf CONFIG QUIET)
  if(NOT TARGET protobuf::libprotobuf)
    find_package(Protobuf MODULE QUIET)
  endif()
  if(TARGET protobuf::protoc)
    set(protoc "$<TARGET_FILE:protobuf::protoc>")
  else()
    find_program(SCL_PROTOC protoc)
    set(protoc "${SCL_PROTOC}")
  endif()
  if(NOT protoc OR NOT TARGET protobuf::libprotobuf)
    message(FATAL_ERROR "scl_generate: the topology has schemas, which need protoc and libprotobuf; install them, \
on Debian and Ubuntu with `apt-get install protobuf-compiler libprotobuf-dev`")
  endif()

  set(folder "${CMAKE_BINARY_DIR}/scl/messages_${hash}")
  file(MAKE_DIRECTORY "${folder}")
  list(TRANSFORM folders PREPEND -I OUTPUT_VARIABLE import_options)
  set(sources "")
  foreach(schema IN LISTS schemas)
    string(REGEX REPLACE "\\.proto$" "" stem "${schema}")
    set(outputs "${folder}/${stem}.pb.cc" "${folder}/${stem}.pb.h")
    add_custom_command(
      OUTPUT ${outputs}
      COMMAND "${protoc}" ${import_options} "--cpp_out=${folder}" "${schema}"
      DEPENDS ${paths}
      WORKING_DIRECTORY "${folder}"
      COMMENT "Compiling ${schema} with protoc"
      VERBATIM)
    list(APPEND sources ${outputs})
  endforeach()
  add_library("${library}" STATIC ${sources})
  target_include_directories("${library}" SYSTEM PUBLIC "${folder}")
  target_link_libraries("${library}" PUBLIC protobuf::libprotobuf)
  target_compile_features("${library}" PUBLIC cxx_std_17)
  set_target_properties("${library}" PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

# The path of a schema in one of several folders.
function(_scl_find_schema result schema folders)
  foreach(folder IN LISTS folders)
    if(EXISTS "${folder}/${schema}")
      set(${result} "${folder}/${schema}" PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "scl_generate: the schema `${schema}` is in none of the folders ${folders}")
endfunction()
