#include "table_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <thread>

#include <vtkVersion.h>

#include "markdown_table.hpp"
#include "statistics.hpp"

namespace shape3d::bench {
namespace {

struct Column {
  Method method;
  int threads;
};

std::string with_threads(Column column) {
  return to_string(column.method) + ", " + std::to_string(column.threads) +
         (column.threads == 1 ? " thread" : " threads");
}

std::string percent(double share, int digits) { return fixed(100 * share, digits) + " %"; }

std::string median_and_quartiles(const std::vector<double>& values) {
  if (values.empty()) return {};
  const Spread s = spread(values);
  return fixed(s.median, 2) + " (" + fixed(s.lower, 2) + "–" + fixed(s.upper, 2) + ")";
}

std::string millions(double number) { return fixed(number / 1e6, 3); }

std::string surfaces(const std::vector<VolumeResult>& results) {
  MarkdownTable table({"volume", "samples, M", "cells, M", "isovalue", "MC, M", "Table 3.1, M",
                       "MC without degenerate, M", "ZMC compact, M", "of MC without degenerate",
                       "ZMC centroid, M", "Table 3.1, M", "zero vertices", "triangles at one"});
  const auto beside = [](double found, double printed) {
    const double excess = found / 1e6 / printed - 1;
    return fixed(printed, 2) + " (" + (excess < 0 ? "−" : "+") + percent(std::abs(excess), 2) + ")";
  };
  for (const VolumeResult& r : results) {
    const auto triangles = [&r](Method method) {
      const SubjectResult* s = r.find(method, 1);
      return s == nullptr ? 0.0 : static_cast<double>(s->last.triangles);
    };
    const double mc = triangles(Method::flying_edges), sound = triangles(Method::marching_cubes),
                 compact = triangles(Method::zmc_compact),
                 centroid = triangles(Method::zmc_centroid);
    const double cells = static_cast<double>((r.dims[0] - 1) * (r.dims[1] - 1) * (r.dims[2] - 1));
    const CtSize* printed = r.published;
    table.add({r.name, fixed(r.voxels() / 1e6, 2), fixed(cells / 1e6, 2), fixed(r.isovalue, 1),
               millions(mc), printed == nullptr ? std::string() : beside(mc, printed->mc_triangles),
               millions(sound), millions(compact),
               sound > 0 ? fixed(compact / sound, 4) : std::string(), millions(centroid),
               printed == nullptr ? std::string() : beside(centroid, printed->zmc_triangles),
               std::to_string(r.counts.zero_vertices), percent(r.zero_share, 2)});
  }
  return table.text();
}

std::string face_cases(const std::vector<VolumeResult>& results) {
  std::vector<std::string> head{"volume"};
  for (int c = 1; c <= 13; ++c) head.push_back(std::to_string(c));
  head.emplace_back("crossed faces with a zero");
  MarkdownTable table(head);
  for (const VolumeResult& r : results) {
    std::vector<std::string> row{r.name};
    double all = 0, crossed = 0, with_zero = 0;
    for (int c = 1; c <= 13; ++c) {
      const double n = static_cast<double>(r.counts.faces_by_case[static_cast<std::size_t>(c - 1)]);
      all += n;
      if (c == 1 || c == 2 || c == 7) continue;  // no line of the surface runs in such a face
      crossed += n;
      if (c != 3 && c != 6 && c != 13) with_zero += n;
    }
    for (const std::int64_t n : r.counts.faces_by_case) {
      row.push_back(percent(static_cast<double>(n) / std::max(1.0, all), 3));
    }
    row.push_back(percent(with_zero / std::max(1.0, crossed), 2));
    table.add(row);
  }
  return table.text();
}

constexpr Column kTimed[] = {{Method::zmc_compact, 1},    {Method::zmc_compact_reused, 1},
                             {Method::zmc_centroid, 1},   {Method::zmc_centroid_reused, 1},
                             {Method::flying_edges, 1},   {Method::marching_cubes, 1},
                             {Method::lewiner, 1},        {Method::zmc_filter, 1},
                             {Method::zmc_attributes, 1}, {Method::flying_edges_attributes, 1},
                             {Method::zmc_compact, 2},    {Method::zmc_compact_reused, 2},
                             {Method::zmc_centroid, 2},   {Method::zmc_centroid_reused, 2},
                             {Method::flying_edges, 2},   {Method::marching_cubes, 2},
                             {Method::zmc_filter, 2}};

std::string times(const std::vector<VolumeResult>& results) {
  std::string text;
  for (const VolumeResult& r : results) {
    MarkdownTable table({r.name, "wall, s", "quartiles", "processor, s", "M triangles/s", "runs"});
    for (const Column column : kTimed) {
      const SubjectResult* s = r.find(column.method, column.threads);
      if (s == nullptr) {
        table.add({with_threads(column)});
        continue;
      }
      const Spread wall = spread(s->wall), cpu = spread(s->cpu);
      table.add({with_threads(column), fixed(wall.median, 4),
                 fixed(wall.lower, 4) + "–" + fixed(wall.upper, 4), fixed(cpu.median, 4),
                 fixed(static_cast<double>(s->last.triangles) / wall.median / 1e6, 1),
                 std::to_string(s->wall.size())});
    }
    text += table.text() + '\n';
  }
  return text;
}

/// How many times as long the first takes as the second.
struct Pair {
  const char* name;
  Column slow, fast;
  bool processor;  ///< Also by the time of the processor.
};

constexpr Pair kPairs[] = {
    {"vtkFlyingEdges3D / ZMC, 1 thread", {Method::flying_edges, 1}, {Method::zmc_compact, 1}, true},
    {"vtkFlyingEdges3D / ZMC, 2 threads",
     {Method::flying_edges, 2},
     {Method::zmc_compact, 2},
     true},
    {"vtkMarchingCubes / ZMC, 1 thread",
     {Method::marching_cubes, 1},
     {Method::zmc_compact, 1},
     true},
    {"Lewiner / ZMC, 1 thread", {Method::lewiner, 1}, {Method::zmc_compact, 1}, true},
    {"vtkFlyingEdges3D / ZMC, normals and gradients, 1 thread",
     {Method::flying_edges_attributes, 1},
     {Method::zmc_attributes, 1},
     true},
    {"vtkZeroCrossingMarchingCubes / ZMC, 1 thread",
     {Method::zmc_filter, 1},
     {Method::zmc_compact, 1},
     true},
    {"vtkZeroCrossingMarchingCubes / ZMC, 2 threads",
     {Method::zmc_filter, 2},
     {Method::zmc_compact, 2},
     true},
    {"ZMC fresh / reused, 1 thread",
     {Method::zmc_compact, 1},
     {Method::zmc_compact_reused, 1},
     true},
    {"ZMC fresh / reused, 2 threads",
     {Method::zmc_compact, 2},
     {Method::zmc_compact_reused, 2},
     true},
    {"ZMC 1 / 2 threads, fresh", {Method::zmc_compact, 1}, {Method::zmc_compact, 2}, false},
    {"ZMC 1 / 2 threads, reused",
     {Method::zmc_compact_reused, 1},
     {Method::zmc_compact_reused, 2},
     false},
    {"vtkFlyingEdges3D 1 / 2 threads", {Method::flying_edges, 1}, {Method::flying_edges, 2}, false},
    {"ZMC centroid / compact, 1 thread",
     {Method::zmc_centroid, 1},
     {Method::zmc_compact, 1},
     true}};

std::string ratios(const std::vector<VolumeResult>& results, bool processor) {
  std::vector<std::string> head{"times as long"};
  for (const VolumeResult& r : results) head.push_back(r.name);
  MarkdownTable table(head);
  for (const Pair& pair : kPairs) {
    if (processor && !pair.processor) continue;
    std::vector<std::string> row{pair.name};
    for (const VolumeResult& r : results) {
      const SubjectResult* slow = r.find(pair.slow.method, pair.slow.threads);
      const SubjectResult* fast = r.find(pair.fast.method, pair.fast.threads);
      const bool both = slow != nullptr && fast != nullptr;
      row.push_back(
          !both ? std::string()
                : median_and_quartiles(pairwise_ratios(processor ? slow->cpu : slow->wall,
                                                       processor ? fast->cpu : fast->wall)));
    }
    table.add(row);
  }
  if (processor) {
    std::vector<std::string> row{"a triangle at the isovalue / at isovalue + ½"};
    for (const VolumeResult& r : results) row.push_back(median_and_quartiles(r.zero_price));
    table.add(row);
    row = {"four isovalues one after the other / in one pass"};
    for (const VolumeResult& r : results) row.push_back(median_and_quartiles(r.one_pass_gain));
    table.add(row);
  }
  return table.text();
}

std::string stages(const std::vector<VolumeResult>& results) {
  MarkdownTable table({"ms, 1 thread", "classify, fresh", "zero regions", "count", "generate",
                       "classify, reused", "zero regions", "count", "generate"});
  for (const VolumeResult& r : results) {
    std::vector<std::string> row{r.name};
    for (const Method method : {Method::zmc_compact, Method::zmc_compact_reused}) {
      const SubjectResult* s = r.find(method, 1);
      for (double zmc::Timings::*const stage :
           {&zmc::Timings::classify, &zmc::Timings::zero_regions, &zmc::Timings::count,
            &zmc::Timings::generate}) {
        std::vector<double> values;
        if (s != nullptr) {
          for (const zmc::Timings& timings : s->stages) values.push_back(1e3 * timings.*stage);
        }
        row.push_back(values.empty() ? std::string() : fixed(spread(values).median, 2));
      }
    }
    table.add(row);
  }
  return table.text();
}

constexpr Column kMeasured[] = {{Method::zmc_compact, 1},  {Method::zmc_compact, 2},
                                {Method::zmc_centroid, 1}, {Method::flying_edges, 1},
                                {Method::flying_edges, 2}, {Method::marching_cubes, 1},
                                {Method::lewiner, 1}};

std::string memory(const std::vector<VolumeResult>& results) {
  MarkdownTable table({"volume", "extractor", "input, MB", "output, MB", "peak of the process, MB",
                       "beyond input and output, MB", "bytes a sample"});
  for (const VolumeResult& r : results) {
    const double input = r.voxels() * static_cast<double>(zmc::sample_size(r.type));
    for (const Column column : kMeasured) {
      const SubjectResult* s = r.find(column.method, column.threads);
      if (s == nullptr) continue;
      const Measurement& m = s->own_process;
      const double beyond =
          static_cast<double>(m.resident_peak - m.resident_before - m.output_bytes);
      table.add({r.name, with_threads(column), fixed(input / 1e6, 1),
                 fixed(static_cast<double>(m.output_bytes) / 1e6, 1),
                 fixed(static_cast<double>(m.resident_peak) / 1e6, 1), fixed(beyond / 1e6, 1),
                 fixed(beyond / r.voxels(), 3)});
    }
  }
  return table.text();
}

std::string floors(const std::vector<VolumeResult>& results) {
  MarkdownTable table({"ms, 1 thread", "read input", "write output, fresh 4 KiB pages",
                       "fresh huge pages", "warm pages", "ZMC fresh / floor (huge)",
                       "ZMC reused / floor (warm)"});
  for (const VolumeResult& r : results) {
    const SubjectResult* fresh = r.find(Method::zmc_compact, 1);
    const SubjectResult* reused = r.find(Method::zmc_compact_reused, 1);
    if (fresh == nullptr || reused == nullptr) continue;
    const MemoryFloor& f = r.floor;
    table.add({r.name, fixed(1e3 * f.read, 2), fixed(1e3 * f.write_fresh, 2),
               fixed(1e3 * f.write_fresh_huge, 2), fixed(1e3 * f.write_warm, 2),
               fixed(spread(fresh->wall).median / (f.read + f.write_fresh_huge), 1),
               fixed(spread(reused->wall).median / (f.read + f.write_warm), 1)});
  }
  return table.text();
}

std::string growth(const std::vector<VolumeResult>& results) {
  MarkdownTable table({"extractor", "a, ns a sample", "b, ns a triangle", "largest error",
                       "exponent in samples", "exponent in triangles"});
  for (const Column column : kTimed) {
    std::vector<double> voxels, triangles, seconds;
    for (const VolumeResult& r : results) {
      const SubjectResult* s = r.find(column.method, column.threads);
      if (r.published == nullptr || s == nullptr || column.threads != 1) continue;
      voxels.push_back(r.voxels());
      triangles.push_back(static_cast<double>(s->last.triangles));
      seconds.push_back(spread(s->cpu).median);
    }
    if (seconds.size() < 3) continue;
    const Plane plane = fit_plane(voxels, triangles, seconds);
    table.add({with_threads(column), fixed(1e9 * plane.a, 2), fixed(1e9 * plane.b, 2),
               percent(plane.largest_error, 1), fixed(fit_exponent(voxels, seconds), 2),
               fixed(fit_exponent(triangles, seconds), 2)});
  }
  std::vector<double> voxels, mc_triangles, zmc_triangles, mc, zmc;
  for (const CtSize& size : kCtSizes) {
    voxels.push_back(static_cast<double>(size.dims[0] * size.dims[1] * size.dims[2]));
    mc_triangles.push_back(1e6 * size.mc_triangles);
    zmc_triangles.push_back(1e6 * size.zmc_triangles);
    mc.push_back(size.mc_seconds);
    zmc.push_back(size.zmc_seconds);
  }
  const auto published = [&](const char* name, const std::vector<double>& triangles,
                             const std::vector<double>& seconds) {
    const Plane plane = fit_plane(voxels, triangles, seconds);
    table.add({name, fixed(1e9 * plane.a, 2), fixed(1e9 * plane.b, 2),
               percent(plane.largest_error, 1), fixed(fit_exponent(voxels, seconds), 2),
               fixed(fit_exponent(triangles, seconds), 2)});
  };
  published("dissertation, MC (Lewiner)", mc_triangles, mc);
  published("dissertation, ZMC", zmc_triangles, zmc);
  return table.text();
}

std::string beside_dissertation(const std::vector<VolumeResult>& results) {
  MarkdownTable table({"size", "", "triangles then, M", "now, M", "seconds then", "now, 1 thread",
                       "now, 2 threads", "M triangles/s then", "now, 1 thread"});
  const auto median = [](const SubjectResult* s) {
    return s == nullptr ? 0 : spread(s->wall).median;
  };
  const auto shown = [](double seconds) { return seconds > 0 ? fixed(seconds, 4) : std::string(); };
  for (const VolumeResult& r : results) {
    if (r.published == nullptr) continue;
    const auto add = [&](const char* name, double then_triangles, double then_seconds,
                         Method method, bool threaded) {
      const SubjectResult* one = r.find(method, 1);
      const double seconds = median(one),
                   now = one == nullptr ? 0 : static_cast<double>(one->last.triangles) / 1e6;
      table.add({std::string(r.published->name), name, fixed(then_triangles, 2),
                 now > 0 ? fixed(now, 2) : std::string(), fixed(then_seconds, 2), shown(seconds),
                 threaded ? shown(median(r.find(method, 2))) : std::string(),
                 fixed(then_triangles / then_seconds, 2),
                 now > 0 ? fixed(now / seconds, 1) : std::string()});
    };
    add("Lewiner's MC; now scikit-image", r.published->mc_triangles, r.published->mc_seconds,
        Method::lewiner, false);
    add("ZMC, centroid", r.published->zmc_triangles, r.published->zmc_seconds, Method::zmc_centroid,
        true);
    add("ZMC, compact", r.published->zmc_triangles, r.published->zmc_seconds, Method::zmc_compact,
        true);
  }
  return table.text();
}

std::string first_line(const std::string& path, const std::string& start) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(start, 0) == 0) return line;
  }
  return {};
}

}  // namespace

