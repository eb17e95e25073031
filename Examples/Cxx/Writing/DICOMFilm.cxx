// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/QuietReading.h"
#include "Writing/PictureSeries.h"

#include "vtkDICOMMetaData.h"
#include "vtkDICOMSCGenerator.h"
#include "vtkDICOMWriter.h"
#include "vtkImageConstantPad.h"
#include "vtkImageMapToColors.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"

namespace
{
/**
 * Omits elements that the standard does not allow here, or that are unknown.
 */
class FilmGenerator : public vtkDICOMSCGenerator
{
public:
  static FilmGenerator* New();
  vtkTypeMacro(FilmGenerator, vtkDICOMSCGenerator);

  bool IsInMillimeters = false;

protected:
  FilmGenerator() = default;
  ~FilmGenerator() override = default;

  bool GenerateSCMultiFrameImageModule(vtkDICOMMetaData* source) override
  {
    const bool isDone = this->Superclass::GenerateSCMultiFrameImageModule(source);
    vtkDICOMMetaData* const elements = this->MetaData;
    if (elements->Get(DC::SamplesPerPixel).AsInt() == 3)
    {
      elements->Erase(DC::PresentationLUTShape);
      elements->Erase(DC::RescaleIntercept);
      elements->Erase(DC::RescaleSlope);
      elements->Erase(DC::RescaleType);
    }
    if (!this->IsInMillimeters)
    {
      elements->Erase(DC::PixelSpacing);
    }
    return isDone;
  }

private:
  FilmGenerator(const FilmGenerator&) = delete;
  void operator=(const FilmGenerator&) = delete;
};

vtkStandardNewMacro(FilmGenerator);

/**
 * Describe a series of its own in the study of the files that were read.
 */
vtkSmartPointer<vtkDICOMMetaData> DescribeFilm(vtkObject* study)
{
  auto elements = vtkSmartPointer<vtkDICOMMetaData>::New();
  if (auto* const source = vtkDICOMMetaData::SafeDownCast(study))
  {
    for (const auto tag : { DC::SpecificCharacterSet, DC::PatientName, DC::PatientID,
           DC::IssuerOfPatientID, DC::PatientBirthDate, DC::PatientSex, DC::PatientAge,
           DC::StudyInstanceUID, DC::StudyDate, DC::StudyTime, DC::StudyID, DC::StudyDescription,
           DC::AccessionNumber, DC::ReferringPhysicianName, DC::BodyPartExamined, DC::Laterality })
    {
      if (source->Has(tag))
      {
        elements->Set(tag, source->Get(0, tag));
      }
    }
  }
  if (!elements->Has(DC::BodyPartExamined) && !elements->Has(DC::Laterality))
  {
    elements->Set(DC::Laterality, ""); // unknown
  }
  elements->Set(DC::Modality, "OT");
  elements->Set(DC::SeriesNumber, 1000);
  elements->Set(DC::BurnedInAnnotation, "NO"); // no text that identifies the patient
  elements->Set(
    DC::DerivationDescription, "maximum intensity projections, splatmip " SPLATMIP_VERSION);
  return elements;
}

bool IsGray(vtkColorTransferFunction* palette)
{
  double node[6]; // place, red, green, blue, ...
  bool isGray = true;
  for (int n = 0; n < palette->GetSize(); ++n)
  {
    palette->GetNodeValue(n, node);
    isGray = isGray && node[1] == node[2] && node[2] == node[3];
  }
  return isGray;
}

/**
 * Paint frames as bytes if the palette is gray, else as colours. DICOM requires an even number of
 * bytes, which vtk-dicom does not ensure: where it is odd, a column of the darkest colour is added.
 */
vtkSmartPointer<vtkImageData> PaintFrames(vtkImageData* slices, vtkColorTransferFunction* palette)
{
  const bool isColored = slices->GetNumberOfScalarComponents() == 3;
  const int* const size = slices->GetDimensions();
  const bool isOdd = size[0] * size[1] * size[2] % 2 != 0;
  vtkNew<vtkImageConstantPad> pad;
  pad->SetInputData(slices);
  pad->SetOutputWholeExtent(0, size[0] - 1 + isOdd, 0, size[1] - 1, 0, size[2] - 1);
  vtkNew<vtkImageMapToColors> paint;
  paint->SetInputConnection(pad->GetOutputPort());
  paint->SetLookupTable(isColored ? nullptr : palette);
  paint->SetOutputFormat(!isColored && IsGray(palette) ? VTK_LUMINANCE : VTK_RGB);
  paint->Update();
  vtkSmartPointer<vtkImageData> frames = paint->GetOutput();
  frames->SetOrigin(0.0, 0.0, 0.0);
  frames->SetSpacing(slices->GetSpacing()[0], slices->GetSpacing()[1], 1.0);
  return frames;
}
}

bool WriteDICOM(
  vtkImageData* slices, const FilmSettings& settings, const std::vector<std::string>& names)
{
  const QuietReading quiet;
  vtkNew<FilmGenerator> generator;
  generator->IsInMillimeters = settings.IsInMillimeters;
  vtkNew<vtkDICOMWriter> writer;
  writer->SetInputData(PaintFrames(slices, settings.Palette));
  writer->SetGenerator(generator);
  writer->SetMetaData(DescribeFilm(settings.Study));
  writer->SetSeriesDescription("splatmip");
  writer->SetImageType("DERIVED/SECONDARY/PROJECTION");
  writer->SetFileDimensionality(3); // all frames in one file
  writer->SetFileSliceOrderToSame();
  writer->SetTimeDimension(slices->GetDimensions()[2]);
  writer->SetTimeSpacing(1000.0 / settings.Rate);
  writer->SetFileName(names.front().c_str());
  writer->Write();
  return !writer->GetErrorCode() && !quiet.HasErrors();
}
