// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef SettingsFaults_h
#define SettingsFaults_h

class vtkSplattingMIPVolumeMapper;
class vtkVolumeProperty;

/**
 * A sentence that says which setting of the mapper has no meaning and what to do, or nullptr. What
 * has no effect may be anything.
 */
const char* faultOfSettings(vtkSplattingMIPVolumeMapper* mapper, vtkVolumeProperty* property);

#endif
