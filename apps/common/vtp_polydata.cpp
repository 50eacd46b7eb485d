#include "vtp_polydata.hpp"

#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include "child_process.hpp"
#include "error.hpp"
#include "vtk_messages.hpp"

namespace shape3d::apps::formats {
namespace {

// The way from the child to this process: sizes and bytes one after another.
class Packer {
 public:
  void put(std::int64_t number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put(static_cast<std::int64_t>(values.size()));
    if (!values.empty()) {
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    }
  }
  void put(const std::string& text) {
    put(static_cast<std::int64_t>(text.size()));
    bytes_ += text;
  }
  void put(const std::vector<MeshArray>& arrays) {
    put(static_cast<std::int64_t>(arrays.size()));
    for (const MeshArray& array : arrays) {
      put(array.name);
      put(std::get<std::vector<double>>(array.values));
    }
  }
  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

  void get(std::int64_t& number) { copy(&number, 1, sizeof number); }
  template <class T>
  void get(std::vector<T>& values) {
    values.resize(count(sizeof(T)));
    copy(values.data(), values.size(), sizeof(T));
  }
  void get(std::string& text) {
    text.resize(count(1));
    copy(text.data(), text.size(), 1);
  }
  void get(std::vector<MeshArray>& arrays) {
    arrays.resize(count(2 * sizeof(std::int64_t)));
    for (MeshArray& array : arrays) {
      std::vector<double> values;
      get(array.name);
      get(values);
      array.values = std::move(values);
    }
  }

 private:
  // A number of elements of at least `least` bytes each.
  std::size_t count(std::size_t least) {
    std::int64_t number = 0;
    get(number);
    if (number < 0 || static_cast<std::uint64_t>(number) > rest_.size() / least) {
      throw std::runtime_error("VTK's reader ended early");
    }
    return static_cast<std::size_t>(number);
  }
  void copy(void* out, std::size_t number, std::size_t size) {
    if (number * size > rest_.size()) throw std::runtime_error("VTK's reader ended early");
    if (number > 0) std::memcpy(out, rest_.data(), number * size);
    rest_.remove_prefix(number * size);
  }

  std::string_view rest_;
};

// Both directions go through the fields in this order.
template <class Polydata, class Visitor>
void visit_fields(Polydata& data, Visitor&& visit) {
  visit(data.points);
  visit(data.offsets);
  visit(data.ids);
  visit(data.strips);
  visit(data.lines_and_points);
  visit(data.point_arrays);
  visit(data.cell_arrays);
  visit(data.space);
}

std::vector<MeshArray> scalars_of(vtkDataSetAttributes* data) {
  std::vector<MeshArray> arrays;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = data->GetArray(i);
    if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() != 1) {
      continue;
    }
    std::vector<double> values(static_cast<std::size_t>(array->GetNumberOfTuples()));
    for (std::size_t t = 0; t < values.size(); ++t) {
      values[t] = array->GetComponent(static_cast<vtkIdType>(t), 0);
    }
    arrays.push_back({array->GetName(), std::move(values)});
  }
  return arrays;
}

std::vector<std::int64_t> integers_of(vtkDataArray* array) {
  std::vector<std::int64_t> values(static_cast<std::size_t>(array->GetNumberOfValues()));
  for (std::size_t n = 0; n < values.size(); ++n) {
    values[n] = static_cast<std::int64_t>(array->GetComponent(static_cast<vtkIdType>(n), 0));
  }
  return values;
}

// In the child.
std::string read_and_pack(std::string_view bytes) {
  const VtkMessages messages;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(std::string(bytes));
  reader->Update();
  if (const std::string error = messages.first_error();
      !error.empty() || reader->GetErrorCode() != 0) {
    throw std::runtime_error("is not a whole VTK PolyData file: " +
                             (error.empty() ? "unknown error" : error));
  }
  vtkPolyData* data = reader->GetOutput();
  VtpPolyData result;
  result.points.resize(3 * static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    data->GetPoint(i, result.points.data() + 3 * i);
  }
  vtkCellArray* polygons = data->GetPolys();
  result.offsets = integers_of(polygons->GetOffsetsArray());
  result.ids = integers_of(polygons->GetConnectivityArray());
  result.strips = data->GetNumberOfStrips();
  result.lines_and_points = data->GetNumberOfLines() + data->GetNumberOfVerts();
  result.point_arrays = scalars_of(data->GetPointData());
  result.cell_arrays = scalars_of(data->GetCellData());
  if (auto* space = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray("SPACE"));
      space != nullptr && space->GetNumberOfValues() > 0) {
    result.space = space->GetValue(0);
  }
  Packer packer;
  visit_fields(result, [&](const auto& field) { packer.put(field); });
  return packer.take();
}

}  // namespace

VtpPolyData read_vtp(std::string_view bytes, const std::string& name) {
  constexpr std::uint64_t kBytesPerSecond = 1000000;
  const ChildResult child =
      run_in_child([bytes] { return read_and_pack(bytes); }, 60 + bytes.size() / kBytesPerSecond);
  if (!child.ok) {
    const bool is_sentence = child.error.rfind("is not a whole", 0) == 0;
    throw FileError(name,
                    is_sentence ? child.error : "cannot be read: VTK's reader " + child.error);
  }
  VtpPolyData data;
  Unpacker unpacker(child.output);
  try {
    visit_fields(data, [&](auto& field) { unpacker.get(field); });
  } catch (const std::runtime_error& error) {
    throw FileError(name, std::string("cannot be read: ") + error.what());
  }
  return data;
}

}  // namespace shape3d::apps::formats
