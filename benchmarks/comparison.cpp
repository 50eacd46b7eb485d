#include "comparison.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <system_error>

#include <unistd.h>
#include <shape3d/zmc/extractor.hpp>

namespace shape3d::bench {
namespace {

// Each is next to what it is compared with.
constexpr SubjectName kFast[] = {
    {Method::zmc_compact, 1},         {Method::flying_edges, 1},
    {Method::zmc_compact_reused, 1},  {Method::zmc_compact_reused, 2},
    {Method::flying_edges, 2},        {Method::zmc_compact, 2},
    {Method::zmc_centroid, 1},        {Method::zmc_centroid_reused, 1},
    {Method::zmc_centroid_reused, 2}, {Method::zmc_centroid, 2},
    {Method::zmc_filter, 1},          {Method::zmc_filter, 2},
    {Method::zmc_attributes, 1},      {Method::flying_edges_attributes, 1}};
constexpr SubjectName kSlow[] = {
    {Method::marching_cubes, 1}, {Method::marching_cubes, 2}, {Method::lewiner, 1}};

/// The samples in a file for other processes.
class SampleFile {
 public:
  explicit SampleFile(const LoadedVolume& volume) {
    std::string name = (std::filesystem::temp_directory_path() / "table-3.1-XXXXXX").string();
    const int descriptor = mkstemp(name.data());
    if (descriptor < 0) throw std::system_error(errno, std::generic_category(), name);
    close(descriptor);
    path_ = name;
    std::ofstream file(path_, std::ios::binary);
    file.write(reinterpret_cast<const char*>(volume.samples.data()),
               static_cast<std::streamsize>(volume.samples.size()));
    file.close();
    if (!file) {
      std::filesystem::remove(path_);
      throw std::runtime_error(path_ + ": writing the samples failed");
    }
  }
  ~SampleFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  SampleFile(const SampleFile&) = delete;
  SampleFile& operator=(const SampleFile&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

double sample_at(const zmc::VolumeView& view, std::int64_t i) {
  switch (view.type) {
    case zmc::SampleType::int8:
      return static_cast<const std::int8_t*>(view.data)[i];
    case zmc::SampleType::uint8:
      return static_cast<const std::uint8_t*>(view.data)[i];
    case zmc::SampleType::int16:
      return static_cast<const std::int16_t*>(view.data)[i];
    case zmc::SampleType::uint16:
      return static_cast<const std::uint16_t*>(view.data)[i];
    case zmc::SampleType::int32:
      return static_cast<const std::int32_t*>(view.data)[i];
    case zmc::SampleType::float32:
      return static_cast<double>(static_cast<const float*>(view.data)[i]);
    case zmc::SampleType::float64:
      return static_cast<const double*>(view.data)[i];
  }
  return 0;
}

/// Counts of the compact surface, and the share of its triangles with a zero vertex. A vertex is a
/// zero vertex when the sample at the nearest lattice point equals the isovalue: the others lie on
/// lattice edges or in cells, between samples that do not.
void count(const Source& source, VolumeResult& result) {
  zmc::Options options;
  options.inside = zmc::Inside::above;
  zmc::Surface<float, std::int32_t> surface;
  zmc::extract(source.view, source.isovalue, options, surface);
  result.counts = surface.counts;
  std::vector<bool> zero(static_cast<std::size_t>(surface.vertex_count()));
  const std::array<std::int64_t, 3> strides = source.view.effective_strides();
  for (std::size_t v = 0; v < zero.size(); ++v) {
    std::int64_t i = 0;
    bool on_lattice = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float place = surface.positions[3 * v + axis];
      on_lattice = on_lattice && place == std::round(place);
      i += strides[axis] * std::lround(place);
    }
    zero[v] = on_lattice && sample_at(source.view, i) == source.isovalue;
  }
  std::int64_t touching = 0;
  for (std::size_t t = 0; t < surface.indices.size(); t += 3) {
    const auto at = [&](std::size_t c) {
      return zero[static_cast<std::size_t>(surface.indices[t + c])];
    };
    touching += at(0) || at(1) || at(2) ? 1 : 0;
  }
  result.zero_share =
      static_cast<double>(touching) / std::max(1.0, static_cast<double>(surface.triangle_count()));
}

struct Running {
  SubjectResult* result;
  std::unique_ptr<Subject> subject;
};

std::vector<Running> start(const SubjectName* first, const SubjectName* last, const Source& source,
                           std::vector<SubjectResult>& results, bool lewiner) {
  std::vector<Running> running;
  for (; first != last; ++first) {
    if (first->method == Method::lewiner && !lewiner) continue;
    SubjectResult& result = results.emplace_back();  // results has room: its elements stay
    result.name = *first;
    try {
      running.push_back({&result, make_subject(*first, source)});
      if (peak_is_reported(*first)) result.own_process = run_in_own_process(*first, source);
    } catch (const std::exception& error) {
      result.missing = error.what();
      if (!running.empty() && running.back().result == &result) running.pop_back();
    }
  }
  return running;
}

double run_once(const Running& running) {
  const auto start = std::chrono::steady_clock::now();
  const Measurement measurement = running.subject->run();
  running.result->wall.push_back(measurement.wall);
  running.result->cpu.push_back(measurement.cpu);
  running.result->stages.push_back(measurement.stages);
  running.result->last = measurement;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void measure_zero_price(const Source& source, std::size_t rounds, VolumeResult& result) {
  Source between = source;
  between.isovalue += 0.5;
  const SubjectName name{Method::zmc_compact_reused, 1};
  const std::unique_ptr<Subject> with = make_subject(name, source),
                                 without = make_subject(name, between);
  with->run();
  without->run();
  const auto a_triangle = [](const Measurement& m) {
    return m.cpu / static_cast<double>(std::max<std::int64_t>(1, m.triangles));
  };
  for (std::size_t round = 0; round < rounds; ++round) {
    const bool forwards = round % 2 == 0;
    const double first = a_triangle((forwards ? with : without)->run());
    const double second = a_triangle((forwards ? without : with)->run());
    result.zero_price.push_back(forwards ? first / second : second / first);
  }
}

void measure_one_pass(const LoadedVolume& volume, std::size_t rounds, VolumeResult& result) {
  const zmc::VolumeView& view = volume.view;
  const auto count = static_cast<std::int64_t>(volume.samples.size() / zmc::sample_size(view.type));
  double least = sample_at(view, 0), largest = least;
  for (std::int64_t i = 0; i < count; i += 7) {
    least = std::min(least, sample_at(view, i));
    largest = std::max(largest, sample_at(view, i));
  }
  std::vector<double> isovalues;
  for (int n = 0; n < 4; ++n) {
    isovalues.push_back(volume.isovalue + n * std::ceil((largest - volume.isovalue) / 16));
  }
  zmc::Options options;
  options.inside = zmc::Inside::above;
  options.threads = 1;
  zmc::Extractor single, several;
  std::vector<zmc::Surface<float, std::int32_t>> one(isovalues.size()), all;
  const auto seconds = [](const auto& work) {
    const std::clock_t start = std::clock();  // of the processor
    work();
    return static_cast<double>(std::clock() - start);
  };
  for (std::size_t round = 0; round <= rounds; ++round) {
    const double apart = seconds([&] {
      for (std::size_t n = 0; n < isovalues.size(); ++n) {
        single.extract(view, isovalues[n], options, one[n]);
      }
    });
    const double together = seconds([&] { several.extract(view, isovalues, options, all); });
    if (round > 0) result.one_pass_gain.push_back(apart / together);  // the first makes the memory
  }
}

}  // namespace

const SubjectResult* VolumeResult::find(Method method, int threads) const {
  for (const SubjectResult& subject : subjects) {
    if (subject.name == SubjectName{method, threads} && subject.missing.empty()) return &subject;
  }
  return nullptr;
}

VolumeResult compare(const LoadedVolume& volume, const ComparisonOptions& options) {
  const SampleFile file(volume);
  const Source source{volume.view, volume.isovalue, file.path()};
  VolumeResult result;
  result.name = volume.name;
  result.dims = volume.view.dims;
  result.type = volume.view.type;
  result.isovalue = volume.isovalue;
  count(source, result);
  result.subjects.reserve(std::size(kFast) + std::size(kSlow));
  const std::vector<Running> fast =
      start(std::begin(kFast), std::end(kFast), source, result.subjects, false);
  const std::vector<Running> slow =
      start(std::begin(kSlow), std::end(kSlow), source, result.subjects, options.lewiner);

  for (const Running& running : fast) running.subject->run();
  double spent = 0;
  std::vector<double> slow_spent(slow.size());
  std::size_t round = 0;
  const std::size_t least = static_cast<std::size_t>(options.least_rounds),
                    most = static_cast<std::size_t>(options.most_rounds),
                    slow_rounds = static_cast<std::size_t>(options.slow_rounds);
  for (; round < least || (round < most && spent < options.seconds); ++round) {
    for (std::size_t i = 0; i < fast.size(); ++i) {
      spent += run_once(fast[round % 2 == 0 ? i : fast.size() - 1 - i]);
    }
    for (std::size_t i = 0; i < slow.size(); ++i) {
      if (round < slow_rounds || slow_spent[i] < options.seconds) {
        slow_spent[i] += run_once(slow[i]);
      }
    }
  }
  if (volume.view.type != zmc::SampleType::float32 &&
      volume.view.type != zmc::SampleType::float64 &&
      volume.isovalue == std::floor(volume.isovalue)) {
    measure_zero_price(source, round, result);
  }
  measure_one_pass(volume, std::min<std::size_t>(round, 5), result);
  const SubjectResult* compact = result.find(Method::zmc_compact, 1);
  if (compact != nullptr) {
    result.floor = memory_floor(volume.samples.data(), volume.samples.size(),
                                static_cast<std::size_t>(compact->last.output_bytes));
  }
  return result;
}

}  // namespace shape3d::bench
