// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The enumerations of vtkSplattingMIPProjection and vtkSplattingMIPVolumeMapper, declared once.
 *
 * VectorModes, the same values as vtkSmartVolumeMapper's:
 * - DISABLED: all components
 * - MAGNITUDE: the Euclidean length of all components; a single component is projected unchanged
 * - COMPONENT: the component that VectorComponent names
 *
 * QualityModes, what a pixel shows [CS98, sections 2 and 3]. Modes from PREVIEW to HIGH compute the
 * pixels of a shear image. EXACT computes the pixels of the screen, cell by cell.
 * - PREVIEW: the largest voxel that the ray crosses: an exact voxel traversal
 * - STANDARD: the largest average over the pixel's area in one slice; voxels are boxes (3x3
 *   weights)
 * - HIGH: like STANDARD, but voxels are interpolated with Kernel (5x5 weights in three slices)
 * - EXACT: the extremum of the trilinear volume on the ray [Sakas et al. 1995]
 *
 * Kernels, the reconstruction kernels of HIGH: TRILINEAR, COSINE_BELL; see SetKernel().
 *
 * MaximumTypes, maxima along a ray:
 * - GLOBAL: the largest sample
 * - DEPTH_SHADED: the largest sample after dimming by depth (DMIP)
 * - LOCAL: the first local maximum, from the viewer, that reaches a threshold
 * - SIGNED: the largest or the least sample, whichever is farther from SignedOrigin
 *
 * Accelerations, which voxels a projection skips, and in which order it processes the others.
 * Chains are equal voxels along rows [CS98, section 4]. SORTED_LINES and SORTED_VOLUME are used in
 * PREVIEW only. In other modes LINES replaces them.
 * - AUTO: BRICKS where they skip enough tiles, else DENSE
 * - DENSE: all voxels, in memory order
 * - BRICKS: skips tiles of 8x4 pixels that no brick of 8x4x4 voxels can raise
 * - LINES: chains in the order of slices and rows
 * - SORTED_LINES: the chains of each slice in descending order
 * - SORTED_VOLUME: the chains of all slices in descending order
 */
#ifndef vtkSplattingMIPChoices_h
#define vtkSplattingMIPChoices_h

#define vtkSplattingMIPChoicesMacro()                                                              \
  enum VectorModes                                                                                 \
  {                                                                                                \
    DISABLED = -1,                                                                                 \
    MAGNITUDE = 0,                                                                                 \
    COMPONENT = 1                                                                                  \
  };                                                                                               \
  enum QualityModes                                                                                \
  {                                                                                                \
    PREVIEW = 0,                                                                                   \
    STANDARD = 1,                                                                                  \
    HIGH = 2,                                                                                      \
    EXACT = 3                                                                                      \
  };                                                                                               \
  enum Kernels                                                                                     \
  {                                                                                                \
    TRILINEAR = 0,                                                                                 \
    COSINE_BELL = 1                                                                                \
  };                                                                                               \
  enum MaximumTypes                                                                                \
  {                                                                                                \
    GLOBAL = 0,                                                                                    \
    DEPTH_SHADED = 1,                                                                              \
    LOCAL = 2,                                                                                     \
    SIGNED = 3                                                                                     \
  };                                                                                               \
  enum Accelerations                                                                               \
  {                                                                                                \
    AUTO = 0,                                                                                      \
    DENSE = 1,                                                                                     \
    BRICKS = 2,                                                                                    \
    LINES = 3,                                                                                     \
    SORTED_LINES = 4,                                                                              \
    SORTED_VOLUME = 5                                                                              \
  }

#endif
