# Finds hnswlib (Malkov, Yashunin 2018), headers alone, without a package configuration.
#   HNSWLIB::HNSWLIB   its header is <hnswlib/hnswlib.h>
find_path(HNSWLIB_INCLUDE_DIR hnswlib/hnswlib.h)
mark_as_advanced(HNSWLIB_INCLUDE_DIR)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HNSWLIB REQUIRED_VARS HNSWLIB_INCLUDE_DIR)

if(HNSWLIB_FOUND AND NOT TARGET HNSWLIB::HNSWLIB)
  set(_hnswlib_global "")
  if(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
    set(_hnswlib_global GLOBAL)
  endif()
  add_library(HNSWLIB::HNSWLIB INTERFACE IMPORTED ${_hnswlib_global})
  target_include_directories(HNSWLIB::HNSWLIB INTERFACE ${HNSWLIB_INCLUDE_DIR})
endif()
