// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Interaction.h"

#include "MIPScene.h"

#include "vtkCommand.h"
#include "vtkInteractorStyleTrackballCamera.h"
#include "vtkRenderWindowInteractor.h"

namespace
{
struct Session
{
  MIPScene Scene;
  vtkNew<vtkRenderWindowInteractor> Interactor;
  vtkIdType NumberOfProjections = 0;

  /**
   * Switch the mode or quit. VTK's usual keys are disabled, because the style has an observer.
   */
  void OnChar(vtkObject*, unsigned long, void*)
  {
    const char key = this->Interactor->GetKeyCode();
    if (key >= '1' && key < '1' + static_cast<int>(ModeNames.size()))
    {
      this->Scene.UseSplatting(key - '1');
      this->Interactor->Render();
    }
    else if (key == 'q')
    {
      this->Interactor->TerminateApp();
    }
  }

  /**
   * Show the mode and its time after each frame that was projected anew. The window is rendered
   * once more to show the label; that frame re-uses the projection, so there is no third.
   */
  void UpdateLabel(vtkObject*, unsigned long, void*)
  {
    vtkSplattingMIPVolumeMapper* const mapper = this->Scene.GetSplatting();
    if (mapper->GetNumberOfProjections() != this->NumberOfProjections)
    {
      this->NumberOfProjections = mapper->GetNumberOfProjections();
      this->Scene.SetLabel(
        ModeNames[mapper->GetQualityMode()] + "  " + FormatTime(1000.0 * mapper->GetTimeToDraw()));
      this->Scene.GetWindow()->Render();
    }
  }
};
}

void Interact(const Volume& volume, const LookSettings& look, const Options& options)
{
  Session session{ { volume, options.Projection, look, options.View, false }, {}, 0 };
  session.Scene.UseSplatting(options.Modes.front());
  session.Scene.GetSplatting()->SetDepthCoding(options.DepthCoding);
  vtkRenderWindow* const window = session.Scene.GetWindow();
  const auto label = window->AddObserver(vtkCommand::EndEvent, &session, &Session::UpdateLabel);
  vtkNew<vtkInteractorStyleTrackballCamera> style;
  style->AddObserver(vtkCommand::CharEvent, &session, &Session::OnChar);
  session.Interactor->SetRenderWindow(window);
  session.Interactor->SetInteractorStyle(style);
  window->SetWindowName("splatmip: 1 preview, 2 standard, 3 high, 4 exact, q quit");
  window->Render();
  session.Interactor->Start();
  window->RemoveObserver(label);
}
