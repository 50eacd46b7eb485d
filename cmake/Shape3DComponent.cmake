# Components: libraries that are built, installed and found one by one.
include(GenerateExportHeader)

# Adds components, given in dependency order; of these only the ones in SHAPE3D_COMPONENTS and those
# they need. libs/<component>/dependencies.cmake is the only list of what one needs:
#   shape3d_<component>_COMPONENTS        other components
#   shape3d_<component>_PACKAGES          arguments of find_package, one string for each package
#   shape3d_<component>_PRIVATE_PACKAGES  the same, for packages that no public header uses
# Component a_b lives in libs/a/b. Sets SHAPE3D_BUILT_COMPONENTS.
macro(shape3d_add_components)
  set(SHAPE3D_KNOWN_COMPONENTS ${ARGN})
  foreach(component IN LISTS SHAPE3D_KNOWN_COMPONENTS)
    string(REPLACE _ / shape3d_${component}_FOLDER libs/${component})
    include(${PROJECT_SOURCE_DIR}/${shape3d_${component}_FOLDER}/dependencies.cmake)
  endforeach()

  shape3d_select_components(SHAPE3D_BUILT_COMPONENTS)
  foreach(component IN LISTS SHAPE3D_BUILT_COMPONENTS)
    foreach(package IN LISTS shape3d_${component}_PACKAGES shape3d_${component}_PRIVATE_PACKAGES)
      separate_arguments(arguments UNIX_COMMAND ${package})
      find_package(${arguments} REQUIRED)
    endforeach()
    add_subdirectory(${shape3d_${component}_FOLDER})
  endforeach()
endmacro()

# SHAPE3D_COMPONENTS and what it needs, in dependency order.
function(shape3d_select_components result)
  set(wanted ${SHAPE3D_COMPONENTS})
  if(wanted STREQUAL "all")
    set(wanted ${SHAPE3D_KNOWN_COMPONENTS})
  endif()
  foreach(component IN LISTS wanted)
    if(NOT component IN_LIST SHAPE3D_KNOWN_COMPONENTS)
      message(FATAL_ERROR "SHAPE3D_COMPONENTS names '${component}'; expected 'all' or some of: "
        "${SHAPE3D_KNOWN_COMPONENTS}")
    endif()
  endforeach()

  set(selected "")
  set(dependents_first ${SHAPE3D_KNOWN_COMPONENTS})
  list(REVERSE dependents_first)
  foreach(component IN LISTS dependents_first)
    if(component IN_LIST wanted)
      list(APPEND wanted ${shape3d_${component}_COMPONENTS})
      list(PREPEND selected ${component})
    endif()
  endforeach()
  set(${result} ${selected} PARENT_SCOPE)
endfunction()

# Adds the library shape3d_<component>, called Shape3D::<component> here and after installation.
#   shape3d_add_library(<component> SOURCES … HEADERS … [PUBLIC libraries…] [PRIVATE libraries…])
# HEADERS: the public ones, below include/. PUBLIC: libraries that a public header uses.
function(shape3d_add_library component)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE")
  set(target shape3d_${component})
  string(TOUPPER ${target} macro_prefix)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/include)

  add_library(${target} ${arg_SOURCES})
  add_library(Shape3D::${component} ALIAS ${target})
  generate_export_header(${target} BASE_NAME ${macro_prefix}
    EXPORT_FILE_NAME ${generated}/shape3d/${component}/export.hpp)
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS include ${generated}
    FILES ${arg_HEADERS} ${generated}/shape3d/${component}/export.hpp)

  target_include_directories(${target} PRIVATE src)
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  target_compile_features(${target} PUBLIC cxx_std_17)
  if(NOT BUILD_SHARED_LIBS)
    target_compile_definitions(${target} PUBLIC ${macro_prefix}_STATIC_DEFINE)
  endif()
  # No fused multiply-add: results are the same on machines with and without it.
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off>)
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${component}
    CXX_EXTENSIONS OFF
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    POSITION_INDEPENDENT_CODE ON
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  shape3d_set_warnings(${target})
endfunction()
