// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef MapperSettings_h
#define MapperSettings_h

#include "Projection/Project.h"

class vtkSplattingMIPVolumeMapper;
class vtkVolumeProperty;

namespace splatting
{
/**
 * A sentence that says which setting of the mapper has no meaning and what to do, or nullptr. What
 * has no effect may be anything.
 */
const char* faultOfSettings(vtkSplattingMIPVolumeMapper* mapper, vtkVolumeProperty* property);

/**
 * What the mapper's properties mean to a projection of a view in a quality mode. What has no effect
 * is as by default, so that its changes project nothing.
 */
splatting::ProjectionSettings projectionSettings(
  vtkSplattingMIPVolumeMapper* mapper, int mode, const splatting::View& view);
}

#endif
