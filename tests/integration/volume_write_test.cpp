#include "common/volume_write.hpp"

#include <cmath>
#include <cstdlib>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "made_volumes.hpp"
#include "support/random_numbers.hpp"

namespace {
using namespace shape3d;
using namespace shape3d::apps;
using namespace shape3d::test;
using Catch::Matchers::Contains;

// A left-handed, turned and shifted lattice with spacings that no float holds.
struct Oblique {
  explicit Oblique(bool sheared = false) {
    const Eigen::Matrix3d turned = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) *
                                    Eigen::AngleAxisd(-0.7, Eigen::Vector3d(1, 2, 3).normalized()))
                                       .toRotationMatrix();
    view.dims = {5, 4, 3};
    view.spacing = {0.68, 0.7, 1.1};
    view.origin = {-123.4, 56.7, 1890.1};
    view.direction = turned * Eigen::Vector3d(1, 1, -1).asDiagonal();
    if (sheared)
      view.direction.col(2) = (view.direction.col(2) + 0.2 * view.direction.col(1)).normalized();
  }
  zmc::VolumeView view;
};

template <class T>
std::vector<T> samples_of(const zmc::VolumeView& view) {
  RandomNumbers random(11);
  std::vector<T> samples(static_cast<std::size_t>(view.dims[0] * view.dims[1] * view.dims[2]));
  for (T& sample : samples) sample = static_cast<T>(random.uniform(0.0, 120.0));
  return samples;
}

std::string written(const TemporaryFolder& folder, const std::string& name,
                    const zmc::VolumeView& view) {
  OutputFile file((folder / name).string());
  write_volume(file, *written_volume_format(name), view);
  file.commit();
  return (folder / name).string();
}

template <class T>
void check_round_trip(const std::string& name, double tolerance) {
  const TemporaryFolder folder;
  Oblique oblique;
  const std::vector<T> samples = samples_of<T>(oblique.view);
  oblique.view.data = samples.data();
  oblique.view.type = zmc::SampleTypeOf<T>::value;
  const Volume back = read_volume(written(folder, name, oblique.view));
  INFO(name << " " << zmc::to_string(oblique.view.type));
  CHECK(back.warnings.empty());
  CHECK(back.view.dims == oblique.view.dims);
  CHECK(back.view.type == oblique.view.type);
  CHECK((back.view.spacing - oblique.view.spacing).cwiseAbs().maxCoeff() <= tolerance);
  CHECK((back.view.direction - oblique.view.direction).cwiseAbs().maxCoeff() <= tolerance);
  CHECK((back.view.origin - oblique.view.origin).cwiseAbs().maxCoeff() <= 2000 * tolerance);
  CHECK(sample_values(back) == std::vector<double>(samples.begin(), samples.end()));
}

TEST_CASE("volumes read back with the samples and the place they were written with",
          "[volume-write]") {
  // Text headers hold doubles; the product of direction and spacing rounds once. NIfTI-1 has
  // floats of 2⁻²⁴.
  for (const auto& [name, tolerance] :
       {std::pair{"v.nrrd", 1e-15}, std::pair{"v.mha", 0.0}, std::pair{"v.nii.gz", 1.2e-7},
        std::pair{"v.nii", 1.2e-7}}) {
    check_round_trip<std::uint8_t>(name, tolerance);
    check_round_trip<std::int16_t>(name, tolerance);
    check_round_trip<float>(name, tolerance);
    check_round_trip<double>(name, tolerance);
  }
  check_round_trip<std::int8_t>("v.nrrd", 1e-15);
  check_round_trip<std::uint16_t>("v.mha", 0.0);
  check_round_trip<std::int32_t>("v.nii.gz", 1.2e-7);
}

