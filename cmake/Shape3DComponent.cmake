# Components: libraries that are built, exported and found one by one.
include(CMakePackageConfigHelpers)
include(GenerateExportHeader)

set(SHAPE3D_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Shape3D)

# Adds the components, given in dependency order, and the package configuration over them.
# libs/<component>/dependencies.cmake is the only list of what one needs:
#   shape3d_<component>_COMPONENTS        other components
#   shape3d_<component>_PACKAGES          arguments of find_package, one string for each package
#   shape3d_<component>_PRIVATE_PACKAGES  the same, when no public header uses the package
function(shape3d_add_components)
  foreach(component IN LISTS ARGN)
    string(REPLACE _ / folder ${component})
    include(${PROJECT_SOURCE_DIR}/libs/${folder}/dependencies.cmake)
    foreach(package IN LISTS shape3d_${component}_PACKAGES shape3d_${component}_PRIVATE_PACKAGES)
      separate_arguments(arguments UNIX_COMMAND ${package})
      find_package(${arguments} REQUIRED)
    endforeach()
    add_subdirectory(libs/${folder})
  endforeach()
endfunction()

# Adds the library shape3d_<component>, called Shape3D::<component> here and after installation.
#   shape3d_add_library(<component> SOURCES … HEADERS … [PUBLIC libraries…] [PRIVATE libraries…])
# HEADERS: the public ones, below include/. PUBLIC: libraries named in a public header.
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
  # a·b + c is rounded twice on every machine: results can be compared across machines.
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
