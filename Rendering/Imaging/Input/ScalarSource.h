// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ScalarSource_h
#define ScalarSource_h

#include "Input/VolumeGrid.h"
#include "Volume/VoxelCopies.h"

#include "vtkSmartPointer.h"
#include "vtkSplattingMIPNamespace.h"
#include "vtkType.h"
#include "vtkWeakPointer.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkDataArray;
class vtkDataSet;
class vtkImageData;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * The scalars of a data set that are projected, as chosen by the properties of mapper and volume.
 */
struct ScalarChoice
{
  /// The values of vtkSmartVolumeMapper's VectorMode.
  enum VectorModes
  {
    Disabled = -1,
    Magnitude = 0,
    Component = 1
  };

  int scalarMode = 0;
  int arrayAccessMode = 0;
  int arrayId = -1;
  const char* arrayName = nullptr;
  int vectorMode = Disabled;
  int vectorComponent = 0;
  bool independentComponents = true;
  vtkImageData* mask = nullptr;
};

/**
 * The volumes of a data set, one for each component. They are the data set's own arrays if these
 * are contiguous, else copies, which are made on demand and updated when the data or the choice
 * change.
 */
class ScalarSource
{
public:
  ScalarSource();
  ~ScalarSource();

  /**
   * Validates the input. Returns an error message that says what to do, or an empty string. Fast if
   * nothing has changed. The other methods use the last valid input.
   */
  std::string Examine(vtkDataSet* input, const ScalarChoice& choice);

  /// The error message if copies, or indices of them, do not fit into memory.
  static const char* const NoMemory;

  const VolumeGrid& Grid() const { return this->Layout.grid; }
  /// The array that is projected, or that has the projected components.
  vtkDataArray* Scalars() const { return this->Examined.scalars; }
  /// Whether small cells of a rectilinear grid may be missing, because it was resampled to larger
  /// steps.
  bool UsesLargerSteps() const { return this->Layout.coarse; }
  /// The number of projected components, 1 to 4.
  int Components() const { return this->NumberOfComponents; }
  /// Whether the components are the colour and opacity of one sample.
  bool AreDependent() const { return this->Dependent; }

  /// Makes the copies that are needed.
  void Update();
  /// Changes with each Update() that changes the volumes.
  vtkIdType Version() const { return this->NumberOfUpdates; }
  /// Valid after Update(), while HasVolumes().
  const VoxelArray& Volume(int component) const { return this->Volumes[component]; }
  /// Whether the volumes are those of the last Update(). False if scalars of the input have been
  /// deleted, reallocated or modified since; copies stay valid.
  bool HasVolumes() const;
  /// For a rank without voxels.
  /// @param vtkType  of the other ranks' scalars
  void Clear(int vtkType);
  /// VTK's type of a volume, or of its projection.
  int VtkTypeOf(ScalarType type) const;
  /// VTK_FLOAT or VTK_DOUBLE: the type of averages of scalars of a VTK type.
  static int AverageVtkType(int vtkType);
  /// VTK's type of the scalars.
  int GetVtkType() const { return this->VtkType; }

  /**
   * The volumes as point scalars of a vtkImageData, for VTK's mappers. Hidden voxels and NaN have
   * the least value. Shares the input's array if it is contiguous and without NaN. nullptr if no
   * voxel has a number.
   */
  vtkImageData* Image();
  /// Whether there is an image of the current input.
  bool HasImage() const { return this->StandIn != nullptr; }

  /// Bytes of all copies.
  std::size_t MemorySize() const;
  /// Seconds of the last Update() that changed the volumes.
  double Time() const { return this->Seconds; }

private:
  /// The data and choices that determine the volumes.
  struct Key
  {
    vtkDataSet* input = nullptr;
    vtkMTimeType time = 0;
    vtkDataArray* scalars = nullptr;
    const void* buffer = nullptr;
    int vectorMode = -1;
    int vectorComponent = 0;
    bool cells = false;
    bool independent = true;
    vtkImageData* mask = nullptr;
    vtkMTimeType maskTime = 0;

    bool operator==(const Key& other) const;
    void DropIdle();
  };
  struct Copy
  {
    std::unique_ptr<unsigned char[]> bytes;
    std::size_t size = 0;

    void* Allocate(std::ptrdiff_t count, ScalarType type);
  };

  std::string FindScalars(vtkDataSet* input, const ScalarChoice& choice, Key& key) const;
  std::string CheckComponents(const Key& key);
  bool IsMagnitude() const;
  std::vector<StridedVoxels> ChosenComponents();
  VoxelArray MakeVolume(
    StridedVoxels voxels, const std::vector<unsigned char>& hidden, Copy& copy) const;
  bool IsInputArray() const;
  vtkSmartPointer<vtkDataArray> InterleavedVolumes() const;
  void MakeImage();

  Key Examined; // the last valid choice
  Key Volumed;  // of the volumes
  Key Imaged;   // of the image
  /// The array of volumes without copies, and its time.
  vtkWeakPointer<vtkDataArray> Lender;
  vtkMTimeType LenderTime = 0;
  GridOfDataSet Layout;
  int NumberOfComponents = 1;
  bool Dependent = false;
  int VtkType = VTK_VOID;
  vtkIdType NumberOfUpdates = 0;
  double Seconds = 0.0;
  std::vector<VoxelArray> Volumes;
  std::vector<Copy> Copies;
  vtkSmartPointer<vtkDataArray> Packed; // the scalars, if they have an unusual layout
  vtkSmartPointer<vtkImageData> StandIn;
  vtkSmartPointer<vtkDataArray> StandInCopy; // its scalars, unless they are the input's
};

/**
 * The core's type for a VTK type; Float32 for types that are not numeric.
 */
ScalarType scalarTypeOfVtk(int vtkType);

/**
 * A component of an array. It has no address if the array has an unusual layout or is not numeric.
 */
StridedVoxels componentOf(vtkDataArray* array, int component);
}

#endif
