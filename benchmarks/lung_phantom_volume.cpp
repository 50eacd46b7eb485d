// Writes the phantom of a chest CT as volumes: shape3d_lung_phantom --help.
#include <exception>
#include <iostream>
#include <map>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/output_file.hpp"
#include "common/volume_write.hpp"
#include "support/lung_phantom.hpp"

namespace {
using namespace shape3d;

template <class T>
void write(const std::string& path, const test::LungPhantom& phantom,
           const std::vector<T>& samples) {
  apps::OutputFile file(path);
  const auto format = apps::written_volume_format(path);
  if (!format) throw std::invalid_argument(path + ": " + apps::unknown_volume_extension(path));
  apps::write_volume(file, *format, zmc::make_view(samples.data(), phantom.dims, phantom.spacing));
  file.commit();
}

int run(int argc, char** argv) {
  CLI::App program(
      "Makes the phantom of a chest CT with its truth; describes it on standard output.");
  std::string image, tissue, labels;
  test::LungPhantomOptions options;
  const std::map<std::string, test::PhantomNoise> kinds{{"gaussian", test::PhantomNoise::gaussian},
                                                        {"poisson", test::PhantomNoise::poisson},
                                                        {"rayleigh", test::PhantomNoise::rayleigh}};
  std::vector<std::int64_t> dims;
  program.add_option("IMAGE", image, "Intensities (.nrrd, .nii.gz, .mha)")->required();
  program.add_option("--tissue", tissue, "1 for wall, vessels and solid nodules");
  program.add_option("--labels", labels, "0 lung, 1 wall, 2 vessels, 3 … nodules");
  program.add_option("--noise", options.noise)->transform(CLI::CheckedTransformer(kinds));
  program.add_option("--hu", options.noise_hu, "Deviation of the noise");
  program.add_option("--seed", options.seed);
  program.add_option("--dims", dims)->delimiter(',')->expected(3);
  CLI11_PARSE(program, argc, argv);
  if (!dims.empty()) options.dims = {dims[0], dims[1], dims[2]};
  const test::LungPhantom phantom = test::make_lung_phantom(options);
  write(image, phantom, phantom.samples);
  if (!tissue.empty()) write(tissue, phantom, phantom.tissue());
  if (!labels.empty()) write(labels, phantom, phantom.labels);
  nlohmann::ordered_json nodules = nlohmann::ordered_json::array();
  for (const test::PhantomNodule& nodule : phantom.nodules) {
    nodules.push_back({{"kind", test::to_string(nodule.kind)},
                       {"label", nodule.label},
                       {"centre", {nodule.centre.x(), nodule.centre.y(), nodule.centre.z()}},
                       {"radius", nodule.radius}});
  }
  std::cout << nlohmann::ordered_json{{"half_level", test::LungPhantom::kHalfLevel},
                                      {"spacing",
                                       {phantom.spacing.x(), phantom.spacing.y(),
                                        phantom.spacing.z()}},
                                      {"nodules", nodules}}
                   .dump(2)
            << '\n';
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "shape3d_lung_phantom: " << error.what() << '\n';
    return 1;
  }
}