bool peak_is_reported(const SubjectName& name) {
  return std::any_of(std::begin(kMeasured), std::end(kMeasured), [&name](const Column& column) {
    return column.method == name.method && column.threads == name.threads;
  });
}

Environment environment() {
  Environment e;
  const std::string model = first_line("/proc/cpuinfo", "model name");
  e.processor = model.empty() ? "unknown" : model.substr(model.find(':') + 2);
  e.processors = static_cast<int>(std::thread::hardware_concurrency());
  if (getloadavg(&e.load, 1) != 1) e.load = -1;
#if defined(__clang__)
  e.compiler = "Clang " __clang_version__;
#else
  e.compiler = "GCC " __VERSION__;
#endif
  e.flags = SHAPE3D_BENCHMARK_FLAGS;
  e.vtk = vtkVersion::GetVTKVersion();
  e.scikit_image = scikit_image_version();
  const std::string pages = first_line("/sys/kernel/mm/transparent_hugepage/enabled", "");
  const std::size_t open = pages.find('['), shut = pages.find(']');
  e.huge_pages = open == std::string::npos ? "unknown" : pages.substr(open + 1, shut - open - 1);
  return e;
}

std::string table_report(const Environment& e, const std::vector<VolumeResult>& results,
                         const std::string& picture) {
  std::string text =
      "# Table 3.1\n\nWritten by `scripts/benchmark-table-3.1.sh`, which runs everything again. "
      "Section 3.3.2 of the dissertation compares\nthe time of Zero-crossing Marching Cubes with "
      "Lewiner's Marching Cubes on five volumes. These are not available;\nthe generated volumes "
      "have their sizes and, within 1 %, their numbers of triangles "
      "(`benchmarks/ct_volume.hpp`).\n\n";
  text += "- Processor: " + e.processor + ", " + std::to_string(e.processors) +
          " threads; load at the start " + fixed(e.load, 1) +
          "; transparent huge pages: " + e.huge_pages + ".\n- Build: " + e.compiler + ", `" +
          e.flags + "`; VTK " + e.vtk +
          (e.scikit_image.empty() ? "; scikit-image is not installed"
                                  : "; scikit-image " + e.scikit_image) +
          ".\n"
          "- Times are those of the extraction alone: the volume is in memory, results are freed "
          "outside. "
          "*Fresh*: output and working\n  memory are allocated within the time. *Reused*: those of "
          "the run "
          "before are filled again. VTK's filters allocate afresh.\n"
          "- Normals, gradients and scalars are off unless named. Points are float everywhere; ids "
          "have 32 bits "
          "in ZMC, "
          "64 in VTK.\n  scikit-image's conversion to float32 and its normals cannot be left out.\n"
          "- Extractors take turns round by round, every second round backwards. Figures are "
          "medians; in "
          "brackets lower and upper quartile.\n\n";
  if (!picture.empty()) text += "![Seconds over triangles](" + picture + ")\n\n";
  text +=
      "## Surfaces\n\nMC: the table of 256 cases, as vtkFlyingEdges3D gives it, degenerate "
      "triangles at "
      "zero samples included;\nvtkMarchingCubes leaves these out. \"Triangles at one\": triangles "
      "of the "
      "compact surface with a zero vertex among their three.\n\n" +
      surfaces(results) +
      "\nThe 13 cases of cell faces (Fig. 3.7) among the cells that contain patches. A face is "
      "crossed unless it is of case 1, 2 or 7.\nThe dissertation's third volume had 2 % of case 2 "
      "and "
      "4 % of case 5.\n\n" +
      face_cases(results);
  text += "\n## Beside the dissertation\n\nThen: an Athlon 64 3700+. Its voxels are cells.\n\n" +
          beside_dissertation(results);
  text += "\n## Ratios\n\nPair by pair within rounds, wall clock:\n\n" + ratios(results, false) +
          "\nBy processor time, which other work on the machine disturbs less:\n\n" +
          ratios(results, true);
  text += "\n## Times\n\n" + times(results);
  text += "## Stages of ZMC compact\n\n" + stages(results);
  text +=
      "\n## Memory\n\nEach extraction in a process of its own. Peak: the most resident memory. "
      "Beyond: what the peak is above the\nmemory held before the extraction, which includes the "
      "input, and the output.\n\n" +
      memory(results);
  text += "\n## Floor\n\nReading the input once and writing the bytes of the compact surface.\n\n" +
          floors(results);
  text +=
      "\n## Growth\n\nOver the generated volumes: t = a·samples + b·triangles, least squares of "
      "relative residuals; and the exponents\nof t ∝ samples^e and t ∝ triangles^e.\n\n" +
      growth(results);
  return text;
}

}  // namespace shape3d::bench
