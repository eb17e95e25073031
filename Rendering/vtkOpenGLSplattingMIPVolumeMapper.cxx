// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOpenGLSplattingMIPVolumeMapper.h"

#include "vtkObjectFactory.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkRenderer.h"
#include "vtkTextureObject.h"
#include "vtk_glew.h"

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

  int width, height, left, bottom;
  ren->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  this->Texture->Activate();
  this->Texture->CopyToFrameBuffer(0, 0, size[0] - 1, size[1] - 1, origin[0], origin[1],
    origin[0] + size[0] - 1, origin[1] + size[1] - 1, width, height, nullptr, nullptr);
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
