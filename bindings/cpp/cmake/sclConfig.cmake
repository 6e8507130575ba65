# find_package(scl): SCL for C and C++, from an installed prefix or from the source tree of SCL.
#
# Targets:
#   scl::c     the C library: scl.h and libscl
#   scl::scl   the C++ headers over it: scl.hpp
# Commands:
#   scl_generate(TARGET TOPOLOGY [COMPONENTS NAME...] [TESTABLE])   see sclGenerate.cmake
# Cache variables, for what is not found by itself:
#   SCL_INCLUDE_DIR, SCL_CPP_INCLUDE_DIR   the folders of scl.h and scl.hpp
#   SCL_LIBRARY                            libscl.so or libscl.a
#   SCL_EXECUTABLE                         the program `scl`; only scl_generate needs it

if(CMAKE_VERSION VERSION_LESS 3.19)
  set(scl_FOUND FALSE)
  set(scl_NOT_FOUND_MESSAGE "SCL needs CMake 3.19 or later, and this is ${CMAKE_VERSION}; \
install a newer one, for example with `pip install cmake`")
  return()
endif()

# The prefix if this file is in <prefix>/share/scl/cmake or <prefix>/lib/cmake/scl, else the source tree of SCL.
get_filename_component(_scl_root "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

find_path(SCL_INCLUDE_DIR scl.h
  HINTS "${_scl_root}/include" "${_scl_root}/bindings/c/include"
  PATH_SUFFIXES scl
  DOC "The folder of scl.h")
find_path(SCL_CPP_INCLUDE_DIR scl.hpp
  HINTS "${_scl_root}/include" "${_scl_root}/bindings/cpp/include"
  PATH_SUFFIXES scl
  DOC "The folder of scl.hpp")
find_library(SCL_LIBRARY scl
  HINTS "${_scl_root}" "${_scl_root}/target/release" "${_scl_root}/target/debug"
  PATH_SUFFIXES lib lib64 "lib/${CMAKE_LIBRARY_ARCHITECTURE}"
  DOC "The C library of SCL")
find_program(SCL_EXECUTABLE scl
  HINTS "${_scl_root}/bin" "${_scl_root}/target/release" "${_scl_root}/target/debug" "$ENV{HOME}/.cargo/bin"
  DOC "The program `scl`, for scl_generate")
mark_as_advanced(SCL_INCLUDE_DIR SCL_CPP_INCLUDE_DIR SCL_LIBRARY SCL_EXECUTABLE)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(scl
  REQUIRED_VARS SCL_LIBRARY SCL_INCLUDE_DIR SCL_CPP_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "Install the C library with `cargo cinstall -p scl-c --release`, \
or build it in the source tree of SCL with `cargo build -p scl-c --release`")

if(scl_FOUND AND NOT TARGET scl::c)
  include(CMakeFindDependencyMacro)
  find_dependency(Threads)
  add_library(scl::c UNKNOWN IMPORTED)
  set_target_properties(scl::c PROPERTIES
    IMPORTED_LOCATION "${SCL_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${SCL_INCLUDE_DIR}"
    # The last two for a static library.
    INTERFACE_LINK_LIBRARIES "Threads::Threads;${CMAKE_DL_LIBS};m")
  add_library(scl::scl INTERFACE IMPORTED)
  set_target_properties(scl::scl PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${SCL_CPP_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES scl::c
    INTERFACE_COMPILE_FEATURES cxx_std_17)
endif()

if(scl_FOUND)
  include("${CMAKE_CURRENT_LIST_DIR}/sclGenerate.cmake")
endif()
unset(_scl_root)
