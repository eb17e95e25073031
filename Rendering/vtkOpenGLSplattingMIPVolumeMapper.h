// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkOpenGLSplattingMIPVolumeMapper
 * @brief   draws the pictures of vtkSplattingMIPVolumeMapper with OpenGL
 *
 * The class that the object factory gives for vtkSplattingMIPVolumeMapper. All it adds is the
 * display: one texture, texel on pixel, blended over what the renderer has drawn before. Where all
 * pixels of large rectangles are opaque they are copied instead, which looks the same and spares an
 * OpenGL without GPU most of the work (not in windows with multisampling, which OpenGL ES does not
 * copy to). It writes depth only where the mapper wants it, by a second texture.
 */
#ifndef vtkOpenGLSplattingMIPVolumeMapper_h
#define vtkOpenGLSplattingMIPVolumeMapper_h

#include "vtkNew.h"                         // for the texture
#include "vtkRenderingSplattingMIPModule.h" // for the export macro
#include "vtkSplattingMIPVolumeMapper.h"

#include <memory> // for the quad

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

#endif
