set(shape3d_mapping_PACKAGES "Eigen3 3.4 NO_MODULE")
set(shape3d_mapping_PRIVATE_PACKAGES "CGAL 5.5" "Ceres 2.1")
