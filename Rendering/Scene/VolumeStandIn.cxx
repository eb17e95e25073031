// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Scene/VolumeStandIn.h"

#include "vtkColorTransferFunction.h"
#include "vtkMatrix4x4.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPlane.h"
#include "vtkRenderer.h"
#include "vtkShaderProperty.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>

namespace splatting
{
namespace
{
/// Nodes, midpoints and sharpness have the same meaning in both kinds of functions.
vtkNew<vtkColorTransferFunction> colorsOf(vtkPiecewiseFunction* grays)
{
  vtkNew<vtkColorTransferFunction> colors;
  colors->SetClamping(grays->GetClamping());
  for (int n = 0; n < grays->GetSize(); ++n)
  {
    double node[4]; // position, value, midpoint, sharpness
    grays->GetNodeValue(n, node);
    colors->AddRGBPoint(node[0], node[1], node[1], node[1], node[2], node[3]);
  }
  return colors;
}

void copyProperty(vtkVolumeProperty* from, vtkVolumeProperty* to)
{
  to->DeepCopy(from);
  for (int i = 0; i < VTK_MAX_VRCOMP; ++i)
  {
    if (from->GetColorChannels(i) == 1)
    {
      to->SetColor(i, colorsOf(from->GetGrayTransferFunction(i)).Get());
    }
    // DeepCopy() omits it.
    to->SetTransferFunction2D(i, from->GetTransferFunction2D(i));
  }
  to->SetTransferFunctionMode(from->GetTransferFunctionMode());
  for (int label : from->GetLabelMapLabels())
  {
    to->SetLabelColor(label, from->GetLabelColor(label));
    to->SetLabelScalarOpacity(label, from->GetLabelScalarOpacity(label));
    to->SetLabelGradientOpacity(label, from->GetLabelGradientOpacity(label));
  }
}
}

VolumeStandIn::VolumeStandIn()
{
  this->Prop->SetProperty(this->Copy);
  this->Prop->SetUserMatrix(this->Matrix);
}

VolumeStandIn::~VolumeStandIn() = default;

vtkVolumeProperty* VolumeStandIn::Property(vtkVolume* volume)
{
  vtkVolumeProperty* const source = volume->GetProperty();
  if (this->Source != source || this->SourceTime != source->GetMTime())
  {
    copyProperty(source, this->Copy);
    this->Source = source;
    this->SourceTime = source->GetMTime(); // default functions are created by their getters
  }
  this->Copy->SetSliceFunction(source->GetSliceFunction());
  return this->Copy;
}

vtkVolume* VolumeStandIn::Volume(vtkVolume* volume, vtkRenderer* renderer)
{
  this->Property(volume);
  const double* const from = volume->GetMatrix()->GetData();
  if (!std::equal(from, from + 16, this->Matrix->GetData()))
  {
    this->Matrix->DeepCopy(from);
  }
  if (this->Prop->GetPropertyKeys() != volume->GetPropertyKeys())
  {
    this->Prop->SetPropertyKeys(volume->GetPropertyKeys());
  }
  this->Prop->SetShaderProperty(volume->GetShaderProperty());
  this->Prop->SetAllocatedRenderTime(volume->GetAllocatedRenderTime(), renderer);
  return this->Prop;
}
}
