#include "subjects.hpp"

#include <array>
#include <chrono>
#include <fstream>
#include <iostream>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include <shape3d/zmc_vtk/vtkZeroCrossingMarchingCubes.h>
#include <sys/resource.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkImageImport.h>
#include <vtkMarchingCubes.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <shape3d/zmc/extractor.hpp>

#include "common/vtk_samples.hpp"
#include "line_process.hpp"

namespace shape3d::bench {
namespace {

constexpr const char* kPython = "/usr/bin/python3";  // Debian's, which python3-skimage serves

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Times a function by the wall clock and by the processors.
template <class Function>
void time(Measurement& measurement, Function&& function) {
  const double cpu = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  function();
  measurement.wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  measurement.cpu = cpu_seconds() - cpu;
}

/// Whether surface and working memory are those of the last run.
enum class Memory { fresh, reused };
/// Whether normals and gradients are asked for.
enum class Attributes { none, all };

class Zmc : public Subject {
 public:
  using Surface = zmc::Surface<float, std::int32_t>;

  Zmc(const Source& source, zmc::Triangulation triangulation, int threads, Memory memory,
      Attributes attributes = Attributes::none)
      : source_(source), reused_(memory == Memory::reused) {
    options_.inside = zmc::Inside::above;
    options_.triangulation = triangulation;
    options_.threads = threads;
    options_.normals = options_.gradients = attributes == Attributes::all;
  }

  Measurement run() override {
    if (reused_) {
      return measured(surface_, [this] {
        extractor_.extract(source_.view, source_.isovalue, options_, surface_);
      });
    }
    Surface surface;
    return measured(surface,
                    [&] { zmc::extract(source_.view, source_.isovalue, options_, surface); });
  }

 private:
  template <class Function>
  static Measurement measured(const Surface& surface, Function&& function) {
    Measurement result;
    time(result, function);
    result.triangles = surface.triangle_count();
    result.vertices = surface.vertex_count();
    const std::size_t reals =
        surface.positions.size() + surface.normals.size() + surface.gradients.size();
    result.output_bytes = static_cast<std::int64_t>(reals * sizeof(float) +
                                                    surface.indices.size() * sizeof(std::int32_t));
    result.stages = surface.timings;
    return result;
  }

  Source source_;
  bool reused_;
  zmc::Options options_;
  zmc::Extractor extractor_;
  Surface surface_;
};

/// VTK's filters always allocate their output afresh.
template <class Filter>
class Vtk : public Subject {
 public:
  Vtk(const Source& source, int threads, Attributes attributes = Attributes::none)
      : isovalue_(source.isovalue), threads_(threads), attributes_(attributes == Attributes::all) {
    const zmc::VolumeView& view = source.view;
    std::array<int, 6> extent{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      extent[2 * axis + 1] = static_cast<int>(view.dims[axis] - 1);
    }
    import_->SetImportVoidPointer(
        const_cast<void*>(view.data));  // read only; VTK's interface has no const
    import_->SetDataScalarType(apps::vtk_type(view.type));
    import_->SetNumberOfScalarComponents(1);
    import_->SetDataExtent(extent.data());
    import_->SetWholeExtent(extent.data());
    import_->SetDataSpacing(view.spacing.data());
    import_->Update();
  }

  Measurement run() override {
    vtkSMPTools::Initialize(threads_);
    vtkNew<Filter> filter;
    filter->SetInputData(import_->GetOutput());
    filter->SetComputeNormals(attributes_);
    filter->SetComputeGradients(attributes_);
    filter->ComputeScalarsOff();
    filter->SetValue(0, isovalue_);
    Measurement result;
    time(result, [&] { filter->Update(); });
    vtkPolyData* output = filter->GetOutput();
    result.triangles = output->GetNumberOfPolys();
    result.vertices = output->GetNumberOfPoints();
    result.output_bytes = static_cast<std::int64_t>(output->GetActualMemorySize()) * 1024;
    return result;
  }

 private:
  vtkNew<vtkImageImport> import_;
  double isovalue_;
  int threads_;
  bool attributes_;
};

class Lewiner : public Subject {
 public:
  explicit Lewiner(const Source& source) : process_(command(source)) {
    const std::optional<std::string> answer = process_.read_line();
    if (!answer || answer->rfind("ready", 0) != 0) {
      throw std::runtime_error(std::string(kPython) +
                               " has no scikit-image (Debian package python3-skimage)");
    }
  }

  Measurement run() override {
    process_.write_line("run");
    const std::optional<std::string> answer = process_.read_line();
    Measurement result;
    std::istringstream words(answer.value_or(""));
    if (!(words >> result.wall >> result.cpu >> result.triangles >> result.vertices >>
          result.output_bytes >> result.resident_before >> result.resident_peak)) {
      throw std::runtime_error("scikit-image's marching_cubes() gave no result");
    }
    return result;
  }

 private:
  static std::vector<std::string> command(const Source& source) {
    std::ostringstream isovalue;
    isovalue.precision(17);
    isovalue << source.isovalue;
    return {kPython,
            SHAPE3D_BENCHMARK_SCRIPTS "/lewiner.py",
            source.file,
            std::string(zmc::to_string(source.view.type)),
            std::to_string(source.view.dims[0]),
            std::to_string(source.view.dims[1]),
            std::to_string(source.view.dims[2]),
            isovalue.str()};
  }

  LineProcess process_;
};

/// Bytes of a field of /proc/self/status; 0 when there is none.
std::int64_t status_bytes(const std::string& field) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::int64_t kibibytes = 0;
    if (word == field + ":" && status >> kibibytes) return kibibytes * 1024;
  }
  return 0;
}

}  // namespace

