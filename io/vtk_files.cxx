/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/vtk_files.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <string>

#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLRectilinearGridWriter.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

extern "C" {
#include "io/atomic_file.h"
}

namespace
{

/* VTK reports errors by events; with an observer they arrive here and not on the terminal. */
class error_listener
{
public:
  explicit error_listener(vtkObject *object)
  {
    command->SetCallback(&error_listener::receive);
    command->SetClientData(&text);
    object->AddObserver(vtkCommand::ErrorEvent, command);
  }
  std::string text;

private:
  static void receive(vtkObject *, unsigned long, void *text, void *message)
  {
    std::string &first = *static_cast<std::string *>(text);
    if (first.empty() && message) {
      first = static_cast<const char *>(message);
      std::replace(first.begin(), first.end(), '\n', ' ');
    }
  }
  vtkNew<vtkCallbackCommand> command;
};

pw_status fail(pw_status status, const char *path, const char *what)
{
  return pw_error_set(status, __FILE__, __LINE__, __func__, "%s: %s", path, what);
}

/* Run @p body; exceptions become status codes. */
template <typename Body> pw_status guarded(const char *path, Body body)
{
  try {
    return body();
  } catch (const std::bad_alloc &) {
    return fail(PW_ERR_MEMORY, path, "out of memory in VTK");
  } catch (const std::exception &error) {
    return fail(PW_ERR_FILE, path, error.what());
  } catch (...) {
    return fail(PW_ERR_FILE, path, "an unknown exception in VTK");
  }
}

template <typename Array, typename Value>
vtkSmartPointer<vtkDataArray> copy_array(const pw_vtk_array &in, const Value *value, vtkIdType n)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(in.name);
  array->SetNumberOfComponents(in.ncomp);
  array->SetNumberOfTuples(n);
  if (n > 0) {
    std::memcpy(array->GetVoidPointer(0), value, sizeof(Value) * size_t(n) * size_t(in.ncomp));
  }
  return array;
}

void add_arrays(vtkFieldData *data, const pw_vtk_array *array, int narray, vtkIdType n)
{
  for (int i = 0; i < narray; i++) {
    const pw_vtk_array &in = array[i];
    data->AddArray(in.real ? copy_array<vtkFloatArray>(in, in.real, n)
                           : copy_array<vtkTypeInt32Array>(in, in.index, n));
  }
}

/* ParaView shows the time of a file from this array. */
void add_time(vtkDataObject *object, pw_real time_s)
{
  vtkNew<vtkDoubleArray> time;
  time->SetName("TimeValue");
  time->InsertNextValue(time_s);
  object->GetFieldData()->AddArray(time);
}

template <typename Writer> pw_status write_object(const char *path, vtkDataObject *object)
{
  vtkNew<Writer> writer;
  error_listener errors(writer);
  writer->SetInputData(object);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
  writer->SetCompressionLevel(1);
  writer->WriteToOutputStringOn();
  if (!writer->Write() || writer->GetErrorCode() != 0 || !errors.text.empty()) {
    return fail(PW_ERR_FILE, path, errors.text.empty() ? "VTK cannot write" : errors.text.c_str());
  }
  const std::string bytes = writer->GetOutputString();
  return pw_atomic_write(path, bytes.data(), bytes.size());
}

vtkSmartPointer<vtkPolyData> build_cells(const pw_vtk_cells &in)
{
  const pw_idx npoint = in.start[in.ncell];
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(npoint);
  for (pw_idx i = 0; i < npoint; i++) {
    if (in.xyz) {
      points->SetPoint(i, in.xyz + 3 * i);
    } else {
      points->SetPoint(i, in.xy[2 * i], in.xy[2 * i + 1], 0.0);
    }
  }
  vtkNew<vtkCellArray> cells;
  cells->Use32BitStorage();
  for (pw_idx i = 0; i < in.ncell; i++) {
    cells->InsertNextCell(int(in.start[i + 1] - in.start[i]));
    for (pw_idx k = in.start[i]; k < in.start[i + 1]; k++) {
      cells->InsertCellPoint(k);
    }
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  switch (in.kind) {
  case PW_VTK_VERTICES:
    data->SetVerts(cells);
    break;
  case PW_VTK_LINES:
    data->SetLines(cells);
    break;
  case PW_VTK_POLYGONS:
    data->SetPolys(cells);
    break;
  }
  add_arrays(data->GetCellData(), in.array, in.narray, in.ncell);
  add_time(data, in.time_s);
  return data;
}

vtkSmartPointer<vtkUnstructuredGrid> build_tets(const pw_vtk_tets &in)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(in.nnode);
  for (pw_idx i = 0; i < in.nnode; i++) {
    points->SetPoint(i, in.xyz + 3 * i);
  }
  vtkNew<vtkCellArray> cells;
  cells->Use32BitStorage();
  for (pw_idx e = 0; e < in.nelem; e++) {
    cells->InsertNextCell(4);
    for (pw_idx k = 0; k < 4; k++) {
      cells->InsertCellPoint(in.node[4 * e + k]);
    }
  }
  auto data = vtkSmartPointer<vtkUnstructuredGrid>::New();
  data->SetPoints(points);
  data->SetCells(VTK_TETRA, cells);
  add_arrays(data->GetPointData(), in.node_array, in.nnode_array, in.nnode);
  add_arrays(data->GetCellData(), in.elem_array, in.nelem_array, in.nelem);
  add_time(data, in.time_s);
  return data;
}

