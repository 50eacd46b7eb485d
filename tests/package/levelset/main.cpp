// Looks at an image through a view. Fails unless the region of interest has the size asked for.
#include <cstdint>
#include <cstdio>
#include <vector>

#include <shape3d/levelset/image_view.hpp>

int main() {
  const std::vector<std::int16_t> samples(64, 0);
  const auto image = shape3d::levelset::make_view(samples.data(), {4, 4, 4});
  const auto roi = shape3d::levelset::subvolume(image, {{1, 1, 1}, {3, 4, 4}});
  std::printf("samples = %lld\n", static_cast<long long>(roi.grid().size()));
  return roi.grid().size() == 18 ? 0 : 1;
}
