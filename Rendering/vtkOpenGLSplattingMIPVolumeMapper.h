// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkOpenGLSplattingMIPVolumeMapper
 * @brief   OpenGL display for vtkSplattingMIPVolumeMapper
 *
 * vtkOpenGLSplattingMIPVolumeMapper is the class that the object factory creates for
 * vtkSplattingMIPVolumeMapper. It adds only the display. The picture is drawn as one texture, one
 * texel per pixel, and blended as PictureBlending says. With OVER, large opaque rectangles are
 * copied instead of blended, which gives the same picture and is faster without a GPU. In windows
 * with multisampling nothing is copied, because OpenGL ES cannot copy into such windows. Depths are
 * written through a second texture if WriteDepth is on.
 *
 * @sa vtkSplattingMIPVolumeMapper
 */
#ifndef vtkOpenGLSplattingMIPVolumeMapper_h
#define vtkOpenGLSplattingMIPVolumeMapper_h

#include "vtkNew.h"                         // for the texture
#include "vtkRenderingSplattingMIPModule.h" // for the export macro
#include "vtkSplattingMIPVolumeMapper.h"

#include <memory> // for the quad

VTK_ABI_NAMESPACE_BEGIN
class vtkOpenGLFramebufferObject;
class vtkOpenGLQuadHelper;
class vtkTextureObject;

class VTKRENDERINGSPLATTINGMIP_EXPORT vtkOpenGLSplattingMIPVolumeMapper
  : public vtkSplattingMIPVolumeMapper
{
public:
  static vtkOpenGLSplattingMIPVolumeMapper* New();
  vtkTypeMacro(vtkOpenGLSplattingMIPVolumeMapper, vtkSplattingMIPVolumeMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * WARNING: INTERNAL METHOD - NOT INTENDED FOR GENERAL USE
   */
  void ReleaseGraphicsResources(vtkWindow* window) override;

protected:
  vtkOpenGLSplattingMIPVolumeMapper();
  ~vtkOpenGLSplattingMIPVolumeMapper() override;

  void DisplayImage(
    vtkRenderer* ren, const int origin[2], const int size[2], const unsigned char* rgba) override;
  void DisplayDepths(
    vtkRenderer* ren, const int origin[2], const int size[2], const float* depths) override;

private:
  vtkOpenGLSplattingMIPVolumeMapper(const vtkOpenGLSplattingMIPVolumeMapper&) = delete;
  void operator=(const vtkOpenGLSplattingMIPVolumeMapper&) = delete;

  vtkNew<vtkTextureObject> Texture, DepthTexture;
  vtkNew<vtkOpenGLFramebufferObject> TextureBuffer; // to copy from the texture
  std::unique_ptr<vtkOpenGLQuadHelper> DepthQuad;
};
VTK_ABI_NAMESPACE_END

#endif
