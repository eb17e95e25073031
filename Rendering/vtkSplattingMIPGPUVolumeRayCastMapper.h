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
 * - several inputs without a vtkMultiVolume;
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
 * The inputs of a vtkMultiVolume are splatted one by one, in the order of their ports, as if each
 * of its volumes were in the renderer by itself: with its own matrix, property and splatting mapper
 * (see GetSplattingMapper()). Each picture is blended over the previous ones, so that a volume with
 * opaque dark colours hides those of lower ports: make low scalars transparent, or choose another
 * PictureBlending. ClippingPlanes cut all inputs, MaskInput belongs to port 0, and Cropping is
 * ignored, as by the superclass. (The superclass itself composites several inputs only.)
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

#include "vtkOpenGLGPUVolumeRayCastMapper.h"
#include "vtkRenderingSplattingMIPModule.h" // for the export macro
#include "vtkSmartPointer.h"                // for the splatting mappers
#include "vtkSplattingMIPNamespace.h"

#include <map>     // for the splatting mappers
#include <memory>  // for the stand-in
#include <utility> // for std::pair
#include <vector>  // for parts

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
   * Get the splatting mapper of an input port, for properties that vtkGPUVolumeRayCastMapper does
   * not have, such as QualityMode, Slab and MaximumType. Each port has its own; those above 0 are
   * used with a vtkMultiVolume only. The other properties are overwritten before each render.
   */
  vtkSplattingMIPVolumeMapper* GetSplattingMapper(int port = 0);

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

  /// Input ports and their volumes: of a vtkMultiVolume, else port 0.
  using Parts = std::vector<std::pair<int, vtkVolume*>>;

  /**
   * Get the reason why a volume is not splatted, or nullptr if it is splatted. The text completes a
   * sentence that ends in "because".
   */
  const char* ReasonNotToSplat(vtkVolume* vol, const Parts& parts);

  void CopySettings(bool severalInputs);
  bool HasGrays(vtkVolume* vol);
  Parts PartsOf(vtkVolume* vol);
  void ForwardMessage(vtkObject* caller, unsigned long event, void* text);
  void ForwardProgress(vtkObject* caller, unsigned long event, void* done);

  bool LastRenderUsedSplatting;

private:
  vtkSplattingMIPGPUVolumeRayCastMapper(const vtkSplattingMIPGPUVolumeRayCastMapper&) = delete;
  void operator=(const vtkSplattingMIPGPUVolumeRayCastMapper&) = delete;

  std::map<int, vtkSmartPointer<vtkOpenGLSplattingMIPVolumeMapper>> SplattingMappers; // by port
  const char* LoggedReason; // what the log says last; "" before
  std::unique_ptr<splatting::VolumeStandIn> StandIn;
};
VTK_ABI_NAMESPACE_END

#endif