TEST_CASE("strides are followed", "[volume-write]") {
  const TemporaryFolder folder;
  const std::vector<std::int16_t> samples{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  zmc::VolumeView view = zmc::make_view(samples.data(), {2, 2, 2});
  view.strides = {2, 8, 4};
  for (const char* name : {"s.nrrd", "s.mha", "s.nii.gz"}) {
    const Volume back = read_volume(written(folder, name, view));
    CHECK(sample_values(back) == std::vector<double>{0, 2, 8, 10, 4, 6, 12, 14});
  }
}

nlohmann::json read_by_nibabel(const TemporaryFolder& folder, const std::string& path) {
  const std::string out = (folder / "nibabel.json").string();
  const std::string command = std::string(SHAPE3D_TEST_PYTHON) + " " + SHAPE3D_TEST_SCRIPTS +
                              "/read_written_volume.py " + path + " > " + out;
  REQUIRE(std::system(command.c_str()) == 0);
  return nlohmann::json::parse(read_bytes(out));
}

TEST_CASE("nibabel reads the affine, both forms of it, and the samples", "[volume-write]") {
  for (const bool sheared : {false, true}) {
    const TemporaryFolder folder;
    Oblique oblique(sheared);
    const std::vector<std::uint8_t> samples = samples_of<std::uint8_t>(oblique.view);
    oblique.view.data = samples.data();
    oblique.view.type = zmc::SampleType::uint8;
    const nlohmann::json read = read_by_nibabel(folder, written(folder, "v.nii.gz", oblique.view));
    CHECK(read["shape"] == nlohmann::json({5, 4, 3}));
    CHECK(read["type"] == "uint8");
    CHECK(read["unit"] == "mm");
    CHECK(read["sform_code"] == 1);
    CHECK(read["samples"].get<std::vector<double>>() ==
          std::vector<double>(samples.begin(), samples.end()));
    CHECK(read["qform"].is_null() == sheared);  // a quaternion has no shear
    for (const char* form : {"affine", "qform"}) {
      if (read[form].is_null()) continue;
      const Eigen::Matrix3d columns = oblique.view.direction * oblique.view.spacing.asDiagonal();
      const Eigen::Vector3d to_ras(-1, -1, 1);
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
          CHECK(read[form][row][column].get<double>() ==
                Approx(to_ras[row] * columns(row, column)).margin(2e-7));
        CHECK(read[form][row][3].get<double>() ==
              Approx(to_ras[row] * oblique.view.origin[row]).epsilon(1e-7));
      }
    }
  }
}

#ifdef SHAPE3D_ITK_READER
TEST_CASE("ITK reads the place and the samples of every format", "[volume-write]") {
  for (const char* name : {"v.nrrd", "v.mha", "v.nii.gz"}) {
    const TemporaryFolder folder;
    Oblique oblique;
    const std::vector<std::uint8_t> samples = samples_of<std::uint8_t>(oblique.view);
    oblique.view.data = samples.data();
    oblique.view.type = zmc::SampleType::uint8;
    const std::string path = written(folder, name, oblique.view);
    const std::string out = (folder / "itk.json").string();
    REQUIRE(std::system((std::string(SHAPE3D_ITK_READER) + " " + path + " > " + out).c_str()) == 0);
    const nlohmann::json read = nlohmann::json::parse(read_bytes(out));
    INFO(name);
    const double tolerance = std::string(name) == "v.nii.gz" ? 2e-6 : 1e-12;
    for (int row = 0; row < 3; ++row) {
      CHECK(read["origin"][row].get<double>() == Approx(oblique.view.origin[row]).epsilon(1e-7));
      CHECK(read["spacing"][row].get<double>() ==
            Approx(oblique.view.spacing[row]).margin(tolerance));
      for (int column = 0; column < 3; ++column)
        CHECK(read["direction"][row][column].get<double>() ==
              Approx(oblique.view.direction(row, column)).margin(tolerance));
    }
    CHECK(read["samples"].get<std::vector<double>>() ==
          std::vector<double>(samples.begin(), samples.end()));
  }
}
#endif

TEST_CASE("what cannot be written is refused", "[volume-write]") {
  CHECK_FALSE(written_volume_format("a.vti").has_value());
  CHECK_FALSE(written_volume_format("a.gz").has_value());
  CHECK(written_volume_format("A.NII.GZ") == VolumeFormat::nifti);
  CHECK(unknown_volume_extension("a.vti") ==
        "unknown extension '.vti', expected .nrrd, .nii.gz, .nii or .mha");
  const TemporaryFolder folder;
  const std::vector<std::uint8_t> samples(32768 * 4);
  const zmc::VolumeView view = zmc::make_view(samples.data(), {32768, 2, 2});
  OutputFile file((folder / "a.nii.gz").string());
  CHECK_THROWS_WITH(write_volume(file, VolumeFormat::nifti, view),
                    Contains("axis 0 has 32768 samples; NIfTI-1 holds up to 32767"));
  CHECK_THROWS_WITH(write_volume(file, VolumeFormat::vti, view),
                    Contains("volumes are not written as VTI; expected NRRD, NIfTI or MetaImage"));
  CHECK_THROWS_AS(write_volume(file, VolumeFormat::nrrd, zmc::VolumeView{}), std::invalid_argument);
}

}  // namespace
