// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef RankAgreement_h
#define RankAgreement_h

#include "Components/PieceExchange.h"
#include "Input/VolumeGrid.h"
#include "Splat/Projection/Piece.h"

#include "vtkSmartPointer.h"
#include "vtkSplattingMIPNamespace.h"

#include <cstdint>
#include <string>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkImageData;
class vtkMultiProcessController;
class vtkRenderer;
class vtkSplattingMIPVolumeMapper;
class vtkVolume;
VTK_ABI_NAMESPACE_END

namespace splatting
{
class ComponentProjector;
class ScalarSource;

/// The report of one rank on its piece, as plain bytes, and the common report of all ranks.
struct RankReport
{
  static constexpr int MostComponents = 4;

  char problem[240] = {};                           ///< an error message, or empty
  std::int32_t extent[6] = { 0, -1, 0, -1, 0, -1 }; ///< of points; empty if the rank has no piece
  std::int32_t cells = 0, vtkType = 0, type = 0, components = 0;
  std::int32_t layers = 0; ///< ghost layers that the quality mode needs
  std::int32_t absent = 0; ///< whether the rank has rendered a frame without the volume
  double origin[3] = {}, spacing[3] = {}, direction[9] = {};
  struct
  {
    double low, high, nonFinite, magnitude;
  } ranges[MostComponents] = {};
  std::uint64_t view = 0; ///< a hash of view and settings

  bool isEmpty() const;
  void setProblem(const std::string& sentence);
  /// Sets extent, origin, spacing and direction.
  void setGrid(vtkImageData* image);
};

/**
 * The ranks of a controller, each of which has a piece of one image.
 *
 * Collective methods must be called by each rank, in the same order. They have the same result on
 * all ranks, so either all ranks continue or none.
 */
class RankAgreement : public PieceExchange
{
public:
  /// Returns whether there are several ranks. Discards the whole grid if the controller has
  /// changed.
  bool Use(vtkMultiProcessController* controller);
  bool AreMany() const { return this->Controller != nullptr; }
  /// Whether this is the first of the controller's ranks.
  bool IsRoot() const;

  /**
   * Collective. Finds the grid of the whole from all pieces.
   * @return an error message, the same on all ranks, or an empty string
   */
  std::string Agree(const RankReport& own);
  /**
   * Collective. Replaces Agree() on a rank that has rendered a frame without the volume.
   * @return an error message, the same on all ranks, or an empty string if no rank has rendered it
   */
  std::string ReportMissingFrame() const;
  /// Collective. As Agree(), for the grid alone.
  std::string AgreeOnGrid(const RankReport& own);

  /// The grid of the whole, without scalars; nullptr before it is found.
  vtkImageData* Whole() const { return this->Image; }
  const VolumeGrid& Grid() const { return this->Layout.grid; }
  /// Types, components and ranges of the whole.
  const RankReport& Common() const { return this->All; }
  /// The first voxel of this rank's piece.
  const glm::ivec3& First() const override { return this->FirstVoxel; }
  VolumeIndex::Range RangeOfWhole(std::size_t component) const override;

  /// Collective. Whether the argument is true on any rank.
  bool Any(bool here) const override;
  /// Collective. The smallest argument of all ranks.
  int Least(int here) const;
  /**
   * Collective. Turns the image of a piece into that of the whole, except for its spans and mask.
   *
   * Each rank sends and receives the pixels once (vtkCommunicator::AllReduce). With winners it
   * sends and receives four more bytes for each pixel: the step nearest to the viewer among the
   * ranks that have the pixel of the whole.
   */
  void Reduce(ShearImage& image, const ShearWarp& geometry, Reduction reduction) override;
  void Reduce(CellScreen& screen) override;

private:
  std::vector<RankReport> Gather(const RankReport& own) const;
  void SetWhole(const std::vector<RankReport>& reports);
  bool IsCovered(const std::vector<RankReport>& reports) const;
  Box BoxOf(const RankReport& report) const;

  vtkMultiProcessController* Controller = nullptr; // nullptr unless there are several ranks
  RankReport All;
  GridOfDataSet Layout;
  glm::ivec3 FirstVoxel{ 0 };
  vtkSmartPointer<vtkImageData> Image;
  void ReduceWinners(ShearImage& image, const ShearWarp& geometry);

  std::vector<unsigned char> Received;
  std::vector<std::int32_t> ReceivedSteps;
  std::vector<float> ReceivedDepths;
  ShearImage Pixels; // of a CellScreen, for encode() and decode()
};

/**
 * The report of a rank on its mapper's input. It has the grid and the errors of the input, also
 * errors that occur only with several ranks. describeScalars() adds the scalars.
 */
RankReport reportOf(vtkSplattingMIPVolumeMapper* mapper, const std::string& problem);

/// Adds the scalars of a piece to a report.
void describeScalars(
  ComponentProjector& components, const ScalarSource& source, RankReport& report);

/// A hash of the view and the settings, which must be the same on all ranks.
std::uint64_t viewHash(
  vtkSplattingMIPVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume);

/// The input of a mapper, which is a piece of the whole vtkImageData. nullptr if the mapper has no
/// such input, or if the input has no points.
vtkImageData* pieceOf(vtkSplattingMIPVolumeMapper* mapper);
}

#endif
