// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/QuietReading.h"
#include "Writing/PictureSeries.h"

#include "vtkDICOMMetaData.h"
#include "vtkDICOMSCGenerator.h"
#include "vtkDICOMWriter.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"

#include <algorithm>

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

/**
 * Paint frames as bytes if the palette is gray, else as colours. DICOM requires an even number of
 * bytes, which vtk-dicom does not ensure: where it is odd, a column of the darkest colour is added.
 */
vtkSmartPointer<vtkImageData> PaintFrames(vtkImageData* slices, const Palette& palette)
{
  const bool isColored = slices->GetNumberOfScalarComponents() == 3;
  const bool isGray = !isColored &&
    std::all_of(palette.begin(), palette.end(),
      [](const auto& color) { return color[0] == color[1] && color[1] == color[2]; });
  const int components = isGray ? 1 : 3;
  const int* const size = slices->GetDimensions();
  const bool isOdd = size[0] * size[1] * size[2] % 2 != 0;
  auto frames = vtkSmartPointer<vtkImageData>::New();
  frames->SetDimensions(size[0] + isOdd, size[1], size[2]);
  const double* const spacing = slices->GetSpacing();
  frames->SetSpacing(spacing[0], spacing[1], 1.0);
  frames->AllocateScalars(VTK_UNSIGNED_CHAR, components);
  const auto* from = static_cast<unsigned char*>(slices->GetScalarPointer());
  auto* to = static_cast<unsigned char*>(frames->GetScalarPointer());
  const Palette::value_type black = {};
  for (vtkIdType row = 0; row < vtkIdType(size[1]) * size[2]; ++row)
  {
    for (int column = 0; column < size[0]; ++column, from += isColored ? 3 : 1, to += components)
    {
      std::copy_n(isColored ? from : palette[*from].data(), components, to);
    }
    if (isOdd)
    {
      to = std::copy_n(isColored ? black.data() : palette[0].data(), components, to);
    }
  }
  return frames;
}
}

bool WriteDICOM(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::vector<std::string>& names)
{
  const QuietReading quiet;
  vtkNew<FilmGenerator> generator;
  generator->IsInMillimeters = settings.IsInMillimeters;
  vtkNew<vtkDICOMWriter> writer;
  writer->SetInputData(PaintFrames(slices, palette));
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