std::string to_string(Method method) {
  switch (method) {
    case Method::zmc_compact:
      return "ZMC compact";
    case Method::zmc_centroid:
      return "ZMC centroid";
    case Method::zmc_compact_reused:
      return "ZMC compact, reused";
    case Method::zmc_centroid_reused:
      return "ZMC centroid, reused";
    case Method::zmc_attributes:
      return "ZMC compact, normals and gradients";
    case Method::zmc_filter:
      return "vtkZeroCrossingMarchingCubes";
    case Method::flying_edges:
      return "vtkFlyingEdges3D";
    case Method::flying_edges_attributes:
      return "vtkFlyingEdges3D, normals and gradients";
    case Method::marching_cubes:
      return "vtkMarchingCubes";
    case Method::lewiner:
      return "scikit-image Lewiner";
  }
  return {};
}

std::unique_ptr<Subject> make_subject(const SubjectName& name, const Source& source) {
  using zmc::Triangulation;
  switch (name.method) {
    case Method::zmc_compact:
      return std::make_unique<Zmc>(source, Triangulation::compact, name.threads, Memory::fresh);
    case Method::zmc_centroid:
      return std::make_unique<Zmc>(source, Triangulation::centroid, name.threads, Memory::fresh);
    case Method::zmc_compact_reused:
      return std::make_unique<Zmc>(source, Triangulation::compact, name.threads, Memory::reused);
    case Method::zmc_centroid_reused:
      return std::make_unique<Zmc>(source, Triangulation::centroid, name.threads, Memory::reused);
    case Method::zmc_attributes:
      return std::make_unique<Zmc>(source, Triangulation::compact, name.threads, Memory::fresh,
                                   Attributes::all);
    case Method::zmc_filter:
      return std::make_unique<Vtk<vtkZeroCrossingMarchingCubes>>(source, name.threads);
    case Method::flying_edges:
      return std::make_unique<Vtk<vtkFlyingEdges3D>>(source, name.threads);
    case Method::flying_edges_attributes:
      return std::make_unique<Vtk<vtkFlyingEdges3D>>(source, name.threads, Attributes::all);
    case Method::marching_cubes:
      return std::make_unique<Vtk<vtkMarchingCubes>>(source, name.threads);
    case Method::lewiner:
      return std::make_unique<Lewiner>(source);
  }
  throw std::logic_error("no such method");
}

Measurement run_in_own_process(const SubjectName& name, const Source& source) {
  if (name.method == Method::lewiner) return make_subject(name, source)->run();
  std::vector<std::string> command{"/proc/self/exe", "own-process"};
  const auto add = [&command](const auto& value) {
    std::ostringstream text;
    text.precision(17);
    text << value;
    command.push_back(text.str());
  };
  add(static_cast<int>(name.method));
  add(name.threads);
  add(static_cast<int>(source.view.type));
  for (const std::int64_t dim : source.view.dims) add(dim);
  add(source.isovalue);
  command.push_back(source.file);
  LineProcess process(command);
  Measurement result;
  std::istringstream words(process.read_line().value_or(""));
  if (!(words >> result.wall >> result.cpu >> result.triangles >> result.vertices >>
        result.output_bytes >> result.resident_before >> result.resident_peak)) {
    throw std::runtime_error(to_string(name.method) + " ended without a result");
  }
  return result;
}

int run_as_own_process(const std::vector<std::string>& arguments) {
  std::string text;
  for (const std::string& argument : arguments) text += argument + ' ';
  std::istringstream words(text);
  int method = 0, type = 0;
  SubjectName name{};
  Source source;
  words >> method >> name.threads >> type >> source.view.dims[0] >> source.view.dims[1] >>
      source.view.dims[2] >> source.isovalue;
  if (!words || arguments.size() != 8) return 2;
  name.method = static_cast<Method>(method);
  source.view.type = static_cast<zmc::SampleType>(type);
  source.file = arguments.back();

  const std::vector<std::int16_t> ramp = [] {
    std::vector<std::int16_t> samples(16 * 16 * 16);
    std::iota(samples.begin(), samples.end(), std::int16_t{0});
    return samples;
  }();
  // The code is loaded and the threads are there before anything is measured.
  make_subject(name, {zmc::make_view(ramp.data(), {16, 16, 16}), 2000.5, {}})->run();

  std::vector<char> samples(
      static_cast<std::size_t>(source.view.dims[0] * source.view.dims[1] * source.view.dims[2]) *
      zmc::sample_size(source.view.type));
  std::ifstream file(source.file, std::ios::binary);
  if (!file.read(samples.data(), static_cast<std::streamsize>(samples.size()))) return 2;
  source.view.data = samples.data();
  const std::unique_ptr<Subject> subject = make_subject(name, source);
  std::ofstream("/proc/self/clear_refs") << 5;  // VmHWM starts again at VmRSS
  const std::int64_t before = status_bytes("VmRSS");
  const Measurement result = subject->run();
  std::cout << result.wall << ' ' << result.cpu << ' ' << result.triangles << ' ' << result.vertices
            << ' ' << result.output_bytes << ' ' << before << ' ' << status_bytes("VmHWM")
            << std::endl;
  return 0;
}

std::string scikit_image_version() {
  LineProcess process({kPython, "-c",
                       "import importlib.metadata as m\n"
                       "try: print(m.version('scikit-image'))\n"
                       "except m.PackageNotFoundError: pass"});
  return process.read_line().value_or("");
}

}  // namespace shape3d::bench
