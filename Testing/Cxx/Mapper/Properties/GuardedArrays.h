// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Arrays that nobody can read or write beyond: pages that must not be touched lie next to them, and
 * once an array is gone its own pages are, too.
 */
#ifndef GuardedArrays_h
#define GuardedArrays_h

#include "Random.h"

#include "vtkDataArray.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkSmartPointer.h"

#include <cstddef>
#include <cstring>
#include <map>
#include <new>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace walktesting
{
#if defined(__unix__) || defined(__APPLE__)
struct Pages
{
  void* begin;
  std::size_t size;
};

/// Of all guarded memory, by the address that it is used at.
inline std::map<void*, Pages>& guardedPages()
{
  static std::map<void*, Pages> pages;
  return pages;
}

/// Zeros between two pages that cannot be touched: right before the second one, or right after the
/// first one.
inline void* guardedMemory(std::size_t size, bool atEnd)
{
  const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t inner = (size + page - 1) / page * page;
  void* const begin =
    mmap(nullptr, inner + 2 * page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (begin == MAP_FAILED)
  {
    throw std::bad_alloc();
  }
  char* const first = static_cast<char*>(begin) + page;
  mprotect(first, inner, PROT_READ | PROT_WRITE);
  void* const memory = first + (atEnd ? inner - size : 0);
  guardedPages()[memory] = { begin, inner + 2 * page };
  return memory;
}

inline void freeGuarded(void* memory)
{
  const Pages pages = guardedPages().at(memory);
  guardedPages().erase(memory);
  munmap(pages.begin, pages.size);
}
#else
inline void* guardedMemory(std::size_t size, bool)
{
  return std::memset(::operator new(size), 0, size);
}

inline void freeGuarded(void* memory)
{
  ::operator delete(memory);
}
#endif

/// Gives an array, which has its number of components, another buffer of zeros.
inline void giveBuffer(vtkDataArray* array, vtkIdType tuples, reference::Random& random)
{
  const vtkIdType values = tuples * array->GetNumberOfComponents();
  void* const memory =
    guardedMemory(static_cast<std::size_t>(values) * array->GetDataTypeSize(), random.oneIn(2));
  array->SetVoidArray(memory, values, 0, vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
  array->SetArrayFreeFunction(&freeGuarded);
}

/// Voxel after voxel.
inline vtkSmartPointer<vtkDataArray> guardedArray(
  int type, vtkIdType tuples, int components, reference::Random& random)
{
  auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  array->SetNumberOfComponents(components);
  giveBuffer(array, tuples, random);
  return array;
}

/// Component after component, of any place each.
template <class T>
vtkSmartPointer<vtkDataArray> separateGuardedArray(
  vtkIdType tuples, int components, reference::Random& random)
{
  auto array = vtkSmartPointer<vtkSOADataArrayTemplate<T>>::New();
  array->SetNumberOfComponents(components);
  for (int c = 0; c < components; ++c)
  {
    void* const memory =
      guardedMemory(static_cast<std::size_t>(tuples) * sizeof(T), random.oneIn(2));
    array->SetArray(c, static_cast<T*>(memory), tuples, c == components - 1, false,
      vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
    array->SetArrayFreeFunction(c, &freeGuarded);
  }
  return array;
}
}

#endif
