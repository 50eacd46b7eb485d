find_package(Catch2 2.13 REQUIRED) # never define CATCH_CONFIG_ENABLE_BENCHMARKING: Debian's library has it off
include(Catch)

# Adds a test program and its test cases to ctest, named <name>.<test case>.
#   shape3d_add_tests(<name> LABEL unit|integration|package|slow SOURCES … LINK …
#                     [TIMEOUT seconds] [PROPERTIES further properties of each test…])
function(shape3d_add_tests name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "LABEL;TIMEOUT" "SOURCES;LINK;PROPERTIES")
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  set(target shape3d_${name}_tests)
  add_executable(${target} ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE ${arg_LINK} shape3d_test_support)
  shape3d_set_warnings(${target})
  catch_discover_tests(${target} TEST_PREFIX "${name}."
    PROPERTIES LABELS ${arg_LABEL} TIMEOUT ${arg_TIMEOUT} ${arg_PROPERTIES})
endfunction()
