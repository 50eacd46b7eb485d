#pragma once

// A class of VTK's kind, named and written as VTK's are, so that it takes the place of
// vtkFlyingEdges3D by its name alone.

#include <memory>

#include <vtkContourValues.h>
#include <vtkNew.h>
#include <vtkPolyDataAlgorithm.h>

#include "shape3d/zmc_vtk/export.hpp"

/// Isosurfaces of a vtkImageData by Zero-crossing Marching Cubes (shape3d/zmc/extract.hpp), with
/// the interface, the defaults and the orientation of vtkFlyingEdges3D.
///
/// Input: a 3D image; its origin, spacing, direction matrix and extent are honoured. Samples are
/// read where they are, whatever the number of components; unsigned int, 64-bit integer and bit
/// samples are converted to double first. Integers that a double cannot hold are an error.
/// Output: triangles that share vertices, contour after contour in the order of the values. The
/// arrays are the library's own, handed over without a copy when there is one contour; cells are
/// stored in 32 bits unless there are too many. See vtkCellArray::ConvertToDefaultStorage.
///
/// Triangles and normals point from the inside to the outside, by default from samples over the
/// value to samples under it, as those of vtkFlyingEdges3D. Without zero samples and ambiguous
/// faces the vertices are also those of vtkFlyingEdges3D; otherwise see there and here what a
/// closed surface needs.
///
/// Asked for a piece, the filter contours its part of the image; parts meet at common samples, and
/// their triangles do not overlap. At the seams normals and gradients are one-sided, and zero
/// samples are treated as at the border of an image.
///
/// Errors, as VTK reports them (ErrorEvent, empty output): there is no array to process, it is not
/// point data, has not the component, or its type is not known; the image is not 3D; a spacing is
/// 0; a contour value or (NON_FINITE_ERROR) a sample is not finite; memory is short. An image
/// without points gives an empty output. A run that is aborted (SetAbortExecute) gives an empty
/// output.
class SHAPE3D_ZMC_VTK_EXPORT vtkZeroCrossingMarchingCubes : public vtkPolyDataAlgorithm {
 public:
  static vtkZeroCrossingMarchingCubes* New();
  // clang-format off
  vtkTypeMacro(vtkZeroCrossingMarchingCubes, vtkPolyDataAlgorithm)
  void PrintSelf(ostream& os, vtkIndent indent) override;
  // clang-format on
  vtkMTimeType GetMTime() override;

  vtkZeroCrossingMarchingCubes(const vtkZeroCrossingMarchingCubes&) = delete;
  void operator=(const vtkZeroCrossingMarchingCubes&) = delete;

  /// The contour values; initially one, 0.
  void SetValue(int i, double value) { this->ContourValues->SetValue(i, value); }
  double GetValue(int i) { return this->ContourValues->GetValue(i); }
  double* GetValues() { return this->ContourValues->GetValues(); }
  void GetValues(double* values) { this->ContourValues->GetValues(values); }
  void SetNumberOfContours(int number) { this->ContourValues->SetNumberOfContours(number); }
  vtkIdType GetNumberOfContours() { return this->ContourValues->GetNumberOfContours(); }
  /// Evenly spaced values, ends of the range included.
  void GenerateValues(int number, double range[2]) {
    this->ContourValues->GenerateValues(number, range);
  }
  void GenerateValues(int number, double first, double last) {
    this->ContourValues->GenerateValues(number, first, last);
  }

  ///@{
  /// Point data "Normals", the active normals: unit vectors along the gradient, from the inside to
  /// the outside. Initially on.
  vtkSetMacro(ComputeNormals, vtkTypeBool);
  vtkGetMacro(ComputeNormals, vtkTypeBool);
  vtkBooleanMacro(ComputeNormals, vtkTypeBool);
  ///@}

  ///@{
  /// Point data "Gradients", the active vectors: the gradient of the samples in world units, by
  /// central differences. Initially off.
  vtkSetMacro(ComputeGradients, vtkTypeBool);
  vtkGetMacro(ComputeGradients, vtkTypeBool);
  vtkBooleanMacro(ComputeGradients, vtkTypeBool);
  ///@}

  ///@{
  /// Point data named as the samples, the active scalars: the contour value, in the samples' type
  /// or, when that is of integers and cannot hold all values, in double. Initially on.
  vtkSetMacro(ComputeScalars, vtkTypeBool);
  vtkGetMacro(ComputeScalars, vtkTypeBool);
  vtkBooleanMacro(ComputeScalars, vtkTypeBool);
  ///@}

  ///@{
  /// Other point data of the image, interpolated linearly along the lattice edges of the vertices:
  /// numeric arrays but ids and ghost flags. Integers become float, those of 32 bits and more
  /// double. Initially off.
  vtkSetMacro(InterpolateAttributes, vtkTypeBool);
  vtkGetMacro(InterpolateAttributes, vtkTypeBool);
  vtkBooleanMacro(InterpolateAttributes, vtkTypeBool);
  ///@}

  ///@{
  /// Component of the array to process, from 0, initially 0.
  vtkSetMacro(ArrayComponent, int);
  vtkGetMacro(ArrayComponent, int);
  ///@}

