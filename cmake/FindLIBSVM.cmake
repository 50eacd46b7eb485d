# Finds libsvm (Chang, Lin 2011), which comes without a package configuration.
#   LIBSVM::LIBSVM   the library; its header is <svm.h>
#   LIBSVM_VERSION   3.24 when the header says 324
find_path(LIBSVM_INCLUDE_DIR svm.h PATH_SUFFIXES libsvm)
find_library(LIBSVM_LIBRARY NAMES svm libsvm)
mark_as_advanced(LIBSVM_INCLUDE_DIR LIBSVM_LIBRARY)

unset(LIBSVM_VERSION)
if(LIBSVM_INCLUDE_DIR)
  file(STRINGS ${LIBSVM_INCLUDE_DIR}/svm.h _libsvm_line REGEX "#define LIBSVM_VERSION [0-9]+")
  if(_libsvm_line MATCHES "([0-9]+)([0-9][0-9])$")
    set(LIBSVM_VERSION ${CMAKE_MATCH_1}.${CMAKE_MATCH_2})
  endif()
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LIBSVM
  REQUIRED_VARS LIBSVM_LIBRARY LIBSVM_INCLUDE_DIR
  VERSION_VAR LIBSVM_VERSION)

if(LIBSVM_FOUND AND NOT TARGET LIBSVM::LIBSVM)
  set(_libsvm_global "")
  if(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
    set(_libsvm_global GLOBAL)
  endif()
  add_library(LIBSVM::LIBSVM UNKNOWN IMPORTED ${_libsvm_global})
  set_target_properties(LIBSVM::LIBSVM PROPERTIES
    IMPORTED_LOCATION ${LIBSVM_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${LIBSVM_INCLUDE_DIR})
endif()
