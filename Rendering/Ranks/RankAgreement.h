// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef RankAgreement_h
#define RankAgreement_h

#include "Input/VolumeGrid.h"
#include "PieceExchange.h"
#include "Projection/Piece.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkImageData;
class vtkMultiProcessController;
class vtkRenderer;
class vtkSplattingMIPVolumeMapper;
class vtkVolume;

namespace splatting
{
class ComponentProjector;
class ScalarSource;

/// What one rank says of its piece, as plain bytes, and what all of them make of it.
struct RankReport
{
  static constexpr int MostComponents = 4;

  char problem[240] = {}; ///< a sentence, or nothing
  std::int32_t extent[6] = { 0, -1, 0, -1, 0,
    -1 }; ///< of points; the rank holds nothing if it is empty
  std::int32_t cells = 0, vtkType = 0, type = 0, components = 0;
  std::int32_t layers = 0; ///< of ghosts, that the quality mode needs
  std::int32_t absent = 0; ///< whether the rank has rendered a frame without the volume
  double origin[3] = {}, spacing[3] = {}, direction[9] = {};
  struct
  {
    double low, high, nonFinite, magnitude;
  } ranges[MostComponents] = {};
  std::uint64_t view = 0; ///< a hash of view and settings

  bool isEmpty() const;
  void setProblem(const std::string& sentence);
  /// Where the data set lies.
  void setGrid(vtkImageData* image);
};

/**
 * The ranks of a controller, each of which holds a piece of one image.
 *
 * All methods that say so are collective: each rank must call them, in the same order. They come to
 * the same result everywhere, so that all ranks go on or none does.
 */
class RankAgreement : public PieceExchange
{
public:
  /// Whether there are several ranks. Forgets the whole if the controller is another one.
  bool Use(vtkMultiProcessController* controller);
  bool AreMany() const { return this->Controller != nullptr; }
  /// Of the controller's ranks, the first.
  bool IsRoot() const;

  /**
   * Collective. Finds the whole of all pieces.
   * @return what is wrong, the same on all ranks, or an empty string
   */
  std::string Agree(const RankReport& own);
  /**
   * Collective, in place of Agree(), on a rank that has rendered a frame without the volume.
   * @return what is wrong, the same on all ranks, or an empty string if none has rendered it
   */
  std::string AgreeOnAbsence() const;
  /// Collective. The same of the grid alone.
  std::string AgreeOnGrid(const RankReport& own);

  /// The grid of the whole; without scalars. nullptr before it is known.
  vtkImageData* Whole() const { return this->Image; }
  const VolumeGrid& Grid() const { return this->Layout.grid; }
  /// Types, components and the ranges of the whole.
  const RankReport& Common() const { return this->All; }
  /// Where this rank's voxels begin.
  const glm::ivec3& First() const override { return this->FirstVoxel; }
  VolumeIndex::Range RangeOfWhole(std::size_t component) const override;

  /// Collective. Whether something is so on any rank.
  bool Any(bool here) const override;
  /// Collective.
  int Least(int here) const;
  /**
   * Collective. From the image of a piece to that of the whole, but for its spans and mask.
   *
   * Each rank sends and gets the pixels once (vtkCommunicator::AllReduce), and once more four bytes
   * of each if the image has winners: of the ranks whose pixel is the whole's, the step nearest to
   * the viewer.
   */
  void Reduce(ShearImage& image, const ShearWarp& geometry, Reduction reduction) override;
  void Reduce(ScreenScalars& screen) override;

private:
  std::vector<RankReport> Gather(const RankReport& own) const;
  void SetWhole(const std::vector<RankReport>& reports);
  bool IsCovered(const std::vector<RankReport>& reports) const;
  Box BoxOf(const RankReport& report) const;

  vtkMultiProcessController* Controller = nullptr; // only if there are several ranks
  RankReport All;
  GridOfDataSet Layout;
  glm::ivec3 FirstVoxel{ 0 };
  vtkSmartPointer<vtkImageData> Image;
  void ReduceWinners(ShearImage& image, const ShearWarp& geometry);

  std::vector<unsigned char> Received;
  std::vector<std::int32_t> ReceivedSteps;
  std::vector<float> ReceivedDepths;
  ShearImage Pixels; // of a screen
};

/**
 * What a rank reports of its mapper's input: where it lies, and what is wrong with it, or would be
 * with several ranks. describeScalars() adds the scalars.
 */
RankReport reportOf(vtkSplattingMIPVolumeMapper* mapper, const std::string& problem);

/// Adds the scalars of a piece.
void describeScalars(
  ComponentProjector& components, const ScalarSource& source, RankReport& report);

/// A hash of how a mapper sees a volume, which all ranks must have in common.
std::uint64_t viewNumber(
  vtkSplattingMIPVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume);

/// The vtkImageData that a mapper projects a piece of; nullptr if it has none, or no points.
vtkImageData* pieceOf(vtkSplattingMIPVolumeMapper* mapper);
}

#endif
