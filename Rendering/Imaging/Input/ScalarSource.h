// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ScalarSource_h
#define ScalarSource_h

#include "Input/VolumeGrid.h"
#include "Volume/VoxelCopies.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"
#include "vtkWeakPointer.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSet;
class vtkImageData;

namespace splatting
{
/**
 * Which numbers of a data set are projected, as the properties of mapper and volume say it.
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
 * From a data set to the volumes that are splatted, one for each component. They are the data set's
 * own arrays where these hold voxel after voxel, and copies otherwise, made when they are needed
 * and anew when the data or the choice change.
 */
class ScalarSource
{
public:
  ScalarSource();
  ~ScalarSource();

  /**
   * The gate: a sentence that says why the input cannot be projected and what to do, or nothing.
   * Cheap while nothing changes. What follows is about the last input that passed.
   */
  std::string Examine(vtkDataSet* input, const ScalarChoice& choice);

  /// What to say where copies, or what is made of them, do not fit.
  static const char* const NoMemory;

  const VolumeGrid& Grid() const { return this->Layout.grid; }
  /// The array that is projected, or has the components that are.
  vtkDataArray* Scalars() const { return this->Examined.scalars; }
  /// Whether small cells of a rectilinear grid may be missing, because the grid got larger steps.
  bool IsCoarse() const { return this->Layout.coarse; }
  /// How many components are projected: 1 to 4.
  int Components() const { return this->NumberOfComponents; }
  /// Whether the components are one sample's colour and opacity.
  bool AreDependent() const { return this->Dependent; }

  /// Makes the copies that are needed; a no-op while nothing changes.
  void Update();
  /// Another number after each Update() that changed the volumes.
  vtkIdType Version() const { return this->NumberOfUpdates; }
  /// Valid after Update(), as long as HasVolumes().
  const VoxelArray& Volume(int component) const { return this->Volumes[component]; }
  /// Whether the volumes still are what the last Update() has made them: scalars of the input may
  /// have been deleted, reallocated or modified since, copies have not.
  bool HasVolumes() const;
  /// For a rank that holds nothing: no volume here; those of others have this type of VTK.
  void Clear(int vtkType);
  /// VTK's name for the type of a volume, or of what is projected from it.
  int VtkTypeOf(ScalarType type) const;
  /// VTK_FLOAT or VTK_DOUBLE, whichever holds averages of scalars of a VTK type.
  static int AverageVtkType(int vtkType);
  /// VTK's type of the scalars that the volumes are made of.
  int GetVtkType() const { return this->VtkType; }

  /**
   * The same voxels as point scalars of a vtkImageData, for mappers that know nothing else. Hidden
   * voxels and NaN have the least value. Shares the input's array if this holds voxel after voxel
   * and all have a number. nullptr if no voxel has one.
   */
  vtkImageData* Image();
  /// Whether there is such an image, from before; none if the input changed since.
  bool HasImage() const { return this->StandIn != nullptr; }

  /// Bytes of all copies.
  std::size_t MemorySize() const;
  /// Seconds that the last Update() that changed the volumes took.
  double Time() const { return this->Seconds; }

private:
  /// What the volumes depend on.
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

  Key Examined; // what passed the gate
  Key Volumed;  // what the volumes were made of
  Key Imaged;   // what the image was made of
  /// The array of volumes that are not copied, and its time then.
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
  vtkSmartPointer<vtkDataArray> Packed; // the scalars, if they are stored in an unusual way
  vtkSmartPointer<vtkImageData> StandIn;
  vtkSmartPointer<vtkDataArray> StandInCopy; // its scalars, if they are not the input's
};

/**
 * The core's name for a VTK type; Float32 for types that are no numbers.
 */
ScalarType scalarTypeOfVtk(int vtkType);
}

#endif
