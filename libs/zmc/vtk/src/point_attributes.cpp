#include "point_attributes.hpp"

#include <cstring>

#include <vtkArrayDispatch.h>
#include <vtkDataArrayRange.h>
#include <vtkDataSetAttributes.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkPointData.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>

namespace shape3d::zmc_vtk {
namespace {

/// Interpolates one array.
struct Interpolation {
  const VertexSources& sources;

  template <class In>
  void operator()(In* in, vtkDataArray* out) const {
    if (auto* real = vtkFloatArray::FastDownCast(out)) return run(in, real->GetPointer(0));
    run(in, vtkDoubleArray::FastDownCast(out)->GetPointer(0));
  }

  template <class In, class Out>
  void run(In* in, Out* out) const {
    const auto values = vtk::DataArrayTupleRange(in);
    const int components = in->GetNumberOfComponents();
    const auto edges = [&](vtkIdType first, vtkIdType last) {
      for (vtkIdType v = first; v < last; ++v) {
        const auto n = static_cast<std::size_t>(v);
        if (sources.lower[n] < 0) continue;
        const auto lower = values[sources.lower[n]], upper = values[sources.upper[n]];
        const double t = sources.parameters[n];
        for (int c = 0; c < components; ++c) {
          const auto a = static_cast<double>(lower[c]), b = static_cast<double>(upper[c]);
          // At a sample the other end, which may not be finite, does not count.
          out[v * components + c] = static_cast<Out>(t == 0.0 ? a : (1.0 - t) * a + t * b);
        }
      }
    };
    const auto centroids = [&](vtkIdType first, vtkIdType last) {
      for (vtkIdType v = first; v < last; ++v) {
        const std::int64_t lower = sources.lower[static_cast<std::size_t>(v)];
        if (lower >= 0) continue;
        const auto centroid = static_cast<std::size_t>(-1 - lower);
        const auto begin = static_cast<std::size_t>(sources.first[centroid]),
                   end = static_cast<std::size_t>(sources.first[centroid + 1]);
        for (int c = 0; c < components; ++c) {
          double sum = 0.0;
          for (std::size_t m = begin; m < end; ++m)
            sum += static_cast<double>(out[sources.members[m] * components + c]);
          out[v * components + c] = static_cast<Out>(sum / static_cast<double>(end - begin));
        }
      }
    };
    const auto count = static_cast<vtkIdType>(sources.lower.size());
    vtkSMPTools::For(0, count, edges);
    if (sources.first.size() > 1) vtkSMPTools::For(0, count, centroids);
  }
};

/// A real array that holds means of values of `in` at its precision.
vtkSmartPointer<vtkDataArray> real_array_like(const vtkDataArray& in) {
  const int type = const_cast<vtkDataArray&>(in).GetDataType();
  const bool single = type == VTK_FLOAT || (type != VTK_DOUBLE && in.GetDataTypeSize() < 4);
  auto out = vtkSmartPointer<vtkDataArray>::Take(
      vtkDataArray::CreateDataArray(single ? VTK_FLOAT : VTK_DOUBLE));
  out->SetNumberOfComponents(const_cast<vtkDataArray&>(in).GetNumberOfComponents());
  return out;
}

bool is_interpolated(vtkPointData& data, int n) {
  const int attribute = data.IsArrayAnAttribute(n);
  if (attribute == vtkDataSetAttributes::GLOBALIDS ||
      attribute == vtkDataSetAttributes::PEDIGREEIDS)
    return false;
  const char* name = data.GetArray(n)->GetName();
  return name == nullptr || std::strcmp(name, vtkDataSetAttributes::GhostArrayName()) != 0;
}

}  // namespace

template <class Real, class Index>
VertexSources vertex_sources(const zmc::Surface<Real, Index>& surface,
                             const ImageSamples& samples) {
  const auto& dims = samples.view.dims;
  const std::size_t count = surface.edges.size();
  VertexSources sources;
  sources.lower.resize(count);
  sources.upper.resize(count);
  sources.parameters.assign(surface.edge_parameters.begin(), surface.edge_parameters.end());
  std::int64_t centroids = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const std::int64_t edge = surface.edges[n];
    if (edge < 0) {
      sources.lower[n] = sources.upper[n] = -1 - centroids++;
      continue;
    }
    const std::int64_t sample = edge / 3;
    const std::int64_t point =
        samples.point(sample % dims[0], sample / dims[0] % dims[1], sample / dims[0] / dims[1]);
    sources.lower[n] = sources.upper[n] = point;
    if (sources.parameters[n] > 0.0)
      sources.upper[n] += samples.strides[static_cast<std::size_t>(edge % 3)];
  }
  sources.first.assign(static_cast<std::size_t>(centroids) + 1, 0);
  if (centroids == 0) return sources;

  // Each triangle at a centroid names one more vertex of its polygon: the one that follows.
  const auto for_each_member = [&](const auto& body) {
    for (std::size_t corner = 0; corner < surface.indices.size(); ++corner) {
      const std::int64_t lower = sources.lower[static_cast<std::size_t>(surface.indices[corner])];
      const std::size_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
      if (lower < 0) body(static_cast<std::size_t>(-1 - lower), surface.indices[next]);
    }
  };
  for_each_member([&](std::size_t centroid, Index) { ++sources.first[centroid + 1]; });
  for (std::size_t c = 1; c < sources.first.size(); ++c) sources.first[c] += sources.first[c - 1];
  sources.members.resize(static_cast<std::size_t>(sources.first.back()));
  std::vector<std::int64_t> place(sources.first.begin(), sources.first.end() - 1);
  for_each_member([&](std::size_t centroid, Index member) {
    sources.members[static_cast<std::size_t>(place[centroid]++)] = member;
  });
  return sources;
}

void interpolate_attributes(vtkPointData& from, const vtkDataArray* skipped,
                            const VertexSources& sources, vtkPointData& to) {
  for (int n = 0; n < from.GetNumberOfArrays(); ++n) {
    vtkDataArray* in = from.GetArray(n);
    if (in == nullptr || in == skipped || !is_interpolated(from, n)) continue;
    const vtkSmartPointer<vtkDataArray> out = real_array_like(*in);
    out->SetName(in->GetName());
    out->SetNumberOfTuples(static_cast<vtkIdType>(sources.lower.size()));
    const Interpolation interpolation{sources};
    if (!vtkArrayDispatch::Dispatch::Execute(in, interpolation, out.Get()))
      interpolation(in, out.Get());
    const int place = to.AddArray(out), attribute = from.IsArrayAnAttribute(n);
    if (attribute >= 0) to.SetActiveAttribute(place, attribute);
  }
}

template VertexSources vertex_sources(const zmc::Surface<float, std::int32_t>&,
                                      const ImageSamples&);
template VertexSources vertex_sources(const zmc::Surface<float, std::int64_t>&,
                                      const ImageSamples&);
template VertexSources vertex_sources(const zmc::Surface<double, std::int32_t>&,
                                      const ImageSamples&);
template VertexSources vertex_sources(const zmc::Surface<double, std::int64_t>&,
                                      const ImageSamples&);

}  // namespace shape3d::zmc_vtk
