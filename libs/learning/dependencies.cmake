set(shape3d_learning_PACKAGES "Eigen3 3.4 NO_MODULE")
set(shape3d_learning_PRIVATE_PACKAGES "TBB 2021 CONFIG" "LIBSVM 3.20 MODULE")
