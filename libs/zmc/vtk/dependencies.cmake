set(shape3d_zmc_vtk_COMPONENTS zmc)
set(shape3d_zmc_vtk_PACKAGES
  "VTK 9.1 COMPONENTS CommonCore CommonMisc CommonDataModel CommonExecutionModel")
