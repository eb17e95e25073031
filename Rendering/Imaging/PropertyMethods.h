// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Defines Set and Get methods of VTK's classes for properties in a struct `this->Properties` that
 * is not declared in their headers, as vtkSetMacro does. Headers declare the methods.
 */
#ifndef PropertyMethods_h
#define PropertyMethods_h

#include <algorithm>
#include <cstddef>

namespace splatting
{
/// Sets a property and modifies its object, if the value differs.
template <class Object, class T>
void change(Object* object, T& property, const T& value)
{
  if (property != value)
  {
    property = value;
    object->Modified();
  }
}

template <class Object, class T, std::size_t N>
void changeArray(Object* object, T (&property)[N], const T* values)
{
  if (!std::equal(property, property + N, values))
  {
    std::copy_n(values, N, property);
    object->Modified();
  }
}

/// Copies each value to its reference.
template <class T, std::size_t N, class... To>
void copyTo(const T (&values)[N], To&... to)
{
  static_assert(sizeof...(to) == N, "as many as there are");
  std::size_t n = 0;
  ((to = values[n++]), ...);
}

/// Keeps NaN.
template <class T>
T clamped(T value, T least, T most)
{
  return value < least ? least : value > most ? most : value;
}
}

#define splattingGetMethod(Class, Type, Name)                                                      \
  Type Class::Get##Name()                                                                          \
  {                                                                                                \
    return static_cast<Type>(this->Properties->Name);                                              \
  }

/// As vtkSetMacro and vtkGetMacro.
#define splattingMethods(Class, Type, Name)                                                        \
  splattingGetMethod(Class, Type, Name);                                                           \
  void Class::Set##Name(Type value)                                                                \
  {                                                                                                \
    splatting::change(                                                                             \
      this, this->Properties->Name, static_cast<decltype(this->Properties->Name)>(value));         \
  }

/// As vtkSetClampMacro and vtkGetMacro.
#define splattingClampMethods(Class, Type, Name, Least, Most)                                      \
  splattingGetMethod(Class, Type, Name);                                                           \
  Type Class::Get##Name##MinValue()                                                                \
  {                                                                                                \
    return Least;                                                                                  \
  }                                                                                                \
  Type Class::Get##Name##MaxValue()                                                                \
  {                                                                                                \
    return Most;                                                                                   \
  }                                                                                                \
  void Class::Set##Name(Type value)                                                                \
  {                                                                                                \
    splatting::change(this, this->Properties->Name,                                                \
      static_cast<decltype(this->Properties->Name)>(                                               \
        splatting::clamped<Type>(value, Least, Most)));                                            \
  }

/// Common methods of vectors.
#define splattingArrayMethods(Class, Name, Count)                                                  \
  double* Class::Get##Name()                                                                       \
  {                                                                                                \
    return this->Properties->Name;                                                                 \
  }                                                                                                \
  void Class::Get##Name(double values[Count])                                                      \
  {                                                                                                \
    std::copy_n(this->Properties->Name, Count, values);                                            \
  }                                                                                                \
  void Class::Set##Name(const double values[Count])                                                \
  {                                                                                                \
    splatting::changeArray(this, this->Properties->Name, values);                                  \
  }

/// As vtkSetVector2Macro and vtkGetVector2Macro of double.
#define splattingVector2Methods(Class, Name)                                                       \
  splattingArrayMethods(Class, Name, 2);                                                           \
  void Class::Get##Name(double& a, double& b)                                                      \
  {                                                                                                \
    splatting::copyTo(this->Properties->Name, a, b);                                               \
  }                                                                                                \
  void Class::Set##Name(double a, double b)                                                        \
  {                                                                                                \
    const double values[] = { a, b };                                                              \
    this->Set##Name(values);                                                                       \
  }

/// As vtkSetVector3Macro and vtkGetVector3Macro of double.
#define splattingVector3Methods(Class, Name)                                                       \
  splattingArrayMethods(Class, Name, 3);                                                           \
  void Class::Get##Name(double& a, double& b, double& c)                                           \
  {                                                                                                \
    splatting::copyTo(this->Properties->Name, a, b, c);                                            \
  }                                                                                                \
  void Class::Set##Name(double a, double b, double c)                                              \
  {                                                                                                \
    const double values[] = { a, b, c };                                                           \
    this->Set##Name(values);                                                                       \
  }

/// As vtkSetVector6Macro and vtkGetVector6Macro of double.
#define splattingVector6Methods(Class, Name)                                                       \
  splattingArrayMethods(Class, Name, 6);                                                           \
  void Class::Get##Name(double& a, double& b, double& c, double& d, double& e, double& f)          \
  {                                                                                                \
    splatting::copyTo(this->Properties->Name, a, b, c, d, e, f);                                   \
  }                                                                                                \
  void Class::Set##Name(double a, double b, double c, double d, double e, double f)                \
  {                                                                                                \
    const double values[] = { a, b, c, d, e, f };                                                  \
    this->Set##Name(values);                                                                       \
  }

/// As vtkCxxSetObjectMacro and vtkGetObjectMacro.
#define splattingObjectMethods(Class, Type, Name)                                                  \
  Type* Class::Get##Name()                                                                         \
  {                                                                                                \
    return this->Properties->Name;                                                                 \
  }                                                                                                \
  void Class::Set##Name(Type* object)                                                              \
  {                                                                                                \
    splatting::change(this, this->Properties->Name, vtkSmartPointer<Type>(object));                \
  }

/// The methods of ProjectionProperties, without the properties that mappers inherit.
#define splattingProjectionMethods(Class)                                                          \
  splattingClampMethods(Class, int, QualityMode, PREVIEW, EXACT);                                  \
  splattingClampMethods(Class, int, Kernel, TRILINEAR, COSINE_BELL);                               \
  splattingClampMethods(Class, double, KernelRadius, 0.5, 1.5);                                    \
  splattingClampMethods(Class, int, FootprintSampling, 0, 64);                                     \
  splattingClampMethods(Class, int, MaximumType, GLOBAL, LOCAL);                                   \
  splattingMethods(Class, double, DepthShadingAmbient);                                            \
  splattingMethods(Class, double, DepthShadingChangeRate);                                         \
  splattingMethods(Class, double, LocalMaximumThreshold);                                          \
  splattingClampMethods(Class, int, VectorMode, DISABLED, COMPONENT);                              \
  splattingClampMethods(Class, int, VectorComponent, 0, 3);                                        \
  splattingMethods(Class, bool, Slab);                                                             \
  splattingMethods(Class, double, SlabThickness);                                                  \
  splattingVector3Methods(Class, SlabCenter);                                                      \
  splattingClampMethods(Class, int, Acceleration, AUTO, SORTED_VOLUME);                            \
  splattingClampMethods(Class, double, LineTolerance, 0.0, 64.0);                                  \
  splattingMethods(Class, bool, EliminateInvisible);                                               \
  splattingMethods(Class, bool, RecordLocations);                                                  \
  splattingClampMethods(Class, vtkTypeInt64, IndexMemoryBudget, 0, VTK_TYPE_INT64_MAX)

#endif
