// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSplattingMIPGPUVolumeRayCastMapper
 * @brief   vtkGPUVolumeRayCastMapper that splats maximum and minimum intensity projections
 *
 * vtkSplattingMIPGPUVolumeRayCastMapper lets programs use vtkSplattingMIPVolumeMapper without
 * changes to their mappers. After
 *
 *   vtkSplattingMIPGPUVolumeRayCastMapper::GlobalOverrideOn();
 *
 * VTK's object factory creates this class in place of vtkGPUVolumeRayCastMapper, also in
 * vtkSmartVolumeMapper, vtkMultiBlockVolumeMapper and vtkAMRVolumeMapper. Programs that cannot be
 * changed can load it through VTK_AUTOLOAD_PATH. The blend modes MAXIMUM_INTENSITY and
 * MINIMUM_INTENSITY are rendered by an internal vtkSplattingMIPVolumeMapper. The superclass renders
 * - other blend modes;
 * - volumes with several inputs (vtkMultiVolume);
 * - two-dimensional transfer functions;
 * - shader code of vtkShaderProperty and of render passes such as vtkDualDepthPeelingPass;
 * - RenderToImage.
 *
 * Before each render the splatting mapper gets this mapper's input, BlendMode, Cropping,
 * CroppingRegionPlanes, CroppingRegionFlags, ClippingPlanes, ScalarMode, selected array,
 * FinalColorWindow, FinalColorLevel, AutoAdjustSampleDistances and binary MaskInput. The picture
 * has the same bits as that of a vtkSplattingMIPVolumeMapper with these properties. The index is
 * kept while other blend modes are rendered.
 *
 * Splatting ignores SampleDistance, LockSampleDistanceToInputSpacing, UseJittering,
 * ImageSampleDistance with its minimum and maximum, MaxMemoryInBytes, MaxMemoryFraction,
 * UseDepthPass, partitions, a shared depth texture, the range types of transfer functions and
 * label-map masks. With AutoAdjustSampleDistances the quality mode is reduced, not the resolution.
 *
 * Selections contain the whole volume if the picture is not transparent at the selected pixels.
 * Errors and warnings of the splatting mapper are sent to observers of this mapper. Events are
 * VolumeMapperRenderStartEvent, VolumeMapperRenderEndEvent and, if ReportProgress is on,
 * VolumeMapperRenderProgressEvent (call data: pointer to a double from 0 to 1). When rendering
 * switches between the splatting mapper and the superclass, this and the reason are logged with
 * vtkLogger::VERBOSITY_1.
 *
 * The superclass would convert the gray functions of the volume's property to RGB. It therefore
 * renders a copy of the property, in which RGB functions with the same values replace gray
 * functions. With a vtkMultiVolume it gets the properties themselves.
 *
 * @sa vtkSplattingMIPVolumeMapper vtkSmartVolumeMapper vtkObjectFactory
 */
#ifndef vtkSplattingMIPGPUVolumeRayCastMapper_h
#define vtkSplattingMIPGPUVolumeRayCastMapper_h

#include "vtkNew.h" // for the splatting mapper
#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkRenderingSplattingMIPModule.h" // for the export macro
#include "vtkSplattingMIPNamespace.h"

#include <memory> // for the stand-in

namespace splatting
{
class VolumeStandIn;
}
VTK_ABI_NAMESPACE_BEGIN
class vtkOpenGLSplattingMIPVolumeMapper;
class vtkSplattingMIPVolumeMapper;

class VTKRENDERINGSPLATTINGMIP_EXPORT vtkSplattingMIPGPUVolumeRayCastMapper
  : public vtkOpenGLGPUVolumeRayCastMapper
{
public:
  static vtkSplattingMIPGPUVolumeRayCastMapper* New();
  vtkTypeMacro(vtkSplattingMIPGPUVolumeRayCastMapper, vtkOpenGLGPUVolumeRayCastMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Set/Get whether vtkGPUVolumeRayCastMapper::New() creates objects of this class, in the whole
   * program. Default off. On registers an object factory before all others. Existing mappers are
   * not replaced, so call it before a vtkSmartVolumeMapper is created.
   */
  static void SetGlobalOverride(bool on);
  static bool GetGlobalOverride();
  static void GlobalOverrideOn() { SetGlobalOverride(true); }
  static void GlobalOverrideOff() { SetGlobalOverride(false); }
  ///@}

  ///@{
  /**
   * Set/Get the QualityMode of vtkSplattingMIPVolumeMapper that new objects of this class start
   * with. Default EXACT, clamped to [PREVIEW, EXACT].
   */
  static void SetGlobalQualityMode(int mode);
  static int GetGlobalQualityMode();
  ///@}

  /**
   * Get the splatting mapper, for properties that vtkGPUVolumeRayCastMapper does not have, such as
   * QualityMode, Slab and MaximumType. The other properties are overwritten before each render.
   */
  vtkSplattingMIPVolumeMapper* GetSplattingMapper();

  /**
   * Get whether the splatting mapper did the last render. False before the first one.
   */
  vtkGetMacro(LastRenderUsedSplatting, bool);

  /**
   * WARNING: INTERNAL METHOD - NOT INTENDED FOR GENERAL USE
   */
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkSplattingMIPGPUVolumeRayCastMapper();
  ~vtkSplattingMIPGPUVolumeRayCastMapper() override;

  void GPURender(vtkRenderer* ren, vtkVolume* vol) override;

  /**
   * Get the reason why a volume is not splatted, or nullptr if it is splatted. The text completes a
   * sentence that ends in "because".
   */
  const char* ReasonNotToSplat(vtkVolume* vol);

  void CopySettings();
  bool HasGrays(vtkVolume* vol);
  void ForwardMessage(vtkObject* caller, unsigned long event, void* text);
  void ForwardProgress(vtkObject* caller, unsigned long event, void* done);

  bool LastRenderUsedSplatting;

private:
  vtkSplattingMIPGPUVolumeRayCastMapper(const vtkSplattingMIPGPUVolumeRayCastMapper&) = delete;
  void operator=(const vtkSplattingMIPGPUVolumeRayCastMapper&) = delete;

  vtkNew<vtkOpenGLSplattingMIPVolumeMapper> SplattingMapper;
  const char* LoggedReason; // what the log says last; "" before
  std::unique_ptr<splatting::VolumeStandIn> StandIn;
};
VTK_ABI_NAMESPACE_END

#endif
