// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOpenGLSplattingMIPVolumeMapper.h"

#include "vtkObjectFactory.h"
#include "vtkOpenGLQuadHelper.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkRenderer.h"
#include "vtkShaderProgram.h"
#include "vtkTextureObject.h"
#if __has_include("vtk_glad.h") // since VTK 9.4
#include "vtk_glad.h"
#else
#include "vtk_glew.h"
#endif

vtkStandardNewMacro(vtkOpenGLSplattingMIPVolumeMapper);

namespace
{
/// Texels on the viewport's pixels from `corner` on; above 1 there is no depth.
const char* const DepthShader = R"(//VTK::System::Dec
//VTK::Output::Dec
in vec2 texCoord;
uniform sampler2D depths;
uniform ivec2 viewport;
uniform ivec2 corner;
void main()
{
  ivec2 texel = ivec2(texCoord * vec2(viewport)) - corner;
  ivec2 size = textureSize(depths, 0);
  if (texel.x < 0 || texel.y < 0 || texel.x >= size.x || texel.y >= size.y)
  {
    discard;
  }
  float depth = texelFetch(depths, texel, 0).r;
  if (depth > 1.0)
  {
    discard;
  }
  gl_FragDepth = depth;
  gl_FragData[0] = vec4(0.0);
}
)";

/// A texture of this window, texel by texel.
void prepare(vtkTextureObject* texture, vtkOpenGLRenderWindow* window)
{
  vtkOpenGLRenderWindow* const before = texture->GetContext();
  if (before && before != window)
  {
    texture->ReleaseGraphicsResources(before);
  }
  texture->SetContext(window);
  // Texels lie exactly on pixels; linear filtering would only add rounding.
  texture->SetMinificationFilter(vtkTextureObject::Nearest);
  texture->SetMagnificationFilter(vtkTextureObject::Nearest);
}
}

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
  prepare(this->Texture, window);
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
void vtkOpenGLSplattingMIPVolumeMapper::DisplayDepths(
  vtkRenderer* ren, const int origin[2], const int size[2], const float* depths)
{
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(ren->GetRenderWindow());
  if (!window)
  {
    return;
  }
  if (this->DepthTexture->GetContext() != window)
  {
    this->DepthQuad = nullptr;
  }
  prepare(this->DepthTexture, window);
  this->DepthTexture->Create2DFromRaw(static_cast<unsigned int>(size[0]),
    static_cast<unsigned int>(size[1]), 1, VTK_FLOAT, const_cast<float*>(depths));
  if (!this->DepthQuad)
  {
    this->DepthQuad = std::make_unique<vtkOpenGLQuadHelper>(window, nullptr, DepthShader, nullptr);
  }
  else
  {
    window->GetShaderCache()->ReadyShaderProgram(this->DepthQuad->Program);
  }
  vtkShaderProgram* const program = this->DepthQuad->Program;
  if (!program)
  {
    vtkErrorMacro(<< "This OpenGL cannot write depths: turn WriteDepth off.");
    return;
  }
  vtkOpenGLState* const state = window->GetState();
  vtkOpenGLState::ScopedglEnableDisable depthTest(state, GL_DEPTH_TEST);
  vtkOpenGLState::ScopedglEnableDisable blend(state, GL_BLEND);
  vtkOpenGLState::ScopedglDepthMask depthMask(state);
  vtkOpenGLState::ScopedglColorMask colorMask(state);
  state->vtkglEnable(GL_DEPTH_TEST);
  state->vtkglDisable(GL_BLEND);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  int viewport[2], left, bottom;
  ren->GetTiledSizeAndOrigin(viewport, viewport + 1, &left, &bottom);
  this->DepthTexture->Activate();
  program->SetUniformi("depths", this->DepthTexture->GetTextureUnit());
  program->SetUniform2i("viewport", viewport);
  program->SetUniform2i("corner", origin);
  this->DepthQuad->Render();
  this->DepthTexture->Deactivate();
}

//------------------------------------------------------------------------------
void vtkOpenGLSplattingMIPVolumeMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  this->DepthQuad = nullptr;
  this->DepthTexture->ReleaseGraphicsResources(window);
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
