// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOpenGLSplattingMIPVolumeMapper.h"

#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRenderer.h"
#include "vtkTextureObject.h"
#if __has_include("vtk_glad.h") // since VTK 9.4
#include "vtk_glad.h"
#else
#include "vtk_glew.h"
#endif

vtkStandardNewMacro(vtkOpenGLSplattingMIPVolumeMapper);

//------------------------------------------------------------------------------
vtkOpenGLSplattingMIPVolumeMapper::vtkOpenGLSplattingMIPVolumeMapper() = default;

//------------------------------------------------------------------------------
vtkOpenGLSplattingMIPVolumeMapper::~vtkOpenGLSplattingMIPVolumeMapper() = default;

//------------------------------------------------------------------------------
void vtkOpenGLSplattingMIPVolumeMapper::DisplayImage(
  vtkRenderer* ren, const int origin[2], const int size[2], const unsigned char* rgba)
{
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(ren->GetRenderWindow());
  if (!window)
  {
    this->Superclass::DisplayImage(ren, origin, size, rgba);
    return;
  }
  vtkOpenGLRenderWindow* const before = this->Texture->GetContext();
  if (before && before != window)
  {
    this->Texture->ReleaseGraphicsResources(before);
  }
  this->Texture->SetContext(window);
  // Texels lie exactly on pixels; linear filtering would only add rounding.
  this->Texture->SetMinificationFilter(vtkTextureObject::Nearest);
  this->Texture->SetMagnificationFilter(vtkTextureObject::Nearest);
  this->Texture->Create2DFromRaw(static_cast<unsigned int>(size[0]),
    static_cast<unsigned int>(size[1]), 4, VTK_UNSIGNED_CHAR, const_cast<unsigned char*>(rgba));

  vtkOpenGLState* const state = window->GetState();
  vtkOpenGLState::ScopedglEnableDisable depthTest(state, GL_DEPTH_TEST);
  vtkOpenGLState::ScopedglEnableDisable blend(state, GL_BLEND);
  vtkOpenGLState::ScopedglBlendFuncSeparate blendFunction(state);
  vtkOpenGLState::ScopedglDepthMask depthMask(state);
  state->vtkglDisable(GL_DEPTH_TEST);
  state->vtkglDepthMask(GL_FALSE);
  state->vtkglEnable(GL_BLEND);
  state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);

  // In the current viewport, which is the renderer's, not the whole window.
  int width, height, left, bottom;
  ren->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  const float x0 = 2.0f * origin[0] / width - 1.0f;
  const float y0 = 2.0f * origin[1] / height - 1.0f;
  const float x1 = 2.0f * (origin[0] + size[0]) / width - 1.0f;
  const float y1 = 2.0f * (origin[1] + size[1]) / height - 1.0f;
  float texture[] = { 0, 0, 1, 0, 1, 1, 0, 1 };
  float corners[] = { x0, y0, 0, x1, y0, 0, x1, y1, 0, x0, y1, 0 };
  this->Texture->Activate();
  this->Texture->CopyToFrameBuffer(texture, corners, nullptr, nullptr);
  this->Texture->Deactivate();
}

//------------------------------------------------------------------------------
void vtkOpenGLSplattingMIPVolumeMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Texture->ReleaseGraphicsResources(window);
  this->Superclass::ReleaseGraphicsResources(window);
}

//------------------------------------------------------------------------------
void vtkOpenGLSplattingMIPVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Texture: " << this->Texture->GetWidth() << " x " << this->Texture->GetHeight()
     << "\n";
}
