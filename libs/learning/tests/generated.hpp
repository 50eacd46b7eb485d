#pragma once

#include <cstdint>

#include "shape3d/learning/features.hpp"

/// Items of a generated set.
struct GeneratedSet {
  shape3d::learning::Features X;
  shape3d::learning::Labels labels;
};

/// Items in Gaussian clouds, in mixed order: `classes` clouds of standard deviation 1 with centres
/// drawn from a normal distribution of standard deviation `spread`; class c has a share in
/// proportion to c + 1. Components are then scaled by powers of ten, as real descriptors are
/// uneven.
GeneratedSet gaussian_clouds(int items, int dimension, int classes, double spread,
                             std::uint64_t seed);
