set(shape3d_levelset_PACKAGES "Eigen3 3.4 NO_MODULE")
set(shape3d_levelset_PRIVATE_PACKAGES "TBB 2021 CONFIG")
