// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The settings that random walks change, each with values that it may have: those of mapper and
 * filter, and of the mapper that stands in for VTK's. What a mapper has been set to can be set
 * again on a fresh one.
 */
#ifndef WalkSettings_h
#define WalkSettings_h

#include "WalkWorld.h"

#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"
#include "vtkSplattingMIPProjection.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkVolume.h"

#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace walktesting
{
using Values = std::vector<double>;
using Draw = std::function<Values(const World& world, reference::Random& random)>;

template <class Object>
struct Setting
{
  /// As PrintSelf() has it; several words where one value makes sense with others only.
  std::string name;
  Draw draw;
  std::function<void(Object& object, const Values& values, World& world)> set;
};

template <class Object>
using Settings = std::vector<Setting<Object>>;

inline Draw among(const std::vector<Values>& all)
{
  return [all](const World&, reference::Random& random)
  { return all[random.uniform<std::size_t>(0, all.size() - 1)]; };
}

/// Any of a few numbers. Those that are named several times are drawn as often.
inline Draw oneOf(const std::vector<double>& all)
{
  std::vector<Values> lists;
  for (double value : all)
  {
    lists.push_back({ value });
  }
  return among(lists);
}

inline Draw onOrOff(int timesOff = 1)
{
  return [timesOff](const World&, reference::Random& random) -> Values
  { return { random.uniform(0, timesOff) == 0 ? 1.0 : 0.0 }; };
}

inline Values anyPlanes(const World& world, reference::Random& random)
{
  const auto a = world.anyPlace(random), b = world.anyPlace(random);
  double center[3];
  world.input.data->GetCenter(center);
  Values planes;
  for (int n = 0; n < 3; ++n)
  {
    planes.push_back(std::min(a[n], center[n]));
    planes.push_back(std::max(b[n], center[n]));
  }
  return planes;
}

inline Values anyCenter(const World& world, reference::Random& random)
{
  const auto place = world.anyPlace(random);
  return { place[0], place[1], place[2] };
}

using V = const double*;

/// Adds settings of a part of the objects, `of(object)`.
template <class Object, class Of>
auto adder(Settings<Object>& all, const Of& of)
{
  return [&all, of](const char* name, const Draw& draw, auto set)
  {
    all.push_back({ name, draw,
      [of, set](Object& object, const Values& v, World&) { set(of(object), v.data()); } });
  };
}

/// Those of vtkVolumeMapper that the filter has, too.
template <class Object, class Of>
void addCroppingSettings(Settings<Object>& all, const Of& of)
{
  const auto add = adder(all, of);
  add("Cropping", onOrOff(2), [](auto* p, V v) { p->SetCropping(int(v[0])); });
  add("CroppingRegionPlanes", anyPlanes,
    [](auto* p, V v) { p->SetCroppingRegionPlanes(v[0], v[1], v[2], v[3], v[4], v[5]); });
  add("CroppingRegionFlags",
    oneOf({ VTK_CROP_SUBVOLUME, VTK_CROP_FENCE, VTK_CROP_INVERTED_FENCE, VTK_CROP_CROSS,
      VTK_CROP_INVERTED_CROSS, 0x5555555, 0 }),
    [](auto* p, V v) { p->SetCroppingRegionFlags(int(v[0])); });
  add("AverageIPScalarRange", among({ { VTK_FLOAT_MIN, VTK_FLOAT_MAX }, { 5.0, 60.0 } }),
    [](auto* p, V v) { p->SetAverageIPScalarRange(v[0], v[1]); });
}

/// Those of our mapper that the filter has, too.
template <class Object, class Of>
void addProjectionSettings(Settings<Object>& all, const Of& of)
{
  const auto add = adder(all, of);
  add("QualityMode", oneOf({ 0, 1, 2, 3 }), [](auto* p, V v) { p->SetQualityMode(int(v[0])); });
  add("Kernel", onOrOff(), [](auto* p, V v) { p->SetKernel(int(v[0])); });
  add("KernelRadius", oneOf({ 0.5, 0.5 + 1e-12, 0.75, 1.0, 1.5 }),
    [](auto* p, V v) { p->SetKernelRadius(v[0]); });
  add("FootprintSampling", oneOf({ 0, 0, 0, 1, 3 }),
    [](auto* p, V v) { p->SetFootprintSampling(int(v[0])); });
  add("MaximumType", oneOf({ 0, 0, 1, 1, 2, 3, 3 }),
    [](auto* p, V v) { p->SetMaximumType(int(v[0])); });
  add("DepthShadingAmbient", oneOf({ 0.3, 0.0, 1.0, -1.0 }),
    [](auto* p, V v) { p->SetDepthShadingAmbient(v[0]); });
  add("DepthShadingChangeRate", oneOf({ 0.7, 0.0, 2.0 }),
    [](auto* p, V v) { p->SetDepthShadingChangeRate(v[0]); });
  add("LocalMaximumThreshold", oneOf({ 0.0, 30.0, 60.0, 1e6 }),
    [](auto* p, V v) { p->SetLocalMaximumThreshold(v[0]); });
  add("SignedOrigin", oneOf({ 0.0, 30.0, 60.0, 120.0 }),
    [](auto* p, V v) { p->SetSignedOrigin(v[0]); });
  add("VectorMode", oneOf({ -1, -1, -1, 0, 1 }), [](auto* p, V v) { p->SetVectorMode(int(v[0])); });
  add("VectorComponent", oneOf({ 0, 0, 0, 0, 1, 3 }),
    [](auto* p, V v) { p->SetVectorComponent(int(v[0])); });
  add("Slab", onOrOff(2), [](auto* p, V v) { p->SetSlab(v[0] != 0.0); });
  add(
    "SlabThickness",
    [](const World& world, reference::Random& random) -> Values
    { return { world.diagonal() * random.uniform(0.01, 0.6) }; },
    [](auto* p, V v) { p->SetSlabThickness(v[0]); });
  add("SlabCenter", anyCenter, [](auto* p, V v) { p->SetSlabCenter(v[0], v[1], v[2]); });
  add("Acceleration", oneOf({ 0, 0, 1, 2, 3, 4, 5 }),
    [](auto* p, V v) { p->SetAcceleration(int(v[0])); });
  // Where there is room for some chains only, it is the walk's past that says for which.
  constexpr double plenty = 1e9;
  add("LineTolerance IndexMemoryBudget",
    among({ { 0.0, plenty }, { 0.0, plenty }, { 4.0, plenty }, { 50.0, plenty }, { 0.0, 0.0 },
      { 20.0, 0.0 }, { 0.0, 3000.0 } }),
    [](auto* p, V v)
    {
      p->SetLineTolerance(v[0]);
      p->SetIndexMemoryBudget(static_cast<vtkTypeInt64>(v[1]));
    });
  add("RecordLocations", onOrOff(), [](auto* p, V v) { p->SetRecordLocations(v[0] != 0.0); });
}

/// A mapper in a volume: one that splats, or one that stands in for VTK's and has one that splats.
struct Shown
{
  explicit Shown(bool standsIn)
  {
    if (standsIn)
    {
      this->standIn = vtkSmartPointer<vtkSplattingMIPGPUVolumeRayCastMapper>::New();
      this->standIn->SetMaskTypeToBinary();
      this->splatting = this->standIn->GetSplattingMapper();
      this->mapper = this->standIn;
    }
    else
    {
      this->splatting = vtkSmartPointer<vtkSplattingMIPVolumeMapper>::New();
      this->mapper = this->splatting;
    }
    this->mapper->SetBlendModeToMaximumIntensity();
    this->volume->SetMapper(this->mapper);
  }

  vtkSmartPointer<vtkSplattingMIPGPUVolumeRayCastMapper> standIn;
  vtkSmartPointer<vtkSplattingMIPVolumeMapper> splatting;
  vtkSmartPointer<vtkVolumeMapper> mapper;
  vtkNew<vtkVolume> volume;
};

inline void cutByPlanes(vtkVolumeMapper* mapper, int count, World& world)
{
  mapper->RemoveAllClippingPlanes();
  for (int n = 0; n < count; ++n)
  {
    mapper->AddClippingPlane(world.planes[n]);
  }
}

inline void chooseArray(vtkVolumeMapper* mapper, const Values& v)
{
  static const char* const names[] = { "first", "second", "third" };
  mapper->SetScalarMode(int(v[0]));
  v[1] != 0.0 ? mapper->SelectScalarArray(names[int(v[2])])
              : mapper->SelectScalarArray(int(v[2]) % 2);
}

/// Those of vtkVolumeMapper, of volumes, and all that come from the input.
inline void addMapperSettings(Settings<Shown>& all, bool standsIn)
{
  using S = Shown;
  all.push_back({ "MaskInput", onOrOff(2),
    [](S& s, const Values& v, World& world)
    {
      vtkImageData* const mask = v[0] != 0.0 ? world.input.mask.Get() : nullptr;
      s.standIn ? s.standIn->SetMaskInput(mask) : s.splatting->SetMaskInput(mask);
    } });
  // Others are ray cast, some by VTK's GPU mapper, which refuses or crashes at what walks bring.
  const auto blends =
    standsIn ? oneOf({ 1, 2 }) : oneOf({ 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 0 });
  all.push_back({ "BlendMode", blends,
    [](S& s, const Values& v, World&) { s.mapper->SetBlendMode(int(v[0])); } });
  all.push_back({ "ScalarMode",
    among({ { 0, 0, 0 }, { 0, 1, 1 }, { 1, 0, 0 }, { 2, 0, 0 }, { 3, 1, 1 }, { 3, 0, 1 },
      { 4, 1, 2 } }),
    [](S& s, const Values& v, World&) { chooseArray(s.mapper, v); } });
  all.push_back({ "ClippingPlanes", oneOf({ 0, 0, 1, 2, 3 }),
    [](S& s, const Values& v, World& world) { cutByPlanes(s.mapper, int(v[0]), world); } });
  all.push_back({ "Orientation",
    [](const World& world, reference::Random& random)
    {
      static const std::vector<Values> all = { { 0, 0, 0, 1, 1 }, { 0, 0, 0, 1, 1 },
        { 30, -50, 10, 1.2, 1.0 }, { 90, 0, 0, 1, -1 } };
      Values values = all[random.uniform<std::size_t>(0, all.size() - 1)];
      double center[3];
      world.input.data->GetCenter(center);
      values.insert(values.end(), center, center + 3);
      return values;
    },
    [](S& s, const Values& v, World&)
    {
      s.volume->SetOrientation(v[0], v[1], v[2]);
      s.volume->SetScale(1.0, v[3], v[4]);
      s.volume->SetOrigin(v[5], v[6], v[7]);
    } });
}

/// The rest of the splatting mapper's.
inline void addPictureSettings(Settings<Shown>& all)
{
  using S = Shown;
  using V = const Values&;
  const auto flag = [&](const char* name, auto set)
  {
    all.push_back(
      { name, onOrOff(), [set](S& s, V v, World&) { (s.splatting.Get()->*set)(v[0] != 0.0); } });
  };
  using Mapper = vtkSplattingMIPVolumeMapper;
  flag("CullBelowWindow", &Mapper::SetCullBelowWindow);
  flag("DepthCoding", &Mapper::SetDepthCoding);
  flag("WriteDepth", &Mapper::SetWriteDepth);
  flag("DisplayOnRootOnly", &Mapper::SetDisplayOnRootOnly);
  flag("IntermixIntersectingGeometry", &Mapper::SetIntermixIntersectingGeometry);
  all.push_back({ "AutoAdjustSampleDistances", onOrOff(),
    [](S& s, V v, World&)
    {
      s.standIn ? s.standIn->SetAutoAdjustSampleDistances(int(v[0]))
                : s.splatting->SetAutoAdjustSampleDistances(int(v[0]));
    } });
  all.push_back({ "FinalColorWindow FinalColorLevel",
    among({ { 1.0, 0.5 }, { 0.5, 0.6 }, { 2.0, 0.2 }, { -1.0, 0.5 } }),
    [](S& s, V v, World&)
    {
      const float window = static_cast<float>(v[0]), level = static_cast<float>(v[1]);
      s.standIn ? s.standIn->SetFinalColorWindow(window) : s.splatting->SetFinalColorWindow(window);
      s.standIn ? s.standIn->SetFinalColorLevel(level) : s.splatting->SetFinalColorLevel(level);
    } });
  all.push_back({ "BoundingSurface", onOrOff(3), [](S& s, V v, World& world) {
                   s.splatting->SetBoundingSurface(v[0] != 0.0 ? world.surface.Get() : nullptr);
                 } });
  all.push_back({ "DepthCodingColors", onOrOff(),
    [](S& s, V v, World& world)
    { s.splatting->SetDepthCodingColors(v[0] != 0.0 ? world.depthColors.Get() : nullptr); } });
  all.push_back({ "DepthCodingRange",
    [](const World& world, reference::Random& random) -> Values {
      return { 0.0, random.uniform(0, 1) * world.diagonal() };
    },
    [](S& s, V v, World&) { s.splatting->SetDepthCodingRange(v[0], v[1]); } });
  all.push_back({ "WriteDepthOpacity", oneOf({ 0.5, 0.0, 0.9 }),
    [](S& s, V v, World&) { s.splatting->SetWriteDepthOpacity(v[0]); } });
  all.push_back({ "LabelInput", onOrOff(3), [](S& s, V v, World& world) {
                   s.splatting->SetLabelInput(v[0] != 0.0 ? world.input.mask.Get() : nullptr);
                 } });
  all.push_back({ "LabelColors", onOrOff(), [](S& s, V v, World& world) {
                   s.splatting->SetLabelColors(v[0] != 0.0 ? world.depthColors.Get() : nullptr);
                 } });
  all.push_back({ "LabelMode", oneOf({ 0, 1 }),
    [](S& s, V v, World&) { s.splatting->SetLabelMode(int(v[0])); } });
  all.push_back({ "PictureBlending", oneOf({ 0, 0, 1, 2 }),
    [](S& s, V v, World&) { s.splatting->SetPictureBlending(int(v[0])); } });
}

inline Settings<Shown> settingsOfMapper(bool standsIn)
{
  Settings<Shown> all;
  addMapperSettings(all, standsIn);
  addPictureSettings(all);
  addCroppingSettings(all, [](Shown& shown) { return shown.mapper.Get(); });
  addProjectionSettings(all, [](Shown& shown) { return shown.splatting.Get(); });
  return all;
}

inline Draw direction()
{
  return [](const World&, reference::Random& random) -> Values
  {
    const auto v = anyPoint(random, -1.0, 1.0);
    return { v[0], v[1], v[2] };
  };
}

inline Settings<vtkSplattingMIPProjection> settingsOfFilter()
{
  using Filter = vtkSplattingMIPProjection;
  Settings<Filter> all;
  const auto same = [](Filter& filter) { return &filter; };
  addCroppingSettings(all, same);
  addProjectionSettings(all, same);
  const auto add = adder(all, same);
  add("BlendMode", oneOf({ 1, 1, 2, 3 }), [](Filter* p, V v) { p->SetBlendMode(int(v[0])); });
  add("ViewDirection", direction(), [](Filter* p, V v) { p->SetViewDirection(v[0], v[1], v[2]); });
  add("ViewUp", direction(), [](Filter* p, V v) { p->SetViewUp(v[0], v[1], v[2]); });
  add("CenterOnVolume", onOrOff(), [](Filter* p, V v) { p->SetCenterOnVolume(v[0] != 0.0); });
  add("FocalPoint", anyCenter, [](Filter* p, V v) { p->SetFocalPoint(v[0], v[1], v[2]); });
  add("OutputSize", among({ { 30, 25 }, { 7, 50 }, { 61, 40 }, { 1, 1 } }),
    [](Filter* p, V v) { p->SetOutputSize(int(v[0]), int(v[1])); });
  add("OutputSpacing", among({ { 0.0, 0.0 }, { 0.7, 0.7 }, { 0.3, 0.9 } }),
    [](Filter* p, V v) { p->SetOutputSpacing(v[0], v[1]); });
  add("NumberOfViews", oneOf({ 1, 1, 1, 2, 3, 4 }),
    [](Filter* p, V v) { p->SetNumberOfViews(int(v[0])); });
  add("RotationAxis", direction(), [](Filter* p, V v) { p->SetRotationAxis(v[0], v[1], v[2]); });
  add("TotalAngle", oneOf({ 360.0, 50.0, -180.0 }), [](Filter* p, V v) { p->SetTotalAngle(v[0]); });
  add("BackgroundValue", oneOf({ 0.0, -7.0, vtkMath::Nan() }),
    [](Filter* p, V v) { p->SetBackgroundValue(v[0]); });
  all.push_back({ "Camera", onOrOff(), [](Filter& filter, const Values& v, World& world) {
                   filter.SetCamera(v[0] != 0.0 ? world.camera.Get() : nullptr);
                 } });
  all.push_back({ "InputArrayToProcess", oneOf({ 0, 0, 1, 2 }),
    [](Filter& filter, const Values& v, World&)
    {
      static const char* const names[] = { "first", "second", "third" };
      const int n = int(v[0]);
      filter.SetInputArrayToProcess(0, 0, 0,
        n == 2 ? vtkDataObject::FIELD_ASSOCIATION_CELLS : vtkDataObject::FIELD_ASSOCIATION_POINTS,
        names[n]);
    } });
  return all;
}

/// The names of what an object prints at the first level.
inline std::set<std::string> printedNames(vtkObject* object)
{
  std::ostringstream printed;
  object->PrintSelf(printed, vtkIndent());
  std::istringstream lines(printed.str());
  std::set<std::string> names;
  for (std::string line; std::getline(lines, line);)
  {
    const std::size_t colon = line.find(':');
    if (colon != std::string::npos && line[0] != ' ')
    {
      names.insert(line.substr(0, colon));
    }
  }
  return names;
}

/// What an object prints, but not one of its superclass, that is among neither the settings nor
/// the results.
template <class Object>
std::string missingSettings(vtkObject* object, vtkObject* ofSuperclass,
  const Settings<Object>& settings, const std::set<std::string>& results)
{
  const std::set<std::string> inherited = printedNames(ofSuperclass);
  std::string missing;
  for (const std::string& name : printedNames(object))
  {
    bool isKnown = inherited.count(name) + results.count(name) > 0;
    for (const Setting<Object>& setting : settings)
    {
      isKnown = isKnown || (" " + setting.name + " ").find(" " + name + " ") != std::string::npos;
    }
    missing += isKnown ? "" : " " + name;
  }
  return missing;
}
}

#endif
