// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkOpenGLSplattingMIPVolumeMapper.h"

#include "Common/Parallel.h"

#include "vtkObjectFactory.h"
#include "vtkOpenGLFramebufferObject.h"
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

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

VTK_ABI_NAMESPACE_BEGIN
vtkStandardNewMacro(vtkOpenGLSplattingMIPVolumeMapper);

namespace
{
/// One texel per pixel of the viewport, from `corner` on. Values above 1 are no depths.
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

/// Prepares a texture of this window without interpolation.
void prepare(vtkTextureObject* texture, vtkOpenGLRenderWindow* window)
{
  vtkOpenGLRenderWindow* const before = texture->GetContext();
  if (before && before != window)
  {
    texture->ReleaseGraphicsResources(before);
  }
  texture->SetContext(window);
  // Texels coincide with pixels, and linear filtering would add rounding errors.
  texture->SetMinificationFilter(vtkTextureObject::Nearest);
  texture->SetMagnificationFilter(vtkTextureObject::Nearest);
}

/// Pixels of an image; the ends are exclusive.
struct Rectangle
{
  int x0, y0, x1, y1;

  bool empty() const { return this->x0 >= this->x1 || this->y0 >= this->y1; }
};

/// Bands of rows of an image, each with one rectangle of opaque pixels. More bands would fit a
/// convex outline better, but need more calls.
constexpr int Bands = 12;
/// Pixels that are tested together, and the least number of columns of a copy.
constexpr int Together = 16, LeastColumns = 64;

bool areOpaque(const unsigned char* rgba)
{
  std::uint32_t pixels[Together];
  std::memcpy(pixels, rgba, sizeof(pixels));
  std::uint32_t all = ~std::uint32_t(0);
  for (std::uint32_t pixel : pixels)
  {
    all &= pixel;
  }
  unsigned char bytes[4];
  std::memcpy(bytes, &all, sizeof(bytes));
  return bytes[3] == 255;
}

/// Narrows the columns on both sides of the centre to those that are opaque in row y.
void narrow(const unsigned char* rgba, int width, int y, int& before, int& after)
{
  const unsigned char* const middle = rgba + 4 * (std::ptrdiff_t(y) * width + width / 2);
  int n = 0;
  for (; n + Together <= before && areOpaque(middle - 4 * (n + Together)); n += Together)
  {
  }
  before = n;
  for (n = 0; n + Together <= after && areOpaque(middle + 4 * n); n += Together)
  {
  }
  after = n;
}

/// A rectangle of opaque pixels in some rows, without rows at both ends that have few.
Rectangle opaquePart(const unsigned char* rgba, int width, int y0, int y1)
{
  const auto isNarrow = [=](int y)
  {
    int before = std::min(LeastColumns, width / 2);
    int after = std::min(LeastColumns, width - width / 2);
    narrow(rgba, width, y, before, after);
    return before + after < LeastColumns;
  };
  for (; y0 < y1 && isNarrow(y0); ++y0)
  {
  }
  for (; y0 < y1 && isNarrow(y1 - 1); --y1)
  {
  }
  int before = width / 2, after = width - before;
  for (int y = y0; y < y1; ++y)
  {
    narrow(rgba, width, y, before, after);
  }
  return { width / 2 - before, y0, width / 2 + after, y1 };
}

using Parts = std::array<Rectangle, Bands>;

/// The rectangle of each band, from bottom to top; empty if a copy does not pay.
Parts opaqueParts(const unsigned char* rgba, const int size[2])
{
  Parts parts;
  splatting::parallelFor(0, Bands, 1,
    [&](vtkIdType first, vtkIdType last)
    {
      for (int b = static_cast<int>(first); b < last; ++b)
      {
        parts[b] = opaquePart(rgba, size[0], static_cast<int>(vtkIdType(size[1]) * b / Bands),
          static_cast<int>(vtkIdType(size[1]) * (b + 1) / Bands));
        if (parts[b].x1 - parts[b].x0 < LeastColumns)
        {
          parts[b] = {};
        }
      }
    });
  return parts;
}

/// A viewport of the window, and a picture in it.
struct DrawArea
{
  int corner[2], viewport[2]; // pixels of the window
  int origin[2], size[2];     // of the viewport
};

/// Whether copied pixels have the place and the colours of drawn ones, and no others are written.
bool takesCopies(vtkOpenGLRenderWindow* window, DrawArea& area)
{
  vtkOpenGLState* const state = window->GetState();
  int samples = 0, second = GL_NONE, viewport[4] = {}, scissor[4] = {};
  unsigned char mask[4] = {};
  state->vtkglGetIntegerv(GL_SAMPLE_BUFFERS, &samples);
  state->vtkglGetIntegerv(GL_DRAW_BUFFER1, &second);
  state->vtkglGetBooleanv(GL_COLOR_WRITEMASK, mask);
  state->vtkglGetIntegerv(GL_VIEWPORT, viewport);
  state->vtkglGetIntegerv(GL_SCISSOR_BOX, scissor);
  const bool cuts =
    state->GetEnumState(GL_SCISSOR_TEST) && !std::equal(viewport, viewport + 4, scissor);
  std::copy(viewport, viewport + 2, area.corner);
  return std::equal(viewport + 2, viewport + 4, area.viewport) && samples == 0 &&
    second == GL_NONE && std::all_of(mask, mask + 4, [](unsigned char m) { return m != 0; }) &&
    !cuts && !state->GetEnumState(GL_STENCIL_TEST) && !window->GetUseSRGBColorSpace();
}

void draw(vtkTextureObject* texture, const Rectangle& part, const DrawArea& area)
{
  if (part.empty())
  {
    return;
  }
  const int low[2] = { part.x0, part.y0 }, high[2] = { part.x1, part.y1 };
  float t[2][2], c[2][2]; // low and high, of the texture and of the viewport
  for (int a = 0; a < 2; ++a)
  {
    t[0][a] = float(low[a]) / area.size[a];
    t[1][a] = float(high[a]) / area.size[a];
    c[0][a] = 2.0f * (area.origin[a] + low[a]) / area.viewport[a] - 1.0f;
    c[1][a] = 2.0f * (area.origin[a] + high[a]) / area.viewport[a] - 1.0f;
  }
  float texels[] = { t[0][0], t[0][1], t[1][0], t[0][1], t[1][0], t[1][1], t[0][0], t[1][1] };
  float corners[] = { c[0][0], c[0][1], 0, c[1][0], c[0][1], 0, c[1][0], c[1][1], 0, c[0][0],
    c[1][1], 0 };
  texture->CopyToFrameBuffer(texels, corners, nullptr, nullptr);
}

/// Draws all pixels outside some parts.
void drawBeside(vtkTextureObject* texture, const Parts& parts, const DrawArea& area)
{
  const int width = area.size[0];
  int row = 0;
  for (const Rectangle& part : parts)
  {
    if (!part.empty())
    {
      draw(texture, { 0, row, width, part.y0 }, area);
      draw(texture, { 0, part.y0, part.x0, part.y1 }, area);
      draw(texture, { part.x1, part.y0, width, part.y1 }, area);
      row = part.y1;
    }
  }
  draw(texture, { 0, row, width, area.size[1] }, area);
}

/// Restores the blend equation, for which vtkOpenGLState has no class.
class ScopedBlendEquation
{
public:
  explicit ScopedBlendEquation(vtkOpenGLState* state) : State(state)
  {
    state->vtkglGetIntegerv(GL_BLEND_EQUATION_RGB, &this->Color);
    state->vtkglGetIntegerv(GL_BLEND_EQUATION_ALPHA, &this->Alpha);
  }
  ~ScopedBlendEquation()
  {
    this->State->vtkglBlendEquationSeparate(
      static_cast<GLenum>(this->Color), static_cast<GLenum>(this->Alpha));
  }
  ScopedBlendEquation(const ScopedBlendEquation&) = delete;
  ScopedBlendEquation& operator=(const ScopedBlendEquation&) = delete;

private:
  vtkOpenGLState* const State;
  int Color = GL_FUNC_ADD, Alpha = GL_FUNC_ADD;
};

/// Copies parts through a framebuffer object of their own.
void copy(vtkTextureObject* texture, vtkOpenGLFramebufferObject* buffer, const Parts& parts,
  const DrawArea& area)
{
  vtkOpenGLState* const state = texture->GetContext()->GetState();
  state->PushReadFramebufferBinding();
  buffer->SetContext(texture->GetContext());
  buffer->Bind(GL_READ_FRAMEBUFFER);
  buffer->AddColorAttachment(0, texture);
  buffer->ActivateReadBuffer(0);
  const int x = area.corner[0] + area.origin[0], y = area.corner[1] + area.origin[1];
  for (const Rectangle& part : parts)
  {
    if (!part.empty())
    {
      state->vtkglBlitFramebuffer(part.x0, part.y0, part.x1, part.y1, x + part.x0, y + part.y0,
        x + part.x1, y + part.y1, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
  }
  state->PopReadFramebufferBinding();
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
  if (this->TextureBuffer->GetContext() && this->Texture->GetContext() != window)
  {
    // Otherwise it would read the texture of that window, which is released now.
    this->TextureBuffer->ReleaseGraphicsResources(this->TextureBuffer->GetContext());
  }
  prepare(this->Texture, window);
  this->Texture->Create2DFromRaw(static_cast<unsigned int>(size[0]),
    static_cast<unsigned int>(size[1]), 4, VTK_UNSIGNED_CHAR, const_cast<unsigned char*>(rgba));

  vtkOpenGLState* const state = window->GetState();
  vtkOpenGLState::ScopedglEnableDisable depthTest(state, GL_DEPTH_TEST);
  vtkOpenGLState::ScopedglEnableDisable blend(state, GL_BLEND);
  vtkOpenGLState::ScopedglBlendFuncSeparate blendFunction(state);
  ScopedBlendEquation blendEquation(state);
  vtkOpenGLState::ScopedglDepthMask depthMask(state);
  state->vtkglDisable(GL_DEPTH_TEST);
  state->vtkglDepthMask(GL_FALSE);
  state->vtkglEnable(GL_BLEND);
  // Identifiers of a selector are no colours.
  const int blending = ren->GetSelector() ? OVER : this->GetPictureBlending();
  const GLenum rest = blending == OVER ? GL_ONE_MINUS_SRC_ALPHA : GL_ONE;
  state->vtkglBlendFuncSeparate(GL_ONE, rest, GL_ONE, rest);
  state->vtkglBlendEquation(blending == MAXIMUM ? GL_MAX : GL_FUNC_ADD);

  // In the current viewport, which is that of the renderer.
  DrawArea area;
  ren->GetTiledSizeAndOrigin(
    &area.viewport[0], &area.viewport[1], &area.corner[0], &area.corner[1]);
  std::copy(origin, origin + 2, area.origin);
  std::copy(size, size + 2, area.size);
  const Parts opaque =
    blending == OVER && takesCopies(window, area) ? opaqueParts(rgba, size) : Parts{};
  this->Texture->Activate();
  drawBeside(this->Texture, opaque, area);
  this->Texture->Deactivate();
  if (std::any_of(
        opaque.begin(), opaque.end(), [](const Rectangle& part) { return !part.empty(); }))
  {
    copy(this->Texture, this->TextureBuffer, opaque, area);
  }
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
  this->TextureBuffer->ReleaseGraphicsResources(window);
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
VTK_ABI_NAMESPACE_END
