#pragma once

#include <cstdint>
#include <vector>

#include <vtkSmartPointer.h>

#include "mesh.hpp"
#include "output_file.hpp"

class vtkPolyData;
class vtkUnsignedCharArray;

namespace shape3d::apps {

/// The mesh as VTK sees it: its memory is borrowed, so it must outlive the result; the offsets of
/// the triangles are new (4 or 8 bytes a triangle). Arrays come along as point and cell data.
[[nodiscard]] vtkSmartPointer<vtkPolyData> borrow_polydata(const MeshView& mesh);

/// Red, green and blue bytes as what VTK colors cells or points by.
[[nodiscard]] vtkSmartPointer<vtkUnsignedCharArray> color_array(
    const std::vector<std::uint8_t>& bytes);

/// Writes VTK XML (appended binary) into the temporary file of `file`; does not commit it.
/// @throws FileError  writing failed.
void write_polydata(OutputFile& file, vtkPolyData* data);

}  // namespace shape3d::apps