vtkSmartPointer<vtkImageData> build_grid(const pw_vtk_grid &in)
{
  auto data = vtkSmartPointer<vtkImageData>::New();
  data->SetDimensions(in.nodes[0], in.nodes[1], 1);
  data->SetOrigin(in.origin[0], in.origin[1], 0.0);
  data->SetSpacing(in.cell, in.cell, in.cell);
  add_arrays(data->GetPointData(), in.array, in.narray, vtkIdType(in.nodes[0]) * in.nodes[1]);
  add_time(data, in.time_s);
  return data;
}

vtkSmartPointer<vtkDoubleArray> coordinates(const pw_real *value, vtkIdType n)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetNumberOfTuples(n);
  std::copy(value, value + n, array->GetPointer(0));
  return array;
}

vtkSmartPointer<vtkRectilinearGrid> build_graded(const pw_vtk_grid &in)
{
  const pw_real plane = 0.0;
  auto data = vtkSmartPointer<vtkRectilinearGrid>::New();
  data->SetDimensions(in.nodes[0], in.nodes[1], 1);
  data->SetXCoordinates(coordinates(in.node[0], in.nodes[0]));
  data->SetYCoordinates(coordinates(in.node[1], in.nodes[1]));
  data->SetZCoordinates(coordinates(&plane, 1));
  add_arrays(data->GetPointData(), in.array, in.narray, vtkIdType(in.nodes[0]) * in.nodes[1]);
  add_time(data, in.time_s);
  return data;
}

template <typename Reader> vtkSmartPointer<vtkDataSet> read_object(const char *path)
{
  vtkNew<Reader> reader;
  error_listener errors(reader);
  if (!reader->CanReadFile(path)) {
    return nullptr;
  }
  reader->SetFileName(path);
  reader->Update();
  const bool good = reader->GetErrorCode() == 0 && errors.text.empty();
  return good ? vtkSmartPointer<vtkDataSet>(reader->GetOutput()) : nullptr;
}

pw_real time_of(vtkDataSet *data)
{
  vtkDataArray *time = data->GetFieldData()->GetArray("TimeValue");
  return time && time->GetNumberOfValues() == 1 ? time->GetTuple1(0) : 0.0;
}

pw_status read_array(const char *path, const char *name, float *value, pw_off max,
                     pw_vtk_shape *shape)
{
  vtkSmartPointer<vtkDataSet> data = read_object<vtkXMLPolyDataReader>(path);
  const bool cells = data != nullptr;
  if (!cells) {
    data = read_object<vtkXMLUnstructuredGridReader>(path);
  }
  if (!data) {
    data = read_object<vtkXMLImageDataReader>(path);
  }
  if (!data) {
    data = read_object<vtkXMLRectilinearGridReader>(path);
  }
  if (!data) {
    return fail(PW_ERR_FILE, path, "VTK cannot read it");
  }
  vtkFieldData *fields = cells ? static_cast<vtkFieldData *>(data->GetCellData())
                               : static_cast<vtkFieldData *>(data->GetPointData());
  vtkDataArray *array = name ? fields->GetArray(name) : nullptr;
  vtkPointSet *set = vtkPointSet::SafeDownCast(data);
  if (!name && set) {
    array = set->GetPoints()->GetData();
  }
  if (!array) {
    return fail(PW_ERR_FILE, path, "no such array");
  }
  shape->points = data->GetNumberOfPoints();
  shape->cells = data->GetNumberOfCells();
  shape->narray = fields->GetNumberOfArrays();
  shape->ncomp = array->GetNumberOfComponents();
  shape->count = array->GetNumberOfValues();
  shape->time_s = time_of(data);
  for (pw_off i = 0; i < std::min(max, shape->count); i++) {
    value[i] = float(array->GetComponent(i / shape->ncomp, int(i % shape->ncomp)));
  }
  return PW_OK;
}

} // namespace

extern "C" bool pw_vtk_available(void)
{
  return true;
}

extern "C" pw_status pw_vtk_write_cells(const char *path, const pw_vtk_cells *cells)
{
  return guarded(path,
                 [=] { return write_object<vtkXMLPolyDataWriter>(path, build_cells(*cells)); });
}

extern "C" pw_status pw_vtk_write_tets(const char *path, const pw_vtk_tets *tets)
{
  return guarded(
      path, [=] { return write_object<vtkXMLUnstructuredGridWriter>(path, build_tets(*tets)); });
}

extern "C" pw_status pw_vtk_write_grid(const char *path, const pw_vtk_grid *grid)
{
  return guarded(path, [=] {
    return grid->node[0] && grid->node[1]
               ? write_object<vtkXMLRectilinearGridWriter>(path, build_graded(*grid))
               : write_object<vtkXMLImageDataWriter>(path, build_grid(*grid));
  });
}

extern "C" pw_status pw_vtk_read_array(const char *path, const char *name, float *value, pw_off max,
                                       pw_vtk_shape *shape)
{
  return guarded(path, [=] { return read_array(path, name, value, max, shape); });
}
