# Installs the components and the package configuration that finds them.
include(CMakePackageConfigHelpers)
set(SHAPE3D_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Shape3D)

foreach(component IN LISTS SHAPE3D_BUILT_COMPONENTS)
  install(TARGETS shape3d_${component} EXPORT Shape3D_${component}Targets FILE_SET HEADERS)
  install(EXPORT Shape3D_${component}Targets NAMESPACE Shape3D:: DESTINATION ${SHAPE3D_CONFIG_DIR})

  set(components ${shape3d_${component}_COMPONENTS})
  set(packages ${shape3d_${component}_PACKAGES})
  if(NOT BUILD_SHARED_LIBS) # whoever links a static library links what is inside, too
    list(APPEND packages ${shape3d_${component}_PRIVATE_PACKAGES})
  endif()
  set(dependencies ${PROJECT_BINARY_DIR}/package/${component}-dependencies.cmake)
  file(CONFIGURE OUTPUT ${dependencies} @ONLY CONTENT [[
set(shape3d_@component@_COMPONENTS "@components@")
set(shape3d_@component@_PACKAGES "@packages@")
]])
  install(FILES ${dependencies} DESTINATION ${SHAPE3D_CONFIG_DIR})
endforeach()

configure_package_config_file(cmake/Shape3DConfig.cmake.in package/Shape3DConfig.cmake
  INSTALL_DESTINATION ${SHAPE3D_CONFIG_DIR}
  NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(package/Shape3DConfigVersion.cmake
  COMPATIBILITY SameMinorVersion) # the interface may change with 0.x
install(
  FILES
    ${PROJECT_BINARY_DIR}/package/Shape3DConfig.cmake
    ${PROJECT_BINARY_DIR}/package/Shape3DConfigVersion.cmake
  DESTINATION ${SHAPE3D_CONFIG_DIR})
if("learning" IN_LIST SHAPE3D_BUILT_COMPONENTS)
  install(FILES cmake/FindHNSWLIB.cmake cmake/FindLIBSVM.cmake DESTINATION ${SHAPE3D_CONFIG_DIR}/modules)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
