// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Interaction.h"

#include "MIPScene.h"

#include "vtkCommand.h"
#include "vtkInteractorStyleTrackballCamera.h"
#include "vtkObjectFactory.h"
#include "vtkRenderWindowInteractor.h"

namespace
{
/**
 * Trackball with keys for the modes in place of VTK's usual keys.
 */
class ModeKeys : public vtkInteractorStyleTrackballCamera
{
public:
  static ModeKeys* New();
  vtkTypeMacro(ModeKeys, vtkInteractorStyleTrackballCamera);

  void OnChar() override
  {
    const char key = this->Interactor->GetKeyCode();
    if (key >= '1' && key < '1' + static_cast<int>(ModeNames.size()))
    {
      this->Scene->UseSplatting(key - '1');
      this->Interactor->Render();
    }
    else if (key == 'q')
    {
      this->Interactor->TerminateApp();
    }
  }

  MIPScene* Scene = nullptr;

protected:
  ModeKeys() = default;
  ~ModeKeys() override = default;

private:
  ModeKeys(const ModeKeys&) = delete;
  void operator=(const ModeKeys&) = delete;
};

vtkStandardNewMacro(ModeKeys);

/**
 * Shows the mode and its time after each frame that was projected anew. The window is rendered once
 * more to show the label; that frame re-uses the projection, so there is no third.
 */
class LabelUpdate : public vtkCommand
{
public:
  static LabelUpdate* New() { return new LabelUpdate; }

  void Execute(vtkObject*, unsigned long, void*) override
  {
    vtkSplattingMIPVolumeMapper* mapper = this->Scene->GetSplatting();
    if (mapper->GetNumberOfProjections() != this->NumberOfProjections)
    {
      this->NumberOfProjections = mapper->GetNumberOfProjections();
      this->Scene->SetLabel(
        ModeNames[mapper->GetQualityMode()] + "  " + FormatTime(1000.0 * mapper->GetTimeToDraw()));
      this->Scene->GetWindow()->Render();
    }
  }

  MIPScene* Scene = nullptr;
  vtkIdType NumberOfProjections = 0;
};
}

void Interact(const Volume& volume, const LookSettings& look, const Options& options)
{
  MIPScene scene(volume, options.Projection, look, options.View, false);
  scene.UseSplatting(options.Modes.front());
  scene.GetSplatting()->SetDepthCoding(options.DepthCoding);
  vtkNew<LabelUpdate> label;
  label->Scene = &scene;
  scene.GetWindow()->AddObserver(vtkCommand::EndEvent, label);

  vtkNew<ModeKeys> keys;
  keys->Scene = &scene;
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(scene.GetWindow());
  interactor->SetInteractorStyle(keys);
  scene.GetWindow()->SetWindowName("splatmip: 1 preview, 2 standard, 3 high, 4 exact, q quit");
  scene.GetWindow()->Render();
  interactor->Start();
  scene.GetWindow()->RemoveObserver(label);
}