  ///@{
  /// Type of points, normals and gradients: vtkAlgorithm::SINGLE_PRECISION or DEFAULT_PRECISION
  /// (both float, initially the latter), DOUBLE_PRECISION.
  vtkSetClampMacro(OutputPointsPrecision, int, SINGLE_PRECISION, DEFAULT_PRECISION);
  vtkGetMacro(OutputPointsPrecision, int);
  ///@}

  /// Settings of the algorithm, described in shape3d/zmc/options.hpp.
  enum InsideSetting { INSIDE_BELOW, INSIDE_ABOVE };
  enum TieRuleSetting { TIE_RULE_NEUTRAL, TIE_RULE_POSITIVE };
  enum TriangulationSetting { TRIANGULATION_COMPACT, TRIANGULATION_CENTROID };
  enum ZeroFacesSetting { ZERO_FACES_BOUNDARY, ZERO_FACES_MATING };
  enum BorderSetting { BORDER_OPEN, BORDER_CAPPED };
  enum NonFiniteSetting { NON_FINITE_ERROR, NON_FINITE_MASK };

  ///@{
  /// The side of the value that is inside: initially INSIDE_ABOVE, as with vtkFlyingEdges3D.
  vtkSetClampMacro(Inside, int, INSIDE_BELOW, INSIDE_ABOVE);
  vtkGetMacro(Inside, int);
  void SetInsideToBelow() { this->SetInside(INSIDE_BELOW); }
  void SetInsideToAbove() { this->SetInside(INSIDE_ABOVE); }
  ///@}

  ///@{
  /// How equal products of an ambiguous face are ordered: initially TIE_RULE_NEUTRAL.
  vtkSetClampMacro(TieRule, int, TIE_RULE_NEUTRAL, TIE_RULE_POSITIVE);
  vtkGetMacro(TieRule, int);
  void SetTieRuleToNeutral() { this->SetTieRule(TIE_RULE_NEUTRAL); }
  void SetTieRuleToPositive() { this->SetTieRule(TIE_RULE_POSITIVE); }
  ///@}

  ///@{
  /// How a patch becomes triangles: initially TRIANGULATION_COMPACT.
  vtkSetClampMacro(Triangulation, int, TRIANGULATION_COMPACT, TRIANGULATION_CENTROID);
  vtkGetMacro(Triangulation, int);
  void SetTriangulationToCompact() { this->SetTriangulation(TRIANGULATION_COMPACT); }
  void SetTriangulationToCentroid() { this->SetTriangulation(TRIANGULATION_CENTROID); }
  ///@}

  ///@{
  /// Which cell faces of zero samples belong to the surface: initially ZERO_FACES_BOUNDARY.
  vtkSetClampMacro(ZeroFaces, int, ZERO_FACES_BOUNDARY, ZERO_FACES_MATING);
  vtkGetMacro(ZeroFaces, int);
  void SetZeroFacesToBoundary() { this->SetZeroFaces(ZERO_FACES_BOUNDARY); }
  void SetZeroFacesToMating() { this->SetZeroFaces(ZERO_FACES_MATING); }
  ///@}

  ///@{
  /// What happens at the border of the image: initially BORDER_OPEN.
  vtkSetClampMacro(Border, int, BORDER_OPEN, BORDER_CAPPED);
  vtkGetMacro(Border, int);
  void SetBorderToOpen() { this->SetBorder(BORDER_OPEN); }
  void SetBorderToCapped() { this->SetBorder(BORDER_CAPPED); }
  ///@}

  ///@{
  /// What a sample that is not finite means: initially NON_FINITE_ERROR.
  vtkSetClampMacro(NonFinite, int, NON_FINITE_ERROR, NON_FINITE_MASK);
  vtkGetMacro(NonFinite, int);
  void SetNonFiniteToError() { this->SetNonFinite(NON_FINITE_ERROR); }
  void SetNonFiniteToMask() { this->SetNonFinite(NON_FINITE_MASK); }
  ///@}

  ///@{
  /// Threads of the extraction; initially 0, as many as vtkSMPTools uses. The output does not
  /// depend on it.
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

 protected:
  vtkZeroCrossingMarchingCubes();
  ~vtkZeroCrossingMarchingCubes() override;

  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
                  vtkInformationVector* outputVector) override;
  int FillInputPortInformation(int port, vtkInformation* info) override;

  vtkNew<vtkContourValues> ContourValues;
  vtkTypeBool ComputeNormals = 1;
  vtkTypeBool ComputeGradients = 0;
  vtkTypeBool ComputeScalars = 1;
  vtkTypeBool InterpolateAttributes = 0;
  int ArrayComponent = 0;
  int OutputPointsPrecision = DEFAULT_PRECISION;
  int Inside = INSIDE_ABOVE;
  int TieRule = TIE_RULE_NEUTRAL;
  int Triangulation = TRIANGULATION_COMPACT;
  int ZeroFaces = ZERO_FACES_BOUNDARY;
  int Border = BORDER_OPEN;
  int NonFinite = NON_FINITE_ERROR;
  int NumberOfThreads = 0;

 private:
  struct Internals;
  std::unique_ptr<Internals> Memory;
};
