from .functions import disable as disable, enable as enable, mip as mip, use_for as use_for
from .vtkImagingSplattingMIP import (
    vtkSplattingMIPProjection as vtkSplattingMIPProjection,
    vtkSplattingMIPReslice as vtkSplattingMIPReslice,
)
from .vtkRenderingSplattingMIP import (
    vtkSplattingMIPGPUVolumeRayCastMapper as vtkSplattingMIPGPUVolumeRayCastMapper,
    vtkSplattingMIPVolumeMapper as vtkSplattingMIPVolumeMapper,
)

__version__: str
